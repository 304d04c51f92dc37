#include "GeometricError.h"

#include "Quality.h"

#include <algorithm>
#include <cmath>

namespace cadrefine
{
namespace
{

struct Corner
{
  Point3 point;
  EntityId entity;
};

/// The corner that a new vertex in the middle of edge k would be.
Corner projectedMidpoint(const BoundaryProjector& projector, const ErrorFacet& facet, int k,
  int corners, FacetError& error)
{
  const int next = (k + 1) % corners;
  const auto& p = facet.corners.points;
  const auto& entities = facet.corners.entities;
  const Point3 middle = 0.5 * (p[k] + p[next]);
  const ClosestPoint where =
    projector.projectMidpoint(facet.edges[k], { p[k], p[next] }, { entities[k], entities[next] });
  if (!where.entity)
  {
    return { middle, {} };
  }
  error.maximumDistance = std::max(error.maximumDistance, where.distance);
  return { where.point, where.entity };
}

void add(FacetError& sum, const FacetError& part)
{
  sum.measure += part.measure;
  sum.maximumDistance = std::max(sum.maximumDistance, part.maximumDistance);
}

FacetError segmentError(const BoundaryProjector& projector, const ErrorFacet& facet, int depth)
{
  FacetError error;
  const Corner m = projectedMidpoint(projector, facet, 0, 2, error);
  const auto& p = facet.corners.points;
  error.measure = 0.5 * norm(twofoldAreaVector(p[0], p[1], m.point));
  if (depth > 1)
  {
    const auto& e = facet.corners.entities;
    add(error, segmentError(
                 projector, { { { p[0], m.point }, { e[0], m.entity } }, facet.edges }, depth - 1));
    add(error, segmentError(
                 projector, { { { m.point, p[1] }, { m.entity, e[1] } }, facet.edges }, depth - 1));
  }
  return error;
}

/// Six times the signed volume of the polyhedron between the triangle and its children.
double sixfoldVolumeBetween(const std::array<Point3, 3>& p, const std::array<Corner, 3>& m)
{
  const Point3& origin = p[0];
  const auto over = [&](const Point3& a, const Point3& b, const Point3& c)
  { return dot(a - origin, cross(b - origin, c - origin)); };
  double volume = over(m[0].point, m[1].point, m[2].point);
  for (int k = 0; k < 3; ++k)
  {
    const int next = (k + 1) % 3;
    const int previous = (k + 2) % 3;
    volume += over(p[k], m[k].point, m[previous].point); // the child at corner k
    volume += over(p[k], p[next], m[k].point);           // the side over edge k
  }
  return volume; // the flat triangle itself passes through the origin
}

FacetError triangleError(const BoundaryProjector& projector, const ErrorFacet& facet, int depth)
{
  FacetError error;
  std::array<Corner, 3> m;
  for (int k = 0; k < 3; ++k)
  {
    m[k] = projectedMidpoint(projector, facet, k, 3, error);
  }
  const auto& p = facet.corners.points;
  error.measure = std::abs(sixfoldVolumeBetween(p, m)) / 6;
  if (depth <= 1)
  {
    return error;
  }
  const auto& e = facet.corners.entities;
  const EdgeClass inner{ EdgeClass::Smooth, -1 };
  for (int k = 0; k < 3; ++k)
  {
    const int previous = (k + 2) % 3;
    const ErrorFacet child{ { { p[k], m[k].point, m[previous].point },
                              { e[k], m[k].entity, m[previous].entity } },
      { facet.edges[k], inner, facet.edges[previous] } };
    add(error, triangleError(projector, child, depth - 1));
  }
  const ErrorFacet middle{ { { m[0].point, m[1].point, m[2].point },
                             { m[0].entity, m[1].entity, m[2].entity } },
    { inner, inner, inner } };
  add(error, triangleError(projector, middle, depth - 1));
  return error;
}

} // namespace

FacetError geometricError(const BoundaryProjector& projector, const ErrorFacet& facet, int depth)
{
  return projector.kind() == BoundaryKind::Segments ? segmentError(projector, facet, depth)
                                                    : triangleError(projector, facet, depth);
}

} // namespace cadrefine
