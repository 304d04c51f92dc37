#include "motion/FirstEdges.h"

#include <cadrefine/classification/CADAdjacency.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace cadrefine
{
namespace
{

/// First edges whose lengths differ by less than this part of them were made equal.
constexpr double equal = 1e-3;
/// A first edge stays if it is too short by less than `leastLift`, or by more than `mostLift`, of
/// its wanted length.
constexpr double leastLift = 1e-3;
constexpr double mostLift = 0.35;

const FirstEdge& shorter(const FirstEdge& a, const FirstEdge& b)
{
  if (a.wantedLength == 0 || b.wantedLength == 0)
  {
    return a.wantedLength == 0 ? b : a;
  }
  return std::pair(a.wantedLength, a.up) < std::pair(b.wantedLength, b.up) ? a : b;
}

/// Whether an edge is halfway between two that are equally long.
bool isBetweenEqual(const FirstEdge& edge, const FirstEdge& a, const FirstEdge& b)
{
  const double longest = std::max(a.wantedLength, b.wantedLength);
  return edge.wantedLength > 0 && a.wantedLength > 0 && b.wantedLength > 0 &&
         distance(edge.up, 0.5 * (a.up + b.up)) < equal * edge.wantedLength &&
         std::abs(a.wantedLength - b.wantedLength) < equal * longest;
}

bool isTooShort(const FirstEdge& edge)
{
  const double lift = edge.wantedLength - norm(edge.up);
  return lift > leastLift * edge.wantedLength && lift < mostLift * edge.wantedLength;
}

/// The part of a way along a face of this normal.
Vector3 along(const Vector3& way, const Vector3& normal)
{
  return way - dot(way, normal) * normal;
}

/// The normal of the CAD on which a wall is to be, where it is nearest to a point: of its face, or
/// of its curve in the plane of an edge over the wall.
Vector3 normalNear(const BoundaryProjector& projector, const EntityId& wall, const Point3& point,
  const Vector3& edge)
{
  const CADModel& model = projector.model();
  if (wall.dimension == 2)
  {
    return model.normalNear(wall.index, point);
  }
  const ClosestPoint where = projector.nearestOn(wall, point);
  const Vector3 tangent = where.entity.dimension == 1
                            ? model.tangent(wall.index, where.parameters[0])
                            : tangentAwayFrom(model, wall.index, where.entity.index);
  return normalized(along(edge, tangent));
}

/// The edge over a new node of a wall once the node is at `place`, given those over the ends of the
/// line that it halves, which come to `places`: as long as wanted, and inclined to the normal of
/// the CAD by the mean of theirs. It keeps its direction where there is no single normal, or the
/// boundary holds its upper end.
Vector3 liftedEdge(const FirstEdge& edge, const EntityId& wall, const BoundaryProjector& projector,
  const Point3& place, const std::array<Point3, 2>& places, const std::array<Vector3, 2>& ups)
{
  const Vector3 asItGoes = normalized(edge.up);
  if (wall.dimension != dimensionOf(projector.kind()) || edge.onBoundary)
  {
    return edge.wantedLength * asItGoes;
  }
  Vector3 aside{};
  for (std::size_t end = 0; end < ups.size(); ++end)
  {
    const Vector3 up = normalized(ups[end]);
    aside = aside + 0.5 * along(up, normalNear(projector, wall, places[end], up));
  }
  const Vector3 normal = normalNear(projector, wall, place, asItGoes);
  aside = along(aside, normal);
  const double height = std::sqrt(std::max(0.0, 1 - squaredNorm(aside)));
  return edge.wantedLength * (aside + std::copysign(height, dot(normal, asItGoes)) * normal);
}

} // namespace

std::vector<FirstEdge> findFirstEdges(RankExchange& exchange, const CellStacks& stacks,
  const ColumnNodes& nodes, const std::vector<Facet>& facets, const Moves& moves,
  const BoundaryProjector& projector, const std::vector<unsigned char>& onBoundary)
{
  std::vector<FirstEdge> edges(nodes.points.size());
  for (const Facet& facet : facets)
  {
    const Facet above = stacks.opposite(facet);
    for (int k = 0; above.cell >= 0 && k < nodes.count(facet); ++k)
    {
      const Index node = nodes.at(facet, k);
      const Index first = nodes.at(above, k);
      const Vector3 up = nodes.points[first] - nodes.points[node];
      edges[node] = shorter(edges[node], { up, norm(up), onBoundary[first] == 1, up });
    }
  }
  combineShared(exchange, nodes.shared, edges, shorter);
  // Parents come before the nodes between them.
  const std::size_t first = edges.size() - nodes.parents->size();
  for (std::size_t n = first; n < edges.size(); ++n)
  {
    FirstEdge& edge = edges[n];
    const auto& [a, b] = (*nodes.parents)[n - first];
    if (isBetweenEqual(edge, edges[a], edges[b]))
    {
      edge.wantedLength = 0.5 * (edges[a].wantedLength + edges[b].wantedLength);
    }
    if (nodes.entities[n] && isTooShort(edge))
    {
      edge.lifted = liftedEdge(edge, nodes.entities[n], projector, moves.targets[n],
        { moves.targets[a], moves.targets[b] }, { edges[a].lifted, edges[b].lifted });
    }
  }
  return edges;
}

} // namespace cadrefine
