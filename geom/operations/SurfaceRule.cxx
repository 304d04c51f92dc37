#include <cadrefine/operations/SurfaceRule.h>

#include <cadrefine/classification/ClassificationTolerances.h>
#include <cadrefine/mesh/Quality.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace cadrefine
{
namespace
{

/// Of the turn of a facet's normal (40 degrees).
const double turnCosine = ClassificationTolerances::cosineOfDegrees(40);

Vector3 normalOf(const EditableMesh& mesh, const std::array<Index, 3>& facet)
{
  return normalized(twofoldAreaVector(
    mesh.vertex(facet[0]).wanted, mesh.vertex(facet[1]).wanted, mesh.vertex(facet[2]).wanted));
}

} // namespace

SurfaceRule::Fit SurfaceRule::fitOf(
  const EditableMesh& mesh, const std::vector<Index>& facets) const
{
  Fit fit;
  // Of flat facets on a plane only rounding is left.
  fit.distance = ClassificationTolerances::leastExact * projector_.model().size();
  for (const Index facet : facets)
  {
    const auto& corners = mesh.facets()[facet].corners;
    widen(mesh, corners, fit);
  }
  return fit;
}

bool SurfaceRule::follows(
  const EditableMesh& mesh, const std::array<Index, 3>& facet, const Fit& before) const
{
  const Vector3 normal = normalOf(mesh, facet);
  if (std::none_of(before.normals.begin(), before.normals.end(),
        [&](const Vector3& other) { return dot(normal, other) >= turnCosine; }))
  {
    return false;
  }
  ClassifiedFacet onCAD{};
  for (int k = 0; k < 3; ++k)
  {
    onCAD.points[k] = mesh.vertex(facet[k]).wanted;
    onCAD.entities[k] = mesh.vertex(facet[k]).entity;
  }
  if (!projector_.isOnCAD(onCAD))
  {
    return false;
  }
  Fit fit;
  widen(mesh, facet, fit);
  return fit.distance <= before.distance && fit.cosine >= std::min(turnCosine, before.cosine);
}

bool SurfaceRule::accepts(const EditableMesh& mesh, const Cavity& cavity) const
{
  const Fit before = fitOf(mesh, cavity.facets);
  return std::all_of(cavity.newFacets.begin(), cavity.newFacets.end(),
    [&](const auto& facet) { return follows(mesh, facet.corners, before); });
}

/// Makes the fit that of another facet, too.
void SurfaceRule::widen(const EditableMesh& mesh, const std::array<Index, 3>& facet, Fit& fit) const
{
  const std::array<Point3, 3> p{ mesh.vertex(facet[0]).wanted, mesh.vertex(facet[1]).wanted,
    mesh.vertex(facet[2]).wanted };
  fit.normals.push_back(normalOf(mesh, facet));
  for (const Point3& point : { (1.0 / 3) * (p[0] + p[1] + p[2]), 0.5 * (p[0] + p[1]),
         0.5 * (p[1] + p[2]), 0.5 * (p[2] + p[0]) })
  {
    const ClosestPoint where = projector_.nearest(point, std::numeric_limits<double>::infinity());
    fit.distance = std::max(fit.distance, distance(point, where.point));
    if (where.entity.dimension == 2)
    {
      const Vector3 normal = projector_.model().normal(where.entity.index, where.parameters);
      fit.cosine = std::min(fit.cosine, std::abs(dot(fit.normals.back(), normal)));
    }
  }
}

ClosestPoint SurfaceRule::placeOfMiddle(const EditableMesh& mesh, Index a, Index b) const
{
  const Index segment = mesh.segmentOf(a, b);
  const Index edge = segment < 0 ? -1 : mesh.segments()[segment].label;
  if (segment >= 0 && edge < 0)
  {
    return {};
  }
  const EdgeClass edgeClass{ segment < 0 ? EdgeClass::Smooth : EdgeClass::OnEdge, edge };
  return projector_.projectMidpoint({ edgeClass, { mesh.vertex(a).wanted, mesh.vertex(b).wanted },
    { mesh.vertex(a).entity, mesh.vertex(b).entity } });
}

} // namespace cadrefine
