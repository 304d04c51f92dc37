#include "motion/ColumnStarts.h"

#include "comm/CollectiveErrors.h"
#include "mesh/BoundaryFacets.h"

#include <cadrefine/classification/ClassificationTolerances.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <type_traits>

namespace cadrefine
{
namespace
{

/// The facet at a moving node whose normal is nearest to the direction of its move.
struct BestFacet
{
  double cosine = -1;
  std::array<GlobalId, 4> ids{};
};

BestFacet better(const BestFacet& a, const BestFacet& b)
{
  return a.cosine != b.cosine ? (a.cosine > b.cosine ? a : b) : (a.ids < b.ids ? a : b);
}

/// The sides of quadrilaterals of a surface in space that are on CAD edges, once for each cell.
std::vector<Facet> findSidesOnEdges(const Columns& columns)
{
  const ColumnNodes& nodes = columns.nodes;
  std::vector<Facet> sides;
  forEachSide(columns.mesh.mesh(),
    [&](Facet side)
    {
      EntityId edge;
      bool isOnEdge = side.cell >= static_cast<Index>(columns.mesh.mesh().triangles.size());
      for (int k = 0; k < nodes.count(side) && isOnEdge; ++k)
      {
        const EntityId entity = nodes.entities[nodes.at(side, k)];
        isOnEdge = entity.dimension == 0 || (entity.dimension == 1 && (!edge || edge == entity));
        edge = entity.dimension == 1 ? entity : edge;
      }
      if (isOnEdge)
      {
        side.isInside = true;
        sides.push_back(side);
      }
    });
  return sides;
}

/// Whether there are at most 32 different ones of these tags, over all ranks. Where there are more,
/// they may number cells that were refined since. (They are told apart by ten of their bits.)
/// Collective: a reduction of 8 KiB.
bool areFewKinds(RankExchange& exchange, const std::vector<std::uint64_t>& tags)
{
  std::vector<std::int64_t> counts(1024, 0);
  for (const std::uint64_t tag : tags)
  {
    counts[tag % counts.size()] = 1;
  }
  counts = exchange.sum(counts);
  return static_cast<std::int64_t>(counts.size()) - std::count(counts.begin(), counts.end(), 0) <=
         32;
}

/// The tags of cells that columns may go through, if they are few; 0 for others, where the stacks
/// of cells end. Collective.
std::vector<std::uint64_t> tagsInStacks(
  RankExchange& exchange, const Mesh& mesh, std::vector<std::uint64_t> tags)
{
  if (!areFewKinds(exchange, tags))
  {
    return {};
  }
  auto tag = tags.begin();
  visitOwnShapes(mesh,
    [&](auto shape, const auto& cells)
    {
      const auto end = tag + (tags.empty() ? 0 : static_cast<std::ptrdiff_t>(cells.size()));
      if constexpr (isSimplex(shape) || std::is_same_v<decltype(shape), shapes::Pyramid>)
      {
        std::fill(tag, end, 0);
      }
      tag = end;
    });
  return tags;
}

/// The walls inside the mesh, facets between two cells: on the CAD, or not even beside it. A wall
/// of the latter kind stays, and counts as an outer one from then on. Collective.
InnerWalls findInnerWalls(RankExchange& exchange, Columns& columns)
{
  const ColumnNodes& nodes = columns.nodes;
  const Mesh& mesh = columns.mesh.mesh();
  InnerWalls walls{ std::vector<unsigned char>(mesh.points.size(), 0),
    std::vector<unsigned char>(mesh.points.size(), 0) };
  const auto look = [&](Facet& facet)
  {
    bool isOnCAD = true;
    for (int k = 0; k < nodes.count(facet) && isOnCAD; ++k)
    {
      isOnCAD = static_cast<bool>(nodes.entities[nodes.at(facet, k)]);
    }
    const bool stays =
      !isOnCAD && !columns.projector.isBesideCAD(pointsOf(mesh, facet), facet.corners());
    for (const Index vertex : facet)
    {
      walls.onCAD[vertex] = walls.onCAD[vertex] || isOnCAD;
      walls.staying[vertex] = walls.staying[vertex] || stays;
    }
    facet.isInside = !stays;
  };
  agreeOnFailure(exchange,
    [&]
    {
      for (Facet& facet : columns.facets)
      {
        if (facet.isInside)
        {
          look(facet);
        }
      }
    });
  combineFlags(exchange, columns.mesh.shared, walls.onCAD);
  combineFlags(exchange, columns.mesh.shared, walls.staying);
  return walls;
}

std::array<GlobalId, 4> sortedIdsOf(const Mesh& mesh, const Facet& facet)
{
  auto ids = idsOf(mesh, facet.vertices);
  std::sort(ids.begin(), ids.end());
  return ids;
}

/// For each moving node the facet that its column stands on; none for a node that moves only by a
/// rounding. Collective.
std::vector<BestFacet> findBestFacets(
  RankExchange& exchange, const Columns& columns, const Moves& moves)
{
  const ColumnNodes& nodes = columns.nodes;
  const double rounding = ClassificationTolerances::tie * columns.projector.model().size();
  std::vector<BestFacet> best(nodes.points.size());
  for (const Facet& facet : columns.facets)
  {
    const Vector3 normal = columns.normalOf(facet);
    for (int k = 0; k < nodes.count(facet); ++k)
    {
      const Index n = nodes.at(facet, k);
      const Vector3 move = moves.targets[n] - nodes.points[n];
      if (moves.fractions[n] > 0 && norm(move) > rounding)
      {
        best[n] = better(best[n],
          { std::abs(dot(normalized(move), normal)), sortedIdsOf(columns.mesh.mesh(), facet) });
      }
    }
  }
  combineShared(exchange, nodes.shared, best, better);
  return best;
}

} // namespace

ColumnStarts startColumns(RankExchange& exchange, const Moves& moves,
  const BoundarySearch& boundary, const CellStacks& stacks, Columns& columns)
{
  const ColumnNodes& nodes = columns.nodes;
  columns.facets = columns.onSurface()
                     ? findSidesOnEdges(columns)
                     : findBoundaryFacets(exchange, columns.mesh, boundary.among,
                         tagsInStacks(exchange, columns.mesh.mesh(), boundary.tags));
  const auto best = findBestFacets(exchange, columns, moves);
  const InnerWalls walls = findInnerWalls(exchange, columns);
  ColumnClimb climb(columns.mesh, stacks, nodes, moves, walls, columns.onSurface());
  for (const Facet& facet : columns.facets)
  {
    for (int k = 0; k < nodes.count(facet); ++k)
    {
      const Index n = nodes.at(facet, k);
      if (moves.fractions[n] > 0 && best[n].ids == sortedIdsOf(columns.mesh.mesh(), facet))
      {
        const Vector3 move = moves.targets[n] - nodes.points[n];
        const double length = norm(move);
        const double inCell =
          columns.onSurface() ? std::abs(dot(move, columns.normalOf(facet))) : length;
        climb.start(facet, k, inCell / nodes.leastMove, reachOfMove * length);
      }
    }
  }
  ColumnStarts starts;
  std::transform(best.begin(), best.end(), std::back_inserter(starts.cosines),
    [](const BestFacet& facet) { return facet.cosine; });
  starts.visits = climb.run(exchange);
  return starts;
}

} // namespace cadrefine
