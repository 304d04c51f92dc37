#include <cadrefine/classification/FaceFinder.h>

#include <cadrefine/base/SortUniquely.h>
#include <cadrefine/classification/CADAdjacency.h>
#include <cadrefine/classification/ClassificationTolerances.h>
#include <cadrefine/mesh/Quality.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace cadrefine
{
namespace
{

std::int8_t sideOf(std::int64_t alike, std::int64_t opposite, std::int8_t otherwise)
{
  const std::int64_t all = alike + opposite;
  if (all == 0)
  {
    return otherwise;
  }
  const double enough = ClassificationTolerances::sideMajority * static_cast<double>(all);
  return static_cast<double>(alike) >= enough      ? 1
         : static_cast<double>(opposite) >= enough ? -1
                                                   : otherwise;
}

} // namespace

FaceSides decideSides(
  const std::vector<std::int64_t>& alike, const std::vector<std::int64_t>& opposite)
{
  const std::int64_t zero = 0;
  const std::int8_t ofAll = sideOf(std::accumulate(alike.begin(), alike.end(), zero),
    std::accumulate(opposite.begin(), opposite.end(), zero), 0);
  FaceSides sides(alike.size());
  for (std::size_t face = 0; face < sides.size(); ++face)
  {
    sides[face] = sideOf(alike[face], opposite[face], ofAll);
  }
  return sides;
}

bool FaceFinder::fits(
  std::int32_t face, const Vector3& normalOfFace, const Vector3& normal, bool eitherWay) const
{
  return fitsEitherWay(normalOfFace, normal) &&
         (eitherWay || sides_[face] * dot(normalOfFace, normal) >= 0);
}

bool FaceFinder::fitsAt(const ClosestPoint& where, const Vector3& normal, bool eitherWay) const
{
  if (where.entity.dimension == 2)
  {
    return fits(
      where.entity.index, model_.normal(where.entity.index, where.parameters), normal, eitherWay);
  }
  const auto faces = entitiesAround(model_.nurbs(), where.entity, 2);
  return std::any_of(faces.begin(), faces.end(),
    [&](std::int32_t face)
    { return fits(face, model_.normalNear(face, where.point), normal, eitherWay); });
}

std::int32_t FaceFinder::faceByCorners(const CornerHits& facet, const Vector3& normal) const
{
  for (int k = 0; k < facet.corners; ++k)
  {
    const ClosestPoint& hit = facet.hits[k];
    if (facet.amongItsOwn[k] && hit.entity.dimension == 2 && fitsAt(hit, normal, facet.isInside))
    {
      return hit.entity.index;
    }
  }
  return -1;
}

/// The nearest of the faces whose normal fits; if several are equally near, as those at an edge
/// are, the one whose normal fits best.
std::int32_t FaceFinder::nearestFitting(const std::vector<std::int32_t>& faces,
  const Point3& centroid, const Vector3& normal, bool eitherWay) const
{
  const double tie = ClassificationTolerances::tie * model_.size();
  std::vector<double> distances(faces.size(), std::numeric_limits<double>::infinity());
  std::vector<double> cosines(faces.size(), 0);
  for (std::size_t i = 0; i < faces.size(); ++i)
  {
    const Vector3 ofFace = model_.normalNear(faces[i], centroid);
    if (fits(faces[i], ofFace, normal, eitherWay))
    {
      distances[i] = model_.nearestOn({ 2, faces[i] }, centroid).distance;
      cosines[i] = std::abs(dot(ofFace, normal));
    }
  }
  std::int32_t best = -1;
  double bestCosine = 0;
  for (std::size_t i = 0; i < faces.size(); ++i)
  {
    if (distances[i] <= *std::min_element(distances.begin(), distances.end()) + tie &&
        cosines[i] > bestCosine)
    {
      best = faces[i];
      bestCosine = cosines[i];
    }
  }
  return best;
}

FaceMatch FaceFinder::find(const CornerHits& facet) const
{
  const auto& p = facet.points;
  const Vector3 twofoldArea = twofoldAreaVector(p, facet.corners);
  const Vector3 normal = normalized(twofoldArea);
  const std::int32_t ofCorners = faceByCorners(facet, normal);
  if (ofCorners >= 0)
  {
    return { ofCorners, 1 };
  }
  const Point3 centroid = centroidOf(p, facet.corners);
  if (facet.exact)
  {
    std::array<EntityId, 4> entities;
    std::transform(facet.hits.begin(), facet.hits.end(), entities.begin(),
      [](const ClosestPoint& hit) { return hit.entity; });
    const auto common = commonFaces(model_.nurbs(), entities, facet.corners);
    const std::int32_t onSide = nearestFitting(common, centroid, normal, facet.isInside);
    // Where bodies touch whose meshes do not match, a face has facets on both sides.
    const std::int32_t ofAll =
      onSide >= 0 ? onSide : nearestFitting(common, centroid, normal, true);
    if (ofAll >= 0)
    {
      return { ofAll, 1 };
    }
  }
  SearchScope scope;
  scope.strays = false;
  const auto nearest = [&](const Point3& point)
  { return onSharedEdge(model_, point, model_.nearest(point, scope)); };
  const ClosestPoint where = nearest(centroid);
  if (where.entity.dimension == 2 && fitsAt(where, normal, facet.isInside))
  {
    return { where.entity.index, 1 };
  }
  std::vector<EntityId> nearby{ where.entity };
  if (where.entity.dimension == 2)
  {
    // A thin part: what the corners are near to, and what is seen from beside the facet.
    const Vector3 height = std::sqrt(norm(twofoldArea)) * normal;
    nearby.push_back(nearest(centroid + height).entity);
    nearby.push_back(nearest(centroid - height).entity);
    for (int k = 0; k < facet.corners; ++k)
    {
      nearby.push_back(facet.hits[k].entity);
    }
  }
  const std::int32_t face = nearestFitting(facesAround(nearby), centroid, normal, facet.isInside);
  return { face, face >= 0 && where.entity.dimension == 2 };
}

std::vector<std::int32_t> FaceFinder::facesAround(const std::vector<EntityId>& entities) const
{
  std::vector<std::int32_t> faces;
  for (const EntityId entity : entities)
  {
    const auto more = entitiesAround(model_.nurbs(), entity, 2);
    faces.insert(faces.end(), more.begin(), more.end());
  }
  sortUniquely(faces);
  return faces;
}

std::int32_t FaceFinder::nearestOf(
  const std::vector<std::int32_t>& faces, const std::array<Point3, 4>& points, int corners) const
{
  return nearestFitting(
    faces, centroidOf(points, corners), normalized(twofoldAreaVector(points, corners)), true);
}

} // namespace cadrefine
