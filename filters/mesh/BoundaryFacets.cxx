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

/// A listed cell, on this rank or another, and the cells of this rank that it is a side of.
template<std::size_t N>
struct Listed
{
  std::array<GlobalId, N> key; ///< Ids of the corners, ascending.
  std::array<Index, N> corners;
  int met = 0;
  GlobalId smallest = std::numeric_limits<GlobalId>::max(); ///< Id of a cell that meets it.
  Index cell = -1;                                          ///< That cell.
};

template<std::size_t N>
class FacetFinder
{
public:
  FacetFinder(
    RankExchange& exchange, const DistributedMesh& mesh, const std::vector<unsigned char>& among)
    : exchange_(exchange), mesh_(mesh),
      facets_(findOuterFacets(mesh.mesh(), among, forOnThreads(exchange)))
  {
  }

  std::vector<Facet> find()
  {
    const bool anyListed = exchange_.any(!Sides<N>::listed(mesh_.mesh()).empty());
    if (anyListed)
    {
      gatherListed();
      meetListed();
    }
    settleShared(anyListed);
    for (const Listed<N>& listed : listed_)
    {
      if (listed.met > 1)
      {
        add(listed);
      }
    }
    return std::move(facets_);
  }

private:
  using Corners = std::array<Index, N>;
  using Ids = std::array<GlobalId, N>;

  Ids idsOf(const Corners& corners) const
  {
    Ids ids;
    std::transform(
      corners.begin(), corners.end(), ids.begin(), [&](Index v) { return mesh_.mesh().ids[v]; });
    return ids;
  }

  static Ids sorted(Ids ids)
  {
    std::sort(ids.begin(), ids.end());
    return ids;
  }

  /// The ids of this rank's listed cells that each neighbour may have too.
  std::vector<std::vector<Ids>> idsForNeighbours() const
  {
    const SharedVertices& shared = mesh_.shared;
    std::vector<std::vector<Ids>> outgoing(shared.neighbours.size());
    for (const Corners& corners : Sides<N>::listed(mesh_.mesh()))
    {
      for (const int rank : shared.holdersOf(corners[0]))
      {
        const auto isHeld = [&](Index vertex)
        {
          const auto holders = shared.holdersOf(vertex);
          return std::binary_search(holders.begin(), holders.end(), rank);
        };
        if (rank != exchange_.rank() && std::all_of(corners.begin(), corners.end(), isHeld))
        {
          const auto n = std::lower_bound(shared.neighbours.begin(), shared.neighbours.end(), rank);
          outgoing[n - shared.neighbours.begin()].push_back(idsOf(corners));
        }
      }
    }
    return outgoing;
  }

  /// Fills listed_, by keys.
  void gatherListed()
  {
    std::vector<std::pair<GlobalId, Index>> vertexOf;
    for (const Index vertex : mesh_.shared.all)
    {
      vertexOf.emplace_back(mesh_.mesh().ids[vertex], vertex);
    }
    std::sort(vertexOf.begin(), vertexOf.end());
    const auto find = [&](GlobalId id) {
      return std::lower_bound(vertexOf.begin(), vertexOf.end(), std::pair{ id, Index{ 0 } })
        ->second;
    };
    const auto add = [&](const Corners& corners) {
      listed_.push_back({ sorted(idsOf(corners)), corners });
    };
    for (const Corners& corners : Sides<N>::listed(mesh_.mesh()))
    {
      add(corners);
    }
    for (const auto& ofNeighbour : exchange_.exchange(mesh_.shared.neighbours, idsForNeighbours()))
    {
      for (const Ids& ids : ofNeighbour)
      {
        Corners corners;
        std::transform(ids.begin(), ids.end(), corners.begin(), find);
        add(corners);
      }
    }
    std::sort(listed_.begin(), listed_.end(),
      [&](const Listed<N>& a, const Listed<N>& b)
      { return std::pair(a.key, idsOf(a.corners)) < std::pair(b.key, idsOf(b.corners)); });
    listed_.erase(std::unique(listed_.begin(), listed_.end(),
                    [](const Listed<N>& a, const Listed<N>& b) { return a.key == b.key; }),
      listed_.end());
  }

  Listed<N>* findListed(const Corners& corners)
  {
    const Ids key = sorted(idsOf(corners));
    const auto found = std::lower_bound(listed_.begin(), listed_.end(), key,
      [](const Listed<N>& listed, const Ids& wanted) { return listed.key < wanted; });
    return found != listed_.end() && found->key == key ? &*found : nullptr;
  }

  /// Finds which cells of this rank meet the listed ones.
  void meetListed()
  {
    const SimplexMesh& mesh = mesh_.mesh();
    std::vector<unsigned char> onListed(mesh.points.size(), 0);
    for (const Listed<N>& listed : listed_)
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
        Corners corners;
        std::transform(std::begin(side), std::end(side), corners.begin(),
          [&](int corner) { return cells[c][corner]; });
        const bool near = std::all_of(
          corners.begin(), corners.end(), [&](Index vertex) { return onListed[vertex] != 0; });
        if (Listed<N>* listed = near ? findListed(corners) : nullptr)
        {
          const GlobalId id = mesh_.converted.cellIds[mesh.dimension][c];
          ++listed->met;
          listed->cell = id < listed->smallest ? static_cast<Index>(c) : listed->cell;
          listed->smallest = std::min(listed->smallest, id);
        }
      }
    }
  }

  static Corners cornersOf(const Facet& facet)
  {
    Corners corners;
    std::copy_n(facet.vertices.begin(), N, corners.begin());
    return corners;
  }

  void add(const Listed<N>& listed)
  {
    Facet& facet = facets_.emplace_back();
    facet.vertices.fill(-1);
    std::copy(listed.corners.begin(), listed.corners.end(), facet.vertices.begin());
    facet.cell = listed.cell;
  }

  /// Removes the sides that another rank meets too, but for listed ones whose cell has the smaller
  /// id.
  void settleShared(bool anyListed)
  {
    std::vector<Corners> corners(facets_.size());
    std::transform(facets_.begin(), facets_.end(), corners.begin(), cornersOf);
    const SharedItems shared =
      findSharedSimplices<N>(exchange_, mesh_.shared, mesh_.mesh().ids, corners);
    std::vector<GlobalId> smallest;
    if (anyListed)
    {
      smallest.resize(facets_.size());
      std::transform(facets_.begin(), facets_.end(), smallest.begin(),
        [&](const Facet& facet) { return idOf(facet); });
      combineShared(
        exchange_, shared, smallest, [](GlobalId a, GlobalId b) { return std::min(a, b); });
    }
    std::vector<const Listed<N>*> interior;
    for (const Index f : shared.all)
    {
      const Listed<N>* listed = anyListed ? findListed(corners[f]) : nullptr;
      if (listed && smallest[f] == idOf(facets_[f]))
      {
        interior.push_back(listed);
      }
      facets_[f].cell = -1;
    }
    facets_.erase(std::remove_if(facets_.begin(), facets_.end(),
                    [](const Facet& facet) { return facet.cell < 0; }),
      facets_.end());
    std::for_each(interior.begin(), interior.end(), [&](const Listed<N>* listed) { add(*listed); });
  }

  GlobalId idOf(const Facet& facet) const
  {
    return mesh_.converted.cellIds[mesh_.mesh().dimension][facet.cell];
  }

  RankExchange& exchange_;
  const DistributedMesh& mesh_;
  std::vector<Facet> facets_;
  std::vector<Listed<N>> listed_;
};

} // namespace

std::vector<Facet> findBoundaryFacets(
  RankExchange& exchange, const DistributedMesh& mesh, const std::vector<unsigned char>& among)
{
  return mesh.mesh().dimension == 3 ? FacetFinder<3>(exchange, mesh, among).find()
                                    : FacetFinder<2>(exchange, mesh, among).find();
}

} // namespace cadrefine
