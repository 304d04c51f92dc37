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
  error.chordError = std::max(error.chordError, where.distance);
  error.maximumDistance = std::max(error.maximumDistance, where.distance);
  return { where.point, where.entity };
}

/// Adds the error of a child.
void add(FacetError& sum, const FacetError& part)
{
  sum.measure += part.measure;
  sum.maximumDistance = std::max(sum.maximumDistance, part.maximumDistance);
}

/// The corners' places on the CAD: the corners themselves where they lie on it.
std::array<Corner, 3> cornersOnCAD(
  const BoundaryProjector& projector, const ErrorFacet& facet, int corners, FacetError& error)
{
  std::array<Corner, 3> result;
  for (int k = 0; k < corners; ++k)
  {
    const Point3& p = facet.corners.points[k];
    result[k] = { p, facet.corners.entities[k] };
    if (facet.offCAD[k])
    {
      const ClosestPoint where = projector.nearestOn(result[k].entity, p);
      error.maximumDistance = std::max(error.maximumDistance, where.distance);
      result[k] = { where.point, where.entity };
    }
  }
  return result;
}

FacetError segmentError(const BoundaryProjector& projector, const ErrorFacet& facet, int depth)
{
  FacetError error;
  const auto c = cornersOnCAD(projector, facet, 2, error);
  const Corner m = projectedMidpoint(projector, facet, 0, 2, error);
  const auto& p = facet.corners.points;
  error.measure = 0.5 * norm(twofoldAreaVector(p[0], p[1], c[1].point) +
                             twofoldAreaVector(p[0], c[1].point, m.point) +
                             twofoldAreaVector(p[0], m.point, c[0].point));
  if (depth > 1)
  {
    const ErrorFacet first{ { { c[0].point, m.point }, { c[0].entity, m.entity } }, facet.edges };
    const ErrorFacet second{ { { m.point, c[1].point }, { m.entity, c[1].entity } }, facet.edges };
    add(error, segmentError(projector, first, depth - 1));
    add(error, segmentError(projector, second, depth - 1));
  }
  return error;
}

/// Six times the signed volume of the polyhedron between the triangle and its children.
double sixfoldVolumeBetween(
  const std::array<Point3, 3>& p, const std::array<Corner, 3>& c, const std::array<Corner, 3>& m)
{
  const Point3& origin = p[0];
  const auto over = [&](const Point3& x, const Point3& y, const Point3& z)
  { return dot(x - origin, cross(y - origin, z - origin)); };
  double volume = over(m[0].point, m[1].point, m[2].point);
  for (int k = 0; k < 3; ++k)
  {
    const int next = (k + 1) % 3;
    const int previous = (k + 2) % 3;
    volume += over(c[k].point, m[k].point, m[previous].point); // the child at corner k
    volume += over(p[k], p[next], m[k].point);                 // the side over edge k
    volume += over(p[k], m[k].point, c[k].point);
    volume += over(p[next], c[next].point, m[k].point);
  }
  return volume; // the flat triangle itself passes through the origin
}

FacetError triangleError(const BoundaryProjector& projector, const ErrorFacet& facet, int depth)
{
  FacetError error;
  const auto c = cornersOnCAD(projector, facet, 3, error);
  std::array<Corner, 3> m;
  for (int k = 0; k < 3; ++k)
  {
    m[k] = projectedMidpoint(projector, facet, k, 3, error);
  }
  error.measure = std::abs(sixfoldVolumeBetween(facet.corners.points, c, m)) / 6;
  if (depth <= 1)
  {
    return error;
  }
  const EdgeClass inner{ EdgeClass::Smooth, -1 };
  for (int k = 0; k < 3; ++k)
  {
    const int previous = (k + 2) % 3;
    const ErrorFacet child{ { { c[k].point, m[k].point, m[previous].point },
                              { c[k].entity, m[k].entity, m[previous].entity } },
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
