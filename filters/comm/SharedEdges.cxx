// 1. A cell is a candidate for a neighbour that holds all of its vertices.
// 2. Each neighbour gets the sorted list of the candidates' keys (their sorted global ids).
// 3. What is in both lists is shared.

#include "comm/SharedEdges.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

namespace cadrefine
{

namespace
{

template<std::size_t N>
struct Candidate
{
  std::array<GlobalId, N> key;
  Index cell;
};

template<std::size_t N>
using Candidates = std::vector<std::vector<Candidate<N>>>; // per neighbour

// For each vertex its place in vertices.all, or -1.
std::vector<Index> slotsOfVertices(const SharedVertices& vertices, std::size_t vertexCount)
{
  std::vector<Index> slots(vertexCount, -1);
  for (std::size_t slot = 0; slot < vertices.all.size(); ++slot)
  {
    slots[static_cast<std::size_t>(vertices.all[slot])] = static_cast<Index>(slot);
  }
  return slots;
}

// The other ranks that hold all vertices of a cell.
template<std::size_t N>
std::vector<int> commonHolders(
  const SharedVertices& vertices, const std::vector<Index>& slots, const std::array<Index, N>& cell)
{
  std::vector<int> common;
  for (std::size_t i = 0; i < N && cell[i] >= 0; ++i)
  {
    const Index slot = slots[static_cast<std::size_t>(cell[i])];
    if (slot < 0)
    {
      return {};
    }
    const auto holders = vertices.holdersOfSlot(static_cast<std::size_t>(slot));
    if (i == 0)
    {
      common.assign(holders.begin(), holders.end());
      continue;
    }
    std::vector<int> both;
    std::set_intersection(
      common.begin(), common.end(), holders.begin(), holders.end(), std::back_inserter(both));
    common = std::move(both);
  }
  common.erase(std::remove(common.begin(), common.end(), vertices.rank), common.end());
  return common;
}

template<std::size_t N>
std::array<GlobalId, N> keyOf(const std::vector<GlobalId>& ids, const std::array<Index, N>& cell)
{
  std::array<GlobalId, N> key;
  for (std::size_t i = 0; i < N; ++i)
  {
    key[i] = cell[i] < 0 ? -1 : ids[static_cast<std::size_t>(cell[i])];
  }
  std::sort(key.begin(), key.end());
  return key;
}

template<std::size_t N>
Candidates<N> findCandidates(const SharedVertices& vertices, const std::vector<GlobalId>& ids,
  const std::vector<std::array<Index, N>>& cells)
{
  if (vertices.neighbours.empty())
  {
    return {};
  }
  const std::vector<Index> slots = slotsOfVertices(vertices, ids.size());
  Candidates<N> candidates(vertices.neighbours.size());
  for (std::size_t s = 0; s < cells.size(); ++s)
  {
    for (const int rank : commonHolders(vertices, slots, cells[s]))
    {
      const auto neighbour =
        std::lower_bound(vertices.neighbours.begin(), vertices.neighbours.end(), rank) -
        vertices.neighbours.begin();
      candidates[static_cast<std::size_t>(neighbour)].push_back(
        { keyOf(ids, cells[s]), static_cast<Index>(s) });
    }
  }
  for (std::vector<Candidate<N>>& list : candidates)
  {
    std::sort(list.begin(), list.end(),
      [](const Candidate<N>& a, const Candidate<N>& b) { return a.key < b.key; });
  }
  return candidates;
}

template<std::size_t N>
std::string reasonAgainst(const Candidates<N>& candidates)
{
  for (const std::vector<Candidate<N>>& list : candidates)
  {
    const auto twins = std::adjacent_find(list.begin(), list.end(),
      [](const Candidate<N>& a, const Candidate<N>& b) { return a.key == b.key; });
    if (twins == list.end())
    {
      continue;
    }
    std::string text = "A piece lists the edge or facet between the vertices with global ids";
    for (const GlobalId id : twins->key)
    {
      text += id < 0 ? "" : " " + std::to_string(id);
    }
    return text + " twice.";
  }
  return {};
}

template<std::size_t N>
std::vector<Index> presentInBoth(
  const std::vector<Candidate<N>>& mine, const std::vector<std::array<GlobalId, N>>& theirs)
{
  std::vector<Index> cells;
  auto their = theirs.begin();
  for (const Candidate<N>& candidate : mine)
  {
    while (their != theirs.end() && *their < candidate.key)
    {
      ++their;
    }
    if (their != theirs.end() && *their == candidate.key)
    {
      cells.push_back(candidate.cell);
    }
  }
  return cells;
}

} // namespace

template<std::size_t N>
SharedItems findSharedCells(RankExchange& exchange, const SharedVertices& vertices,
  const std::vector<GlobalId>& ids, const std::vector<std::array<Index, N>>& cells)
{
  const Candidates<N> candidates = findCandidates(vertices, ids, cells);
  exchange.agree(reasonAgainst(candidates));

  std::vector<std::vector<std::array<GlobalId, N>>> outgoing(candidates.size());
  for (std::size_t n = 0; n < candidates.size(); ++n)
  {
    outgoing[n].reserve(candidates[n].size());
    for (const Candidate<N>& candidate : candidates[n])
    {
      outgoing[n].push_back(candidate.key);
    }
  }
  const auto incoming = exchange.exchange(vertices.neighbours, outgoing);

  std::vector<int> neighbours;
  std::vector<std::vector<Index>> items;
  for (std::size_t n = 0; n < candidates.size(); ++n)
  {
    std::vector<Index> both = presentInBoth(candidates[n], incoming[n]);
    if (both.empty())
    {
      continue;
    }
    neighbours.push_back(vertices.neighbours[n]);
    items.push_back(std::move(both));
  }
  return makeSharedItems(vertices.rank, std::move(neighbours), std::move(items));
}

template SharedItems findSharedCells<2>(RankExchange&, const SharedVertices&,
  const std::vector<GlobalId>&, const std::vector<std::array<Index, 2>>&);
template SharedItems findSharedCells<3>(RankExchange&, const SharedVertices&,
  const std::vector<GlobalId>&, const std::vector<std::array<Index, 3>>&);
template SharedItems findSharedCells<4>(RankExchange&, const SharedVertices&,
  const std::vector<GlobalId>&, const std::vector<std::array<Index, 4>>&);
template SharedItems findSharedCells<5>(RankExchange&, const SharedVertices&,
  const std::vector<GlobalId>&, const std::vector<std::array<Index, 5>>&);
template SharedItems findSharedCells<6>(RankExchange&, const SharedVertices&,
  const std::vector<GlobalId>&, const std::vector<std::array<Index, 6>>&);
template SharedItems findSharedCells<8>(RankExchange&, const SharedVertices&,
  const std::vector<GlobalId>&, const std::vector<std::array<Index, 8>>&);

SharedVertices sharedWithMidpoints(
  const SharedVertices& vertices, const SharedEdges& edges, const std::vector<Index>& midpointOf)
{
  auto items = vertices.items;
  for (std::size_t n = 0; n < edges.neighbours.size(); ++n)
  {
    const auto neighbour =
      std::lower_bound(vertices.neighbours.begin(), vertices.neighbours.end(), edges.neighbours[n]);
    auto& points = items[neighbour - vertices.neighbours.begin()];
    for (const Index edge : edges.items[n])
    {
      if (midpointOf[edge] >= 0)
      {
        points.push_back(midpointOf[edge]);
      }
    }
  }
  return makeSharedItems(vertices.rank, vertices.neighbours, std::move(items));
}

} // namespace cadrefine
