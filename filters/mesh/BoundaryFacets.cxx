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

/// The cells of the mesh, their sides, and the listed cells of one dimension less, given the number
/// of a side's corners.
template<std::size_t N>
struct Sides;

template<>
struct Sides<3>
{
  static constexpr auto& ofCell = tetrahedronFaces;
  static const Simplices<4>& cells(const SimplexMesh& mesh) { return mesh.tetrahedra; }
  static const Simplices<3>& listed(const SimplexMesh& mesh) { return mesh.triangles; }
};

template<>
struct Sides<2>
{
  static constexpr auto& ofCell = triangleEdges;
  static const Simplices<3>& cells(const SimplexMesh& mesh) { return mesh.triangles; }
  static const Simplices<2>& listed(const SimplexMesh& mesh) { return mesh.segments; }
};

template<std::size_t N>
using Corners = std::array<Index, N>;
template<std::size_t N>
using Ids = std::array<GlobalId, N>;

/// A listed cell, on this rank or another, and the cells of this rank that it is a side of.
template<std::size_t N>
struct Listed
{
  Ids<N> key; ///< Ids of the corners, ascending.
  Corners<N> corners;
  int met = 0;
  GlobalId smallest = std::numeric_limits<GlobalId>::max(); ///< Id of a cell that meets it.
  Index cell = -1;                                          ///< That cell.
};

template<std::size_t N>
Ids<N> idsOf(const SimplexMesh& mesh, const Corners<N>& corners)
{
  Ids<N> ids;
  std::transform(corners.begin(), corners.end(), ids.begin(), [&](Index v) { return mesh.ids[v]; });
  return ids;
}

template<std::size_t N>
Ids<N> keyOf(const SimplexMesh& mesh, const Corners<N>& corners)
{
  Ids<N> ids = idsOf(mesh, corners);
  std::sort(ids.begin(), ids.end());
  return ids;
}

/// The ids of this rank's listed cells that each neighbour may have too.
template<std::size_t N>
std::vector<std::vector<Ids<N>>> idsForNeighbours(const DistributedMesh& mesh)
{
  const SharedVertices& shared = mesh.shared;
  std::vector<std::vector<Ids<N>>> outgoing(shared.neighbours.size());
  for (const Corners<N>& corners : Sides<N>::listed(mesh.mesh()))
  {
    for (const int rank : shared.holdersOf(corners[0]))
    {
      const auto isHeld = [&](Index vertex)
      {
        const auto holders = shared.holdersOf(vertex);
        return std::binary_search(holders.begin(), holders.end(), rank);
      };
      if (rank != shared.rank && std::all_of(corners.begin(), corners.end(), isHeld))
      {
        const auto n = std::lower_bound(shared.neighbours.begin(), shared.neighbours.end(), rank);
        outgoing[n - shared.neighbours.begin()].push_back(idsOf(mesh.mesh(), corners));
      }
    }
  }
  return outgoing;
}

/// The listed cells of this rank, and those of others whose corners it has, by keys.
template<std::size_t N>
std::vector<Listed<N>> gatherListed(RankExchange& exchange, const DistributedMesh& distributed)
{
  const SimplexMesh& mesh = distributed.mesh();
  std::vector<std::pair<GlobalId, Index>> vertexOf;
  for (const Index vertex : distributed.shared.all)
  {
    vertexOf.emplace_back(mesh.ids[vertex], vertex);
  }
  std::sort(vertexOf.begin(), vertexOf.end());
  const auto find = [&](GlobalId id) {
    return std::lower_bound(vertexOf.begin(), vertexOf.end(), std::pair{ id, Index{ 0 } })->second;
  };
  std::vector<Listed<N>> all;
  for (const Corners<N>& corners : Sides<N>::listed(mesh))
  {
    all.push_back({ keyOf(mesh, corners), corners });
  }
  for (const auto& ofNeighbour :
    exchange.exchange(distributed.shared.neighbours, idsForNeighbours<N>(distributed)))
  {
    for (const Ids<N>& ids : ofNeighbour)
    {
      Corners<N> corners;
      std::transform(ids.begin(), ids.end(), corners.begin(), find);
      all.push_back({ keyOf(mesh, corners), corners });
    }
  }
  std::sort(all.begin(), all.end(),
    [&](const Listed<N>& a, const Listed<N>& b) {
      return std::pair(a.key, idsOf(mesh, a.corners)) < std::pair(b.key, idsOf(mesh, b.corners));
    });
  all.erase(std::unique(all.begin(), all.end(),
              [](const Listed<N>& a, const Listed<N>& b) { return a.key == b.key; }),
    all.end());
  return all;
}

/// Which one has this key, of those that are by keys; none: their number.
template<std::size_t N>
std::size_t findListed(const std::vector<Listed<N>>& all, const Ids<N>& key)
{
  const auto found = std::lower_bound(all.begin(), all.end(), key,
    [](const Listed<N>& listed, const Ids<N>& wanted) { return listed.key < wanted; });
  return found != all.end() && found->key == key ? found - all.begin() : all.size();
}

/// Finds which cells of this rank meet the listed ones.
template<std::size_t N>
void meetListed(const DistributedMesh& distributed, std::vector<Listed<N>>& all)
{
  const SimplexMesh& mesh = distributed.mesh();
  std::vector<unsigned char> onListed(mesh.points.size(), 0);
  for (const Listed<N>& listed : all)
  {
    for (const Index corner : listed.corners)
    {
      onListed[corner] = 1;
    }
  }
  const auto& cells = Sides<N>::cells(mesh);
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    for (const auto& side : Sides<N>::ofCell)
    {
      Corners<N> corners;
      std::transform(std::begin(side), std::end(side), corners.begin(),
        [&](int corner) { return cells[c][corner]; });
      const bool near = std::all_of(
        corners.begin(), corners.end(), [&](Index vertex) { return onListed[vertex] != 0; });
      const std::size_t found = near ? findListed(all, keyOf(mesh, corners)) : all.size();
      if (found < all.size())
      {
        Listed<N>& listed = all[found];
        const GlobalId id = distributed.converted.cellIds[mesh.dimension][c];
        ++listed.met;
        listed.cell = id < listed.smallest ? static_cast<Index>(c) : listed.cell;
        listed.smallest = std::min(listed.smallest, id);
      }
    }
  }
}

template<std::size_t N>
Facet facetOf(const Listed<N>& listed)
{
  Facet facet;
  facet.vertices.fill(-1);
  std::copy(listed.corners.begin(), listed.corners.end(), facet.vertices.begin());
  facet.cell = listed.cell;
  return facet;
}

/// Removes the facets that another rank meets too, but for listed ones whose cell has the smaller
/// id.
template<std::size_t N>
void settleShared(RankExchange& exchange, const DistributedMesh& mesh, bool anyListed,
  const std::vector<Listed<N>>& all, std::vector<Facet>& facets)
{
  const auto idOf = [&](const Facet& facet)
  { return mesh.converted.cellIds[mesh.mesh().dimension][facet.cell]; };
  std::vector<Corners<N>> corners(facets.size());
  for (std::size_t f = 0; f < facets.size(); ++f)
  {
    std::copy_n(facets[f].vertices.begin(), N, corners[f].begin());
  }
  const SharedItems shared =
    findSharedSimplices<N>(exchange, mesh.shared, mesh.mesh().ids, corners);
  std::vector<GlobalId> smallest;
  if (anyListed)
  {
    smallest.resize(facets.size());
    std::transform(facets.begin(), facets.end(), smallest.begin(), idOf);
    combineShared(
      exchange, shared, smallest, [](GlobalId a, GlobalId b) { return std::min(a, b); });
  }
  std::vector<Facet> interior;
  for (const Index f : shared.all)
  {
    const std::size_t listed = findListed(all, keyOf(mesh.mesh(), corners[f]));
    if (listed < all.size() && smallest[f] == idOf(facets[f]))
    {
      interior.push_back(facetOf(all[listed]));
    }
    facets[f].cell = -1;
  }
  facets.erase(
    std::remove_if(facets.begin(), facets.end(), [](const Facet& facet) { return facet.cell < 0; }),
    facets.end());
  facets.insert(facets.end(), interior.begin(), interior.end());
}

template<std::size_t N>
std::vector<Facet> findFacets(
  RankExchange& exchange, const DistributedMesh& mesh, const std::vector<unsigned char>& among)
{
  std::vector<Facet> facets = findOuterFacets(mesh.mesh(), among, forOnThreads(exchange));
  const bool anyListed = exchange.any(!Sides<N>::listed(mesh.mesh()).empty());
  std::vector<Listed<N>> all;
  if (anyListed)
  {
    all = gatherListed<N>(exchange, mesh);
    meetListed(mesh, all);
  }
  settleShared(exchange, mesh, anyListed, all, facets);
  for (const Listed<N>& listed : all)
  {
    if (listed.met > 1)
    {
      facets.push_back(facetOf(listed));
    }
  }
  return facets;
}

} // namespace

std::vector<Facet> findBoundaryFacets(
  RankExchange& exchange, const DistributedMesh& mesh, const std::vector<unsigned char>& among)
{
  return mesh.mesh().dimension == 3 ? findFacets<3>(exchange, mesh, among)
                                    : findFacets<2>(exchange, mesh, among);
}

} // namespace cadrefine
