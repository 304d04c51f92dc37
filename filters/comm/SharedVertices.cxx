// 1. Every rank sends the ids of its candidates, ascending, to their home ranks.
// 2. The home sorts what it got by (id, rank); equal ids in a row are one vertex and its holders.
// 3. It answers each holder of a shared vertex with the vertex's place in the holder's list and the
//    ranks that hold it.
// 4. Every rank makes a list for each neighbour and sorts it by id.

#include "comm/SharedVertices.h"

#include <cadrefine/base/MixedBits.h>
#include <cadrefine/base/SortUniquely.h>

#include <algorithm>
#include <string>
#include <utility>

namespace cadrefine
{

namespace
{

using Lists = std::vector<std::vector<std::int64_t>>;

int homeOf(GlobalId id, int rankCount)
{
  const std::uint64_t bits = mixedBits(static_cast<std::uint64_t>(id));
  return static_cast<int>(bits % static_cast<std::uint64_t>(rankCount));
}

// The candidates in ascending order of their ids, each once; or the reason why not.
std::string sortCandidates(const std::vector<GlobalId>& ids, std::vector<Index>& candidates)
{
  const auto idOf = [&](Index vertex) { return ids[static_cast<std::size_t>(vertex)]; };
  for (const Index vertex : candidates)
  {
    if (vertex < 0 || static_cast<std::size_t>(vertex) >= ids.size())
    {
      return "There is no vertex " + std::to_string(vertex) + " in a piece of " +
             std::to_string(ids.size()) + " vertices.";
    }
  }
  sortUniquely(candidates);
  std::sort(
    candidates.begin(), candidates.end(), [&](Index a, Index b) { return idOf(a) < idOf(b); });
  const auto twins = std::adjacent_find(
    candidates.begin(), candidates.end(), [&](Index a, Index b) { return idOf(a) == idOf(b); });
  if (twins == candidates.end())
  {
    return {};
  }
  return "The vertices " + std::to_string(twins[0]) + " and " + std::to_string(twins[1]) +
         " of one piece have the same global id, " + std::to_string(idOf(*twins)) + ".";
}

// What the home got: an id, and from where in whose list.
struct Holding
{
  GlobalId id;
  int rank;
  std::int64_t place;
};

std::vector<Holding> sortedHoldings(const Lists& idsOfRank)
{
  std::vector<Holding> holdings;
  for (std::size_t r = 0; r < idsOfRank.size(); ++r)
  {
    for (std::size_t place = 0; place < idsOfRank[r].size(); ++place)
    {
      holdings.push_back(
        { idsOfRank[r][place], static_cast<int>(r), static_cast<std::int64_t>(place) });
    }
  }
  std::sort(holdings.begin(), holdings.end(),
    [](const Holding& a, const Holding& b)
    { return std::pair(a.id, a.rank) < std::pair(b.id, b.rank); });
  return holdings;
}

// For each rank one record (place, number of other holders, their ranks) a shared vertex.
Lists answers(const Lists& idsOfRank)
{
  const std::vector<Holding> holdings = sortedHoldings(idsOfRank);
  Lists toRank(idsOfRank.size());
  auto first = holdings.begin();
  while (first != holdings.end())
  {
    const auto last = std::find_if(
      first, holdings.end(), [&](const Holding& holding) { return holding.id != first->id; });
    if (last - first > 1)
    {
      for (auto holder = first; holder != last; ++holder)
      {
        std::vector<std::int64_t>& answer = toRank[static_cast<std::size_t>(holder->rank)];
        answer.push_back(holder->place);
        answer.push_back(last - first - 1);
        for (auto other = first; other != last; ++other)
        {
          if (other != holder)
          {
            answer.push_back(other->rank);
          }
        }
      }
    }
    first = last;
  }
  return toRank;
}

// (other holder, candidate in the order of ids), from the records of each home.
using Shares = std::vector<std::pair<int, std::size_t>>;

Shares readAnswers(const Lists& fromHome, const std::vector<std::vector<std::size_t>>& sentHome)
{
  Shares shares;
  for (std::size_t home = 0; home < fromHome.size(); ++home)
  {
    const std::vector<std::int64_t>& records = fromHome[home];
    std::size_t at = 0;
    while (at < records.size())
    {
      const std::size_t candidate = sentHome[home][static_cast<std::size_t>(records[at])];
      const std::size_t end = at + 2 + static_cast<std::size_t>(records[at + 1]);
      for (at += 2; at < end; ++at)
      {
        shares.emplace_back(static_cast<int>(records[at]), candidate);
      }
    }
  }
  std::sort(shares.begin(), shares.end());
  return shares;
}

} // namespace

SharedVertices findSharedVertices(
  RankExchange& exchange, const std::vector<GlobalId>& ids, const std::vector<Index>& candidates)
{
  std::vector<Index> sorted = candidates;
  exchange.agree(sortCandidates(ids, sorted));

  const std::size_t rankCount = static_cast<std::size_t>(exchange.size());
  Lists idsToHome(rankCount);
  std::vector<std::vector<std::size_t>> sentHome(rankCount);
  for (std::size_t i = 0; i < sorted.size(); ++i)
  {
    const GlobalId id = ids[static_cast<std::size_t>(sorted[i])];
    const std::size_t home = static_cast<std::size_t>(homeOf(id, exchange.size()));
    idsToHome[home].push_back(id);
    sentHome[home].push_back(i);
  }
  const Lists fromHome = exchange.allToAll(answers(exchange.allToAll(idsToHome)));

  std::vector<int> neighbours;
  std::vector<std::vector<Index>> items;
  for (const auto& [rank, candidate] : readAnswers(fromHome, sentHome))
  {
    if (neighbours.empty() || neighbours.back() != rank)
    {
      neighbours.push_back(rank);
      items.emplace_back();
    }
    items.back().push_back(sorted[candidate]);
  }
  return makeSharedItems(exchange.rank(), std::move(neighbours), std::move(items));
}

} // namespace cadrefine
