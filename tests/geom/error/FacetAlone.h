// The geometric error of one facet.
#pragma once

#include <cadrefine/classification/MidpointProjection.h>
#include <cadrefine/error/GeometricError.h>

#include <algorithm>
#include <vector>

namespace cadtest
{

/// The places of the midpoints, one after the other.
inline std::vector<cadrefine::ClosestPoint> projectEdges(
  const cadrefine::BoundaryProjector& projector, const std::vector<cadrefine::BoundaryEdge>& edges)
{
  std::vector<cadrefine::ClosestPoint> midpoints(edges.size());
  std::transform(edges.begin(), edges.end(), midpoints.begin(),
    [&](const cadrefine::BoundaryEdge& edge) { return projectMidpoint(projector, edge); });
  return midpoints;
}

/// geometricErrors of a surface of this facet alone.
inline cadrefine::FacetError geometricError(
  const cadrefine::BoundaryProjector& projector, const cadrefine::ErrorFacet& facet, int depth)
{
  using namespace cadrefine;
  ClassifiedSurface surface;
  surface.kind = projector.kind();
  const bool isTriangle = surface.kind == BoundaryKind::Faces;
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
  { return projectEdges(projector, edges); };
  return geometricErrors(surface, project(surface.allEdges()), depth, 1, project)[0];
}

} // namespace cadtest
