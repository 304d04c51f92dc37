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
    widen(mesh, mesh.facets()[facet].corners, fit);
  }
  return fit;
}

bool SurfaceRule::isOnCAD(const EditableMesh& mesh, const std::array<Index, 3>& facet) const
{
  ClassifiedFacet onCAD{};
  for (int k = 0; k < 3; ++k)
  {
    onCAD.points[k] = mesh.vertex(facet[k]).wanted;
    onCAD.entities[k] = mesh.vertex(facet[k]).entity;
  }
  return projector_.isOnCAD(onCAD);
}

bool SurfaceRule::accepts(const EditableMesh& mesh, const Cavity& cavity) const
{
  const auto turnsLittle = [&](const LabelledSimplex<3>& facet)
  {
    const Vector3 normal = normalOf(mesh, facet.corners);
    return std::any_of(cavity.facets.begin(), cavity.facets.end(),
      [&](Index old)
      { return dot(normal, normalOf(mesh, mesh.facets()[old].corners)) >= turnCosine; });
  };
  // What costs least comes first.
  if (!std::all_of(cavity.newFacets.begin(), cavity.newFacets.end(), turnsLittle))
  {
    return false;
  }
  const Fit before = fitOf(mesh, cavity.facets);
  return std::all_of(cavity.newFacets.begin(), cavity.newFacets.end(),
    [&](const auto& facet)
    {
      if (!isOnCAD(mesh, facet.corners))
      {
        return false;
      }
      Fit fit;
      widen(mesh, facet.corners, fit);
      return fit.distance <= before.distance && fit.cosine >= std::min(turnCosine, before.cosine);
    });
}

/// Makes the fit that of another facet, too.
void SurfaceRule::widen(const EditableMesh& mesh, const std::array<Index, 3>& facet, Fit& fit) const
{
  const std::array<Point3, 3> p{ mesh.vertex(facet[0]).wanted, mesh.vertex(facet[1]).wanted,
    mesh.vertex(facet[2]).wanted };
  const Vector3 normal = normalOf(mesh, facet);
  for (const Point3& point : { (1.0 / 3) * (p[0] + p[1] + p[2]), 0.5 * (p[0] + p[1]),
         0.5 * (p[1] + p[2]), 0.5 * (p[2] + p[0]) })
  {
    const ClosestPoint where = projector_.nearest(point, std::numeric_limits<double>::infinity());
    fit.distance = std::max(fit.distance, distance(point, where.point));
    if (where.entity.dimension == 2)
    {
      const Vector3 ofCAD = projector_.model().normal(where.entity.index, where.parameters);
      fit.cosine = std::min(fit.cosine, std::abs(dot(normal, ofCAD)));
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
  const BoundaryEdge onCAD{ edgeClass, { mesh.vertex(a).wanted, mesh.vertex(b).wanted },
    { mesh.vertex(a).entity, mesh.vertex(b).entity } };
  return projector_.offCrease(onCAD, projector_.projectMidpoint(onCAD));
}

} // namespace cadrefine
