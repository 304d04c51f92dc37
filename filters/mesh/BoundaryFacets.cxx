#include "mesh/BoundaryFacets.h"

#include "comm/SharedEdges.h"
#include "comm/Threads.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace cadrefine
{
namespace
{

/// Calls visit(shape, cells) for the listed cells: those of one dimension less than the mesh's own.
template<class Visit>
void visitListed(const Mesh& mesh, const Visit& visit)
{
  visitShapes(mesh, mesh.dimension - 1, visit);
}

/// Corners of a side, and their ids; -1 follows where it has fewer than four.
using Corners = std::array<Index, 4>;
using Ids = std::array<GlobalId, 4>;

/// A listed cell, on this rank or another, and the cells of this rank that it is a side of.
struct Listed
{
  Ids key; ///< Ids of the corners, ascending.
  Corners corners;
  int met = 0;
  /// Smallest id of the cells that meet it.
  GlobalId smallest = std::numeric_limits<GlobalId>::max();
  Index cell = -1; ///< The cell with that id.
};

template<std::size_t N>
Corners cornersOf(const std::array<Index, N>& cell)
{
  Corners corners{ -1, -1, -1, -1 };
  std::copy(cell.begin(), cell.end(), corners.begin());
  return corners;
}

Ids keyOf(const Mesh& mesh, const Corners& corners)
{
  Ids ids = idsOf(mesh, corners);
  std::sort(ids.begin(), ids.end());
  return ids;
}

/// The ids of this rank's listed cells that each neighbour may have too.
std::vector<std::vector<Ids>> idsForNeighbours(const DistributedMesh& mesh)
{
  const SharedVertices& shared = mesh.shared;
  std::vector<std::vector<Ids>> outgoing(shared.neighbours.size());
  visitListed(mesh.mesh(),
    [&](auto, const auto& cells)
    {
      for (const auto& cell : cells)
      {
        for (const int rank : shared.holdersOf(cell[0]))
        {
          const auto isHeld = [&](Index vertex)
          {
            const auto holders = shared.holdersOf(vertex);
            return std::binary_search(holders.begin(), holders.end(), rank);
          };
          if (rank != shared.rank && std::all_of(cell.begin(), cell.end(), isHeld))
          {
            const auto n =
              std::lower_bound(shared.neighbours.begin(), shared.neighbours.end(), rank);
            outgoing[n - shared.neighbours.begin()].push_back(idsOf(mesh.mesh(), cornersOf(cell)));
          }
        }
      }
    });
  return outgoing;
}

/// The listed cells of this rank, and those of others whose corners it has, ordered by their keys.
std::vector<Listed> gatherListed(RankExchange& exchange, const DistributedMesh& distributed)
{
  const Mesh& mesh = distributed.mesh();
  std::vector<std::pair<GlobalId, Index>> vertexOf;
  for (const Index vertex : distributed.shared.all)
  {
    vertexOf.emplace_back(mesh.ids[vertex], vertex);
  }
  std::sort(vertexOf.begin(), vertexOf.end());
  const auto find = [&](GlobalId id)
  {
    return id < 0 ? -1
                  : std::lower_bound(vertexOf.begin(), vertexOf.end(), std::pair{ id, Index{ 0 } })
                      ->second;
  };
  std::vector<Listed> all;
  const auto add = [&](const Corners& corners) {
    all.push_back({ keyOf(mesh, corners), corners });
  };
  visitListed(mesh,
    [&](auto, const auto& cells) {
      std::for_each(cells.begin(), cells.end(), [&](const auto& cell) { add(cornersOf(cell)); });
    });
  for (const auto& ofNeighbour :
    exchange.exchange(distributed.shared.neighbours, idsForNeighbours(distributed)))
  {
    for (const Ids& ids : ofNeighbour)
    {
      Corners corners;
      std::transform(ids.begin(), ids.end(), corners.begin(), find);
      add(corners);
    }
  }
  std::sort(all.begin(), all.end(),
    [&](const Listed& a, const Listed& b) {
      return std::pair(a.key, idsOf(mesh, a.corners)) < std::pair(b.key, idsOf(mesh, b.corners));
    });
  all.erase(std::unique(all.begin(), all.end(),
              [](const Listed& a, const Listed& b) { return a.key == b.key; }),
    all.end());
  return all;
}

/// The place of the listed cell with this key, of those ordered by their keys; their number if
/// there is none.
std::size_t findListed(const std::vector<Listed>& all, const Ids& key)
{
  const auto found = std::lower_bound(all.begin(), all.end(), key,
    [](const Listed& listed, const Ids& wanted) { return listed.key < wanted; });
  return found != all.end() && found->key == key ? found - all.begin() : all.size();
}

/// Finds which cells of this rank meet the listed ones.
void meetListed(const DistributedMesh& distributed, std::vector<Listed>& all)
{
  const Mesh& mesh = distributed.mesh();
  std::vector<unsigned char> onListed(mesh.points.size(), 0);
  for (const Listed& listed : all)
  {
    for (const Index corner : listed.corners)
    {
      if (corner >= 0)
      {
        onListed[corner] = 1;
      }
    }
  }
  forEachSide(mesh,
    [&](const Facet& side)
    {
      const bool near =
        std::all_of(side.begin(), side.end(), [&](Index vertex) { return onListed[vertex] != 0; });
      const std::size_t found = near ? findListed(all, keyOf(mesh, side.vertices)) : all.size();
      if (found < all.size())
      {
        Listed& listed = all[found];
        const GlobalId id = distributed.converted.cellIds[mesh.dimension][side.cell];
        ++listed.met;
        listed.cell = id < listed.smallest ? side.cell : listed.cell;
        listed.smallest = std::min(listed.smallest, id);
      }
    });
}

Facet interiorFacet(const Listed& listed)
{
  return { listed.corners, listed.cell, true };
}

/// The cells that meet a side, over all ranks.
struct Meeting
{
  GlobalId smallest; ///< Smallest id of these cells.
  std::uint64_t leastTag;
  std::uint64_t largestTag;
};

Meeting joined(const Meeting& a, const Meeting& b)
{
  return { std::min(a.smallest, b.smallest), std::min(a.leastTag, b.leastTag),
    std::max(a.largestTag, b.largestTag) };
}

bool areDifferent(std::uint64_t tag, std::uint64_t other)
{
  return tag != 0 && other != 0 && tag != other;
}

/// Removes the facets that another rank meets too, but for those that are listed, or between cells
/// of different tags, where this rank's cell has the smaller id.
void settleShared(RankExchange& exchange, const DistributedMesh& mesh, bool areMet,
  const std::vector<Listed>& all, const std::vector<std::uint64_t>& tags,
  std::vector<Facet>& facets)
{
  const auto meetingOf = [&](const Facet& facet) -> Meeting
  {
    const std::uint64_t tag = tags.empty() ? 0 : tags[facet.cell];
    return { mesh.converted.cellIds[mesh.mesh().dimension][facet.cell], tag, tag };
  };
  std::vector<Corners> corners(facets.size());
  std::transform(facets.begin(), facets.end(), corners.begin(),
    [](const Facet& facet) { return facet.vertices; });
  const SharedItems shared = findSharedCells(exchange, mesh.shared, mesh.mesh().ids, corners);
  std::vector<Meeting> meetings;
  if (areMet)
  {
    std::transform(facets.begin(), facets.end(), std::back_inserter(meetings), meetingOf);
    combineShared(exchange, shared, meetings, joined);
  }
  std::vector<Facet> interior;
  for (const Index f : shared.all)
  {
    Facet& facet = facets[f];
    if (areMet && meetings[f].smallest == meetingOf(facet).smallest)
    {
      const std::size_t listed = findListed(all, keyOf(mesh.mesh(), corners[f]));
      if (listed < all.size())
      {
        interior.push_back(interiorFacet(all[listed]));
      }
      else if (areDifferent(meetings[f].leastTag, meetings[f].largestTag))
      {
        interior.push_back({ facet.vertices, facet.cell, true });
      }
    }
    facet.cell = -1;
  }
  facets.erase(
    std::remove_if(facets.begin(), facets.end(), [](const Facet& facet) { return facet.cell < 0; }),
    facets.end());
  facets.insert(facets.end(), interior.begin(), interior.end());
}

/// Appends the sides between two cells of this piece of different tags that are not listed.
void addBetweenTags(const DistributedMesh& mesh, const std::vector<unsigned char>& among,
  const std::vector<Listed>& all, const std::vector<std::uint64_t>& tags,
  std::vector<Facet>& facets)
{
  struct Side
  {
    Ids key;
    GlobalId cell;
    Facet facet;
  };
  std::vector<Side> sides;
  const auto& ids = mesh.converted.cellIds[mesh.mesh().dimension];
  forEachSide(mesh.mesh(),
    [&](const Facet& side)
    {
      if (std::all_of(side.begin(), side.end(), [&](Index vertex) { return among[vertex] != 0; }))
      {
        sides.push_back({ keyOf(mesh.mesh(), side.vertices), ids[side.cell],
          { side.vertices, side.cell, true } });
      }
    });
  std::sort(sides.begin(), sides.end(),
    [](const Side& a, const Side& b)
    { return std::pair(a.key, a.cell) < std::pair(b.key, b.cell); });
  for (std::size_t k = 1; k < sides.size(); ++k)
  {
    const Side& first = sides[k - 1];
    if (first.key == sides[k].key &&
        areDifferent(tags[first.facet.cell], tags[sides[k].facet.cell]) &&
        findListed(all, first.key) == all.size())
    {
      facets.push_back(first.facet);
    }
  }
}

} // namespace

std::array<GlobalId, 4> idsOf(const Mesh& mesh, const std::array<Index, 4>& corners)
{
  std::array<GlobalId, 4> ids;
  std::transform(
    corners.begin(), corners.end(), ids.begin(), [&](Index v) { return v < 0 ? -1 : mesh.ids[v]; });
  return ids;
}

std::vector<Facet> findBoundaryFacets(RankExchange& exchange, const DistributedMesh& mesh,
  const std::vector<unsigned char>& among, const std::vector<std::uint64_t>& tags)
{
  std::vector<Facet> facets = findOuterFacets(mesh.mesh(), among, forOnThreads(exchange));
  const bool anyListed = exchange.any(mesh.mesh().cellCount(mesh.mesh().dimension - 1) > 0);
  std::vector<Listed> all;
  if (anyListed)
  {
    all = gatherListed(exchange, mesh);
    meetListed(mesh, all);
  }
  const bool areTagged = exchange.any(!tags.empty());
  settleShared(exchange, mesh, anyListed || areTagged, all, tags, facets);
  if (!tags.empty())
  {
    addBetweenTags(mesh, among, all, tags, facets);
  }
  for (const Listed& listed : all)
  {
    if (listed.met > 1)
    {
      facets.push_back(interiorFacet(listed));
    }
  }
  return facets;
}

std::vector<unsigned char> verticesBetweenTags(
  RankExchange& exchange, const DistributedMesh& mesh, const std::vector<std::uint64_t>& tags)
{
  const Mesh& piece = mesh.mesh();
  std::vector<unsigned char> flags(piece.points.size(), 0);
  if (!exchange.any(!tags.empty()))
  {
    return flags;
  }
  std::vector<std::uint64_t> smallest(
    piece.points.size(), std::numeric_limits<std::uint64_t>::max());
  std::vector<std::uint64_t> largest(piece.points.size(), 0);
  auto tag = tags.begin();
  visitOwnShapes(piece,
    [&](auto, const auto& cells)
    {
      for (const auto& cell : cells)
      {
        for (const Index v : cell)
        {
          smallest[v] = std::min(smallest[v], *tag);
          largest[v] = std::max(largest[v], *tag);
        }
        ++tag;
      }
    });
  combineSmallest(exchange, mesh.shared, smallest);
  combineLargest(exchange, mesh.shared, largest);
  for (std::size_t v = 0; v < flags.size(); ++v)
  {
    flags[v] = smallest[v] < largest[v];
  }
  return flags;
}

std::vector<unsigned char> verticesOfListedLines(
  RankExchange& exchange, const DistributedMesh& mesh)
{
  const Mesh& piece = mesh.mesh();
  std::vector<unsigned char> flags(piece.points.size(), 0);
  const auto flag = [&](const auto& cells)
  {
    for (const auto& cell : cells)
    {
      for (const Index v : cell)
      {
        flags[v] = 1;
      }
    }
  };
  flag(piece.vertices);
  if (piece.dimension == 3)
  {
    flag(piece.segments);
  }
  combineFlags(exchange, mesh.shared, flags);
  return flags;
}

} // namespace cadrefine
