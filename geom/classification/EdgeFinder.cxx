#include <cadrefine/classification/EdgeFinder.h>

#include <cadrefine/classification/CADAdjacency.h>
#include <cadrefine/classification/ClassificationTolerances.h>

#include <algorithm>
#include <cmath>

namespace cadrefine
{
namespace
{

using Tolerances = ClassificationTolerances;

/// The smallest of the mesh edge's length and the heights of the facets over it.
double reachOf(const MeshEdge& edge)
{
  const double length = distance(edge.points[0], edge.points[1]);
  double reach = length;
  for (int k = 0; k < edge.facetCount; ++k)
  {
    reach = std::min(reach, 2 * edge.facets[k].area / length);
  }
  return reach;
}

Point3 middleOf(const std::array<Point3, 2>& points)
{
  return 0.5 * (points[0] + points[1]);
}

Vector3 directionOf(const std::array<Point3, 2>& points)
{
  return normalized(points[1] - points[0]);
}

} // namespace

std::vector<FacetRecord> facetsOnCAD(const std::vector<FacetRecord>& facets)
{
  std::vector<FacetRecord> result;
  for (const FacetRecord& facet : facets)
  {
    if (facet.free)
    {
      return {};
    }
    if (facet.onCAD)
    {
      result.push_back(facet);
    }
  }
  return result;
}

bool hasAngle(const MeshEdge& edge)
{
  return edge.facetCount == 1 ||
         dot(edge.facets[0].normal, edge.facets[1].normal) < Tolerances::flatCosine;
}

std::vector<MeshEdge> meshEdges(
  const std::array<Point3, 2>& points, const std::vector<FacetRecord>& onCAD)
{
  if (onCAD.size() == 1)
  {
    return { { points, { onCAD[0] }, 1 } };
  }
  std::vector<MeshEdge> edges;
  for (std::size_t first = 0; first < onCAD.size(); ++first)
  {
    for (std::size_t second = first + 1; second < onCAD.size(); ++second)
    {
      edges.push_back({ points, { onCAD[first], onCAD[second] } });
    }
  }
  return edges;
}

ClosestPoint EdgeFinder::nearestCrease(const Point3& point, double limit) const
{
  SearchScope scope;
  scope.maximumDistance = limit;
  scope.faces = false;
  scope.edges = false;
  scope.sharpEdges = true;
  scope.vertices = false;
  return model_.nearest(point, scope);
}

/// Whether two faces that make an angle at the point have the normals of the two facets, up to one
/// sign, or two if a facet is between cells; for one facet, whether a face has its normal.
bool EdgeFinder::fitsNormals(const ClosestPoint& where, const MeshEdge& edge) const
{
  const bool anySigns = edge.facets[0].isInside || edge.facets[1].isInside;
  const auto faces = entitiesAround(model_.nurbs(), where.entity, 2);
  std::vector<Vector3> normals(faces.size());
  std::transform(faces.begin(), faces.end(), normals.begin(),
    [&](std::int32_t face) { return model_.normalNear(face, where.point); });
  for (const Vector3& first : normals)
  {
    if (!fitsEitherWay(first, edge.facets[0].normal))
    {
      continue;
    }
    if (edge.facetCount == 1)
    {
      return true;
    }
    const double sign = dot(first, edge.facets[0].normal);
    if (std::any_of(normals.begin(), normals.end(),
          [&](const Vector3& second)
          {
            return fitsEitherWay(second, edge.facets[1].normal) &&
                   (anySigns || sign * dot(second, edge.facets[1].normal) > 0) &&
                   dot(first, second) < Tolerances::flatCosine;
          }))
    {
      return true;
    }
  }
  return false;
}

bool EdgeFinder::passesAsCrease(const ClosestPoint& where, const MeshEdge& edge) const
{
  return where.entity && fitsTangent(model_, where, directionOf(edge.points)) &&
         fitsNormals(where, edge) && endsAreNearCreases(edge);
}

/// Whether both ends are near to creases: otherwise an edge that leaves a crease would be taken for
/// it, and its far end be moved there.
bool EdgeFinder::endsAreNearCreases(const MeshEdge& edge) const
{
  const double limit = Tolerances::endDistance * distance(edge.points[0], edge.points[1]);
  return nearestCrease(edge.points[0], limit).entity && nearestCrease(edge.points[1], limit).entity;
}

EdgeMatch EdgeFinder::matchCrease(std::int32_t candidate, const MeshEdge& edge, double reach) const
{
  const ClosestPoint where = model_.nearestOn({ 1, candidate }, middleOf(edge.points));
  const bool passes = where.entity.dimension == 1 &&
                      where.distance <= Tolerances::creaseDistance * reach &&
                      passesAsCrease(where, edge);
  return passes ? EdgeMatch{ candidate, where.distance } : EdgeMatch{};
}

bool EdgeFinder::follows(std::int32_t edge, const std::array<Point3, 2>& points) const
{
  const ClosestPoint where = model_.nearestOn({ 1, edge }, middleOf(points));
  return where.distance <= Tolerances::followingMiddle * distance(points[0], points[1]) &&
         where.entity.dimension == 1 &&
         std::abs(dot(model_.tangent(edge, where.parameters[0]), directionOf(points))) >=
           Tolerances::followingCosine;
}

EdgeMatch EdgeFinder::matchFollowed(
  std::int32_t candidate, const MeshEdge& edge, double reach) const
{
  if (!follows(candidate, edge.points))
  {
    return {};
  }
  const double exact = exactDistance(model_, distance(edge.points[0], edge.points[1])) +
                       model_.nurbs().edges[candidate].tolerance;
  EdgeMatch match{ candidate, 0 }; // the farther end's distance
  for (int k = 0; k < 2; ++k)
  {
    const double away = model_.nearestOn({ 1, candidate }, edge.points[k]).distance;
    if (away > (edge.settled[k] ? exact : Tolerances::followingDistance * reach))
    {
      return {};
    }
    match.distance = std::max(match.distance, away);
  }
  return match;
}

EdgeMatch EdgeFinder::matchAnyCrease(const MeshEdge& edge, double reach) const
{
  const ClosestPoint where =
    nearestCrease(middleOf(edge.points), Tolerances::creaseDistance * reach);
  if (!passesAsCrease(where, edge))
  {
    return {};
  }
  if (where.entity.dimension == 1)
  {
    return { where.entity.index, where.distance };
  }
  EdgeMatch best;
  double bestCosine = 0;
  for (const std::int32_t e : entitiesAround(model_.nurbs(), where.entity, 1))
  {
    const double cosine =
      std::abs(dot(tangentAwayFrom(model_, e, where.entity.index), directionOf(edge.points)));
    if (model_.nurbs().edges[e].sharp && cosine > bestCosine)
    {
      best = { e, where.distance };
      bestCosine = cosine;
    }
  }
  return best;
}

std::vector<std::int32_t> EdgeFinder::candidates(const MeshEdge& edge) const
{
  const std::int32_t first = edge.facets[0].face;
  if (first < 0)
  {
    return {};
  }
  if (edge.facetCount == 1)
  {
    return model_.nurbs().faces[first].edges;
  }
  const std::int32_t second = edge.facets[1].face;
  return second < 0 ? std::vector<std::int32_t>{} : edgesBetween(model_.nurbs(), first, second);
}

EdgeMatch EdgeFinder::findCrease(const MeshEdge& edge) const
{
  const double reach = reachOf(edge);
  const bool angle = hasAngle(edge);
  const bool sameFace = edge.facetCount == 2 && edge.facets[0].face == edge.facets[1].face;
  EdgeMatch best;
  for (const std::int32_t candidate : candidates(edge))
  {
    if (!model_.nurbs().edges[candidate].sharp || (sameFace && !angle))
    {
      continue;
    }
    // With one face on both sides, only one normal is known: there the mesh has to follow closely.
    best = std::min(
      best, sameFace ? matchFollowed(candidate, edge, reach) : matchCrease(candidate, edge, reach));
  }
  return best.edge < 0 && angle ? matchAnyCrease(edge, reach) : best;
}

EdgeMatch EdgeFinder::findCrease(const std::vector<MeshEdge>& edges) const
{
  EdgeMatch best;
  for (const MeshEdge& edge : edges)
  {
    best = std::min(best, findCrease(edge));
  }
  return best;
}

bool EdgeFinder::unsettles(const MeshEdge& edge, std::int32_t match) const
{
  const double exact = exactDistance(model_, distance(edge.points[0], edge.points[1])) +
                       model_.nurbs().edges[match].tolerance;
  const auto isOff = [&](int k) {
    return edge.settled[k] && model_.nearestOn({ 1, match }, edge.points[k]).distance > exact;
  };
  return isOff(0) || isOff(1);
}

EdgeMatch EdgeFinder::find(const MeshEdge& edge) const
{
  const double reach = reachOf(edge);
  const std::int32_t face = edge.facets[0].face;
  const bool inside = edge.facetCount == 2 && face >= 0 && face == edge.facets[1].face;
  EdgeMatch best = inside ? EdgeMatch{} : findCrease(edge);
  const bool smoothOnly = best.edge >= 0 || edge.facetCount == 1;
  for (const std::int32_t candidate : candidates(edge))
  {
    if (!smoothOnly || !model_.nurbs().edges[candidate].sharp)
    {
      best = std::min(best, matchFollowed(candidate, edge, reach));
    }
  }
  best.unsettles = best.edge >= 0 && unsettles(edge, best.edge);
  return best;
}

} // namespace cadrefine
