#include "BoundaryProjector.h"

#include "Quality.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cadrefine
{
namespace
{

/// Normals and tangents fit where the angle between them is at most 60 degrees, either way round:
/// extremely coarse facets lie far off the tangent plane.
constexpr double fittingCosine = 0.5;
/// A mesh edge with a dihedral angle above 10 degrees may lie on a crease (of 15 or more).
const double flatCosine = std::cos(10.0 / 180.0 * 3.14159265358979323846);

bool fits(const Vector3& a, const Vector3& b)
{
  return std::abs(dot(a, b)) >= fittingCosine;
}

/// The facets on the CAD beside an edge, or none where a facet beside it was left out by the user.
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

/// Whether the edge between these facets may lie on a crease: a rim, or a dihedral angle.
bool mayBeCrease(const std::vector<FacetRecord>& onCAD)
{
  return onCAD.size() == 1 || onCAD.size() > 2 ||
         (onCAD.size() == 2 && dot(onCAD[0].normal, onCAD[1].normal) < flatCosine);
}

/// Entities of `dimension` (1 or 2) whose closure holds `entity`.
std::vector<std::int32_t> entitiesAround(const NurbsModel& model, EntityId entity, int dimension)
{
  if (entity.dimension == dimension)
  {
    return { entity.index };
  }
  if (entity.dimension > dimension || !entity)
  {
    return {};
  }
  if (entity.dimension == 1)
  {
    return model.edges[entity.index].faces;
  }
  const auto& edges = model.vertices[entity.index].edges;
  if (dimension == 1)
  {
    return edges;
  }
  std::vector<std::int32_t> faces;
  for (const std::int32_t edge : edges)
  {
    faces.insert(faces.end(), model.edges[edge].faces.begin(), model.edges[edge].faces.end());
  }
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return faces;
}

/// The nearer of two answers; on a tie the smaller entity.
bool isBetter(const ClosestPoint& a, const ClosestPoint& b)
{
  return a.distance != b.distance ? a.distance < b.distance : a.entity < b.entity;
}

/// Unit tangent of `edge` at its end `vertex`, pointing away from it.
Vector3 tangentAwayFrom(const CADModel& model, std::int32_t edge, std::int32_t vertex)
{
  const NurbsEdge& curve = model.nurbs().edges[edge];
  return curve.firstVertex == vertex ? model.tangent(edge, curve.segments.front().t0)
                                     : -1.0 * model.tangent(edge, curve.segments.back().t1);
}

} // namespace

BoundaryProjector::BoundaryProjector(const CADModel& model, BoundaryKind kind)
  : model_(model), kind_(kind)
{
  findCorners();
}

ClosestPoint BoundaryProjector::nearest(const Point3& point, double limit) const
{
  SearchScope scope;
  scope.maximumDistance = limit;
  scope.faces = kind_ == BoundaryKind::Triangles;
  return model_.nearest(point, scope);
}

ClosestPoint BoundaryProjector::nearestCrease(const Point3& point, double limit) const
{
  SearchScope scope;
  scope.maximumDistance = limit;
  scope.faces = false;
  scope.edges = false;
  scope.sharpEdges = true;
  scope.vertices = false;
  return model_.nearest(point, scope);
}

ClosestPoint BoundaryProjector::nearestOn(EntityId entity, const Point3& point) const
{
  return model_.nearestOn(entity, point);
}

bool BoundaryProjector::fitsNormal(
  EntityId entity, const ClosestPoint& where, const Vector3& normal) const
{
  if (entity.dimension == 2 && where.entity == entity)
  {
    return fits(model_.normal(entity.index, where.parameters), normal);
  }
  const auto faces = entitiesAround(model_.nurbs(), entity, 2);
  return std::any_of(faces.begin(), faces.end(),
    [&](std::int32_t face) { return fits(model_.normalNear(face, where.point), normal); });
}

bool BoundaryProjector::fitsTangent(const ClosestPoint& where, const Vector3& direction) const
{
  if (where.entity.dimension == 1)
  {
    return fits(model_.tangent(where.entity.index, where.parameters[0]), direction);
  }
  const auto edges = entitiesAround(model_.nurbs(), where.entity, 1);
  return std::any_of(edges.begin(), edges.end(),
    [&](std::int32_t edge)
    { return fits(tangentAwayFrom(model_, edge, where.entity.index), direction); });
}

bool BoundaryProjector::isOnCAD(const ClassifiedFacet& facet) const
{
  const auto& p = facet.points;
  const double unlimited = std::numeric_limits<double>::infinity();
  if (kind_ == BoundaryKind::Segments)
  {
    const ClosestPoint where = nearest(0.5 * (p[0] + p[1]), unlimited);
    return fitsTangent(where, normalized(p[1] - p[0]));
  }
  const Vector3 normal = normalized(twofoldAreaVector(p[0], p[1], p[2]));
  for (int k = 0; k < 3; ++k)
  {
    if (facet.entities[k].dimension == 2 &&
        fits(model_.normalNear(facet.entities[k].index, p[k]), normal))
    {
      return true;
    }
  }
  const Point3 centroid = (1.0 / 3.0) * (p[0] + p[1] + p[2]);
  const auto ofThird = entitiesAround(model_.nurbs(), facet.entities[2], 2);
  for (const std::int32_t face : commonEntities(facet.entities[0], facet.entities[1], 2))
  {
    // Between the edges of a narrow face, other faces may be nearer to the centroid than it is.
    if (std::binary_search(ofThird.begin(), ofThird.end(), face) &&
        fits(model_.normalNear(face, centroid), normal))
    {
      return true;
    }
  }
  const ClosestPoint where = nearest(centroid, unlimited);
  return fitsNormal(where.entity, where, normal);
}

bool BoundaryProjector::creaseFits(
  const ClosestPoint& where, const Vector3& direction, const std::vector<FacetRecord>& facets) const
{
  if (!fitsTangent(where, direction))
  {
    return false;
  }
  const auto faces = entitiesAround(model_.nurbs(), where.entity, 2);
  std::vector<Vector3> normals(faces.size());
  std::transform(faces.begin(), faces.end(), normals.begin(),
    [&](std::int32_t face) { return model_.normalNear(face, where.point); });
  if (facets.size() == 1)
  {
    return std::any_of(normals.begin(), normals.end(),
      [&](const Vector3& normal) { return fits(normal, facets[0].normal); });
  }
  for (const Vector3& first : normals)
  {
    for (const Vector3& second : normals)
    {
      const double cosine = dot(first, facets[0].normal);
      const double other = dot(second, facets[1].normal);
      if (std::min(std::abs(cosine), std::abs(other)) >= fittingCosine && cosine * other > 0 &&
          dot(first, second) < flatCosine)
      {
        return true;
      }
    }
  }
  return false;
}

bool BoundaryProjector::runsAlongCrease(
  const Point3& a, const Point3& b, const std::vector<FacetRecord>& facets) const
{
  if (kind_ == BoundaryKind::Segments)
  {
    return !facetsOnCAD(facets).empty();
  }
  const auto onCAD = facetsOnCAD(facets);
  if (!mayBeCrease(onCAD))
  {
    return false;
  }
  const double length = distance(a, b);
  double reach = length;
  for (const FacetRecord& facet : onCAD)
  {
    reach = std::min(reach, 2 * facet.area / length); // its height over the edge
  }
  const ClosestPoint where = nearestCrease(0.5 * (a + b), 0.5 * reach);
  return where.entity && creaseFits(where, normalized(b - a), onCAD);
}

std::vector<std::int32_t> BoundaryProjector::commonEntities(
  EntityId a, EntityId b, int dimension) const
{
  const auto first = entitiesAround(model_.nurbs(), a, dimension);
  const auto second = entitiesAround(model_.nurbs(), b, dimension);
  std::vector<std::int32_t> common;
  std::set_intersection(
    first.begin(), first.end(), second.begin(), second.end(), std::back_inserter(common));
  return common;
}

std::int32_t BoundaryProjector::commonCrease(
  const std::array<Point3, 2>& points, const std::array<EntityId, 2>& entities) const
{
  const Point3 middle = 0.5 * (points[0] + points[1]);
  std::int32_t best = -1;
  double bestDistance = 0.5 * distance(points[0], points[1]);
  for (const std::int32_t edge : commonEntities(entities[0], entities[1], 1))
  {
    const double away = nearestOn({ 1, edge }, middle).distance;
    if (model_.nurbs().edges[edge].sharp && away < bestDistance)
    {
      best = edge;
      bestDistance = away;
    }
  }
  return best;
}

EdgeClass BoundaryProjector::classify(const std::array<Point3, 2>& points,
  const std::array<EntityId, 2>& entities, const std::vector<FacetRecord>& facets) const
{
  const auto onCAD = facetsOnCAD(facets);
  if (!entities[0] || !entities[1] || onCAD.empty())
  {
    return {};
  }
  const bool endsOnEdges = entities[0].dimension <= 1 && entities[1].dimension <= 1;
  if (kind_ == BoundaryKind::Segments || !endsOnEdges || !mayBeCrease(onCAD))
  {
    return { EdgeClass::Smooth, -1 };
  }
  const std::int32_t crease = commonCrease(points, entities);
  if (crease >= 0 || runsAlongCrease(points[0], points[1], facets))
  {
    return { EdgeClass::Crease, crease };
  }
  return { EdgeClass::Smooth, -1 };
}

ClosestPoint BoundaryProjector::projectOnCrease(std::int32_t edge, const Point3& point) const
{
  if (edge >= 0)
  {
    const ClosestPoint where = nearestOn({ 1, edge }, point);
    if (where.entity.dimension == 1)
    {
      return where;
    }
  }
  return nearestCrease(point, std::numeric_limits<double>::infinity());
}

ClosestPoint BoundaryProjector::projectSmoothly(
  const std::array<EntityId, 2>& entities, const Point3& point) const
{
  // On an entity that both ends share: it cannot jump to the other side of something thin.
  const std::int8_t dimension = kind_ == BoundaryKind::Triangles ? 2 : 1;
  ClosestPoint best;
  for (const std::int32_t entity : commonEntities(entities[0], entities[1], dimension))
  {
    const ClosestPoint where = nearestOn({ dimension, entity }, point);
    if (where.entity.dimension == dimension && isBetter(where, best))
    {
      best = where;
    }
  }
  return best.entity ? best : nearest(point, std::numeric_limits<double>::infinity());
}

ClosestPoint BoundaryProjector::projectMidpoint(const EdgeClass& edgeClass,
  const std::array<Point3, 2>& points, const std::array<EntityId, 2>& entities) const
{
  const Point3 middle = 0.5 * (points[0] + points[1]);
  switch (edgeClass.kind)
  {
    case EdgeClass::Crease:
      return projectOnCrease(edgeClass.edge, middle);
    case EdgeClass::Smooth:
      return projectSmoothly(entities, middle);
    default:
      return {};
  }
}

bool BoundaryProjector::isCorner(std::int32_t vertex) const
{
  return std::binary_search(corners_.begin(), corners_.end(), vertex);
}

void BoundaryProjector::findCorners()
{
  const NurbsModel& nurbs = model_.nurbs();
  for (std::int32_t v = 0; v < nurbs.count(0); ++v)
  {
    std::vector<Vector3> directions;
    for (const std::int32_t e : nurbs.vertices[v].edges)
    {
      const NurbsEdge& edge = nurbs.edges[e];
      if (!edge.sharp || edge.segments.empty())
      {
        continue;
      }
      directions.push_back(tangentAwayFrom(model_, e, v));
      if (edge.firstVertex == edge.lastVertex)
      {
        directions.push_back(-1.0 * model_.tangent(e, edge.segments.back().t1));
      }
    }
    const bool straight = directions.size() == 2 &&
                          dot(directions[0], directions[1]) < -std::cos(NurbsModel::creaseAngle);
    if (!directions.empty() && !straight)
    {
      corners_.push_back(v);
    }
  }
}

} // namespace cadrefine
