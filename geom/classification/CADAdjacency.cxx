#include <cadrefine/classification/CADAdjacency.h>

#include <cadrefine/base/DisjointSets.h>
#include <cadrefine/base/SortUniquely.h>
#include <cadrefine/classification/ClassificationTolerances.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace cadrefine
{
namespace
{

/// Directions in which the accepted edges leave a vertex; both for a closed edge.
template<class Accept>
std::vector<Vector3> directionsAt(
  const CADModel& model, std::int32_t vertex, const Accept& isAccepted)
{
  std::vector<Vector3> directions;
  for (const std::int32_t e : model.nurbs().vertices[vertex].edges)
  {
    const NurbsEdge& edge = model.nurbs().edges[e];
    if (edge.segments.empty() || !isAccepted(edge))
    {
      continue;
    }
    directions.push_back(tangentAwayFrom(model, e, vertex));
    if (edge.firstVertex == edge.lastVertex)
    {
      directions.push_back(-1.0 * model.tangent(e, edge.segments.back().t1));
    }
  }
  return directions;
}

bool areOpposite(const std::vector<Vector3>& directions)
{
  return directions.size() == 2 &&
         dot(directions[0], directions[1]) < -ClassificationTolerances::creaseCosine();
}

/// Whether the normals of the faces at a vertex differ close to it, on all sides of it.
bool normalsDifferAround(const CADModel& model, std::int32_t vertex)
{
  const Point3& point = model.nurbs().vertices[vertex].point;
  const double offset = ClassificationTolerances::besideVertex * model.size();
  std::vector<Vector3> normals;
  for (const std::int32_t face : entitiesAround(model.nurbs(), { 0, vertex }, 2))
  {
    for (int axis = 0; axis < 6; ++axis)
    {
      Point3 beside = point;
      beside[axis / 2] += axis % 2 ? offset : -offset;
      normals.push_back(model.normalNear(face, beside));
    }
  }
  const double cosine = ClassificationTolerances::creaseCosine();
  return std::any_of(normals.begin(), normals.end(),
    [&](const Vector3& normal)
    {
      return squaredNorm(normal) > 0 && squaredNorm(normals[0]) > 0 &&
             dot(normal, normals[0]) < cosine;
    });
}

/// Whether a vertex without creases is the tip of something. Only where one edge ends or two meet
/// at an angle, as those of a cone do, are the normals looked at.
bool isApex(const CADModel& model, std::int32_t vertex)
{
  const auto directions =
    directionsAt(model, vertex, [](const NurbsEdge& edge) { return !edge.faces.empty(); });
  return !directions.empty() && directions.size() <= 2 && !areOpposite(directions) &&
         normalsDifferAround(model, vertex);
}

bool isCorner(const CADModel& model, std::int32_t vertex)
{
  const auto creases =
    directionsAt(model, vertex, [](const NurbsEdge& edge) { return edge.sharp; });
  return creases.empty() ? isApex(model, vertex) : !areOpposite(creases);
}

} // namespace

bool fitsEitherWay(const Vector3& a, const Vector3& b)
{
  return std::abs(dot(a, b)) >= ClassificationTolerances::fittingCosine;
}

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
  sortUniquely(faces);
  return faces;
}

bool isWithin(const NurbsModel& model, EntityId entity, EntityId where)
{
  if (where.dimension >= entity.dimension)
  {
    return where == entity;
  }
  if (entitiesAround(model, where, entity.dimension) != std::vector{ entity.index })
  {
    return false;
  }
  const auto edges = entitiesAround(model, where, 1);
  return entity.dimension == 1 || std::none_of(edges.begin(), edges.end(),
                                    [&](std::int32_t edge) { return model.edges[edge].sharp; });
}

std::vector<std::int32_t> commonEntities(
  const NurbsModel& model, EntityId a, EntityId b, int dimension)
{
  const auto first = entitiesAround(model, a, dimension);
  const auto second = entitiesAround(model, b, dimension);
  std::vector<std::int32_t> common;
  std::set_intersection(
    first.begin(), first.end(), second.begin(), second.end(), std::back_inserter(common));
  return common;
}

std::vector<std::int32_t> commonFaces(
  const NurbsModel& model, const std::array<EntityId, 4>& entities, int count)
{
  auto common = commonEntities(model, entities[0], entities[1], 2);
  for (int k = 2; k < count; ++k)
  {
    const auto more = entitiesAround(model, entities[k], 2);
    std::vector<std::int32_t> both;
    std::set_intersection(
      common.begin(), common.end(), more.begin(), more.end(), std::back_inserter(both));
    common = std::move(both);
  }
  return common;
}

ClosestPoint onSharedEdge(const CADModel& model, const Point3& point, const ClosestPoint& where)
{
  return where.borderEdge < 0 ? where : model.nearestOn({ 1, where.borderEdge }, point);
}

double exactDistance(const CADModel& model, double shortestEdge)
{
  using T = ClassificationTolerances;
  return std::max(T::leastExact * model.size(),
    std::min(T::exact * model.size(), T::exactPartOfEdge * shortestEdge));
}

double roundedDistance(const CADModel& model, double shortestEdge)
{
  using T = ClassificationTolerances;
  return std::min(T::rounded * model.size(), T::exactPartOfEdge * shortestEdge);
}

bool fitsTangent(const CADModel& model, const ClosestPoint& where, const Vector3& direction)
{
  if (where.entity.dimension == 1)
  {
    return fitsEitherWay(model.tangent(where.entity.index, where.parameters[0]), direction);
  }
  const auto edges = entitiesAround(model.nurbs(), where.entity, 1);
  return std::any_of(edges.begin(), edges.end(),
    [&](std::int32_t edge)
    { return fitsEitherWay(tangentAwayFrom(model, edge, where.entity.index), direction); });
}

std::vector<std::int32_t> edgesBetween(const NurbsModel& model, std::int32_t a, std::int32_t b)
{
  std::vector<std::int32_t> edges;
  const auto& candidates = model.faces[a].edges;
  std::copy_if(candidates.begin(), candidates.end(), std::back_inserter(edges),
    [&](std::int32_t edge)
    {
      const auto& faces = model.edges[edge].faces;
      return a == b ? faces.size() == 1 : std::binary_search(faces.begin(), faces.end(), b);
    });
  return edges;
}

bool isSeam(const NurbsEdge& edge)
{
  return edge.faces.size() == 1 && !edge.sharp;
}

Vector3 tangentAwayFrom(const CADModel& model, std::int32_t edge, std::int32_t vertex)
{
  const NurbsEdge& curve = model.nurbs().edges[edge];
  return curve.firstVertex == vertex ? model.tangent(edge, curve.segments.front().t0)
                                     : -1.0 * model.tangent(edge, curve.segments.back().t1);
}

std::vector<std::int32_t> findCreaseLines(
  const NurbsModel& model, const std::vector<std::int32_t>& corners)
{
  DisjointSets lines(model.edges.size());
  for (std::int32_t vertex = 0; vertex < model.count(0); ++vertex)
  {
    std::int32_t first = -1;
    for (const std::int32_t edge : model.vertices[vertex].edges)
    {
      if (model.edges[edge].sharp && !std::binary_search(corners.begin(), corners.end(), vertex))
      {
        first = first < 0 ? edge : first;
        lines.join(first, edge);
      }
    }
  }
  return lines.representatives();
}

std::vector<std::int32_t> findCorners(const CADModel& model)
{
  std::vector<std::int32_t> corners;
  for (std::int32_t vertex = 0; vertex < model.count(0); ++vertex)
  {
    if (isCorner(model, vertex))
    {
      corners.push_back(vertex);
    }
  }
  return corners;
}

} // namespace cadrefine
