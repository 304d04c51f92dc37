// The geometric error of one facet.
#pragma once

#include <cadrefine/error/GeometricError.h>

#include <vector>

namespace cadtest
{

/// geometricErrors of a surface of this facet alone.
inline cadrefine::FacetError geometricError(
  const cadrefine::BoundaryProjector& projector, const cadrefine::ErrorFacet& facet, int depth)
{
  using namespace cadrefine;
  ClassifiedSurface surface;
  surface.kind = projector.kind();
  const bool isTriangle = surface.kind == BoundaryKind::Triangles;
  const Index corners = isTriangle ? 3 : 2;
  for (Index k = 0; k < corners; ++k)
  {
    SurfacePoint& p = surface.points.emplace_back(
      SurfacePoint{ facet.corners.points[k], facet.corners.entities[k] });
    if (facet.offCAD[k])
    {
      const ClosestPoint where = projector.nearestOn(p.entity, p.point);
      p.place = where.point;
      p.placeEntity = where.entity;
    }
  }
  for (Index k = 0; k < (isTriangle ? 3 : 1); ++k)
  {
    surface.edges.push_back({ { k, (k + 1) % corners }, facet.edges[k] });
  }
  surface.facets.push_back({ { 0, 1, 2 }, { 0, 1, 2 } });
  const auto project = [&](const std::vector<BoundaryEdge>& edges)
  {
    std::vector<ClosestPoint> midpoints;
    for (const BoundaryEdge& edge : edges)
    {
      midpoints.push_back(projector.projectMidpoint(edge));
    }
    return midpoints;
  };
  return geometricErrors(surface, project(surface.allEdges()), depth, 1, project)[0];
}

} // namespace cadtest
