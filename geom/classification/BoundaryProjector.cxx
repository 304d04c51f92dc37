#include <cadrefine/classification/BoundaryProjector.h>

#include <cadrefine/classification/CADAdjacency.h>
#include <cadrefine/classification/ClassificationTolerances.h>
#include <cadrefine/mesh/Quality.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace cadrefine
{
namespace
{

/// How far inside its face a place is looked for, to the middle's distance from the border.
constexpr std::array partsInside{ 1.0, 1.0 / 2, 1.0 / 4, 1.0 / 8 };
/// A place on a face is taken instead of one on its border that is so many times nearer.
constexpr double asNear = 1.25;
/// Of a mesh edge's length: a place so near to one of its ends is not that of its middle.
constexpr double atEnd = 0.1;

/// A mesh edge may lead across a nose if the CAD is so high over its middle, in parts of its
/// length.
constexpr double noseHeight = 0.05;
/// Of the sum of the normals at its ends: those of both sides of a plate tell no direction.
constexpr double leastNoseSum = 0.1;
/// Where the front of a nose, or the bottom of a groove, is looked for, in the same parts.
constexpr std::array noseParts{ 0.5, 1.0, 2.0, -0.5, -1.0, -2.0 };
/// It is as far from one end as from the other, but for this part of the length.
constexpr double noseBalance = 0.5;
/// Its normal is within 45 degrees of the direction between those at the ends.
const double noseCosine = ClassificationTolerances::cosineOfDegrees(45);

/// The nearer of two answers; on a tie the smaller entity.
bool isBetter(const ClosestPoint& a, const ClosestPoint& b)
{
  return a.distance != b.distance ? a.distance < b.distance : a.entity < b.entity;
}

/// Unit vectors square to one, 45 degrees apart.
std::array<Vector3, 8> directionsAcross(const Vector3& vector)
{
  const auto smallest = std::min_element(
    vector.begin(), vector.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  Vector3 axis{};
  axis[smallest - vector.begin()] = 1;
  const Vector3 first = normalized(cross(vector, axis));
  const Vector3 second = normalized(cross(vector, first));
  const Vector3 sum = normalized(first + second);
  const Vector3 difference = normalized(first - second);
  return { first, sum, second, -1.0 * difference, -1.0 * first, -1.0 * sum, -1.0 * second,
    difference };
}

bool isOnFace(const EdgeClass& edgeClass)
{
  return edgeClass.kind == EdgeClass::Smooth && edgeClass.entity >= 0;
}

/// That of the facet, but for quadrilaterals, which need not be flat.
Vector3 normalAtCorner(const ClassifiedFacet& facet, int k, const Vector3& ofFacet)
{
  const auto& p = facet.points;
  return facet.corners == 4 ? normalized(twofoldAreaVector(p[(k + 3) % 4], p[k], p[(k + 1) % 4]))
                            : ofFacet;
}

} // namespace

BoundaryProjector::BoundaryProjector(const CADModel& model, BoundaryKind kind)
  : model_(model), kind_(kind), faces_(model, FaceSides(model.count(2), 0)), edges_(model),
    corners_(findCorners(model)), lines_(findCreaseLines(model.nurbs(), corners_))
{
}

ClosestPoint BoundaryProjector::nearest(const Point3& point, double limit) const
{
  SearchScope scope;
  scope.maximumDistance = limit;
  scope.faces = kind_ == BoundaryKind::Triangles;
  return onSharedEdge(model_, point, model_.nearest(point, scope));
}

ClosestPoint BoundaryProjector::onSmallest(
  const Point3& point, double exact, const ClosestPoint& nearest) const
{
  if (!nearest.entity || nearest.distance > exact)
  {
    return nearest;
  }
  SearchScope scope;
  scope.maximumDistance = exact;
  scope.faces = false;
  scope.edges = scope.sharpEdges = false;
  const ClosestPoint vertex = model_.nearest(point, scope);
  if (vertex.entity)
  {
    return vertex;
  }
  scope.edges = scope.sharpEdges = true;
  const ClosestPoint edge = model_.nearest(point, scope);
  return edge.entity ? edge : nearest;
}

ClosestPoint BoundaryProjector::nearestOn(EntityId entity, const Point3& point) const
{
  return onSharedEdge(model_, point, model_.nearestOn(entity, point));
}

bool BoundaryProjector::fitsNormal(
  EntityId entity, const ClosestPoint& where, const Vector3& normal) const
{
  if (entity.dimension == 2 && where.entity == entity)
  {
    return fitsEitherWay(model_.normal(entity.index, where.parameters), normal);
  }
  const auto faces = entitiesAround(model_.nurbs(), entity, 2);
  return std::any_of(faces.begin(), faces.end(),
    [&](std::int32_t face) { return fitsEitherWay(model_.normalNear(face, where.point), normal); });
}

bool BoundaryProjector::isOnCAD(const ClassifiedFacet& facet) const
{
  const auto& p = facet.points;
  const double unlimited = std::numeric_limits<double>::infinity();
  if (kind_ == BoundaryKind::Segments)
  {
    const ClosestPoint where = nearest(0.5 * (p[0] + p[1]), unlimited);
    return fitsTangent(model_, where, normalized(p[1] - p[0]));
  }
  const Vector3 normal = normalized(twofoldAreaVector(p, facet.corners));
  for (int k = 0; k < facet.corners; ++k)
  {
    if (facet.entities[k].dimension == 2 &&
        fitsEitherWay(
          model_.normalNear(facet.entities[k].index, p[k]), normalAtCorner(facet, k, normal)))
    {
      return true;
    }
  }
  const Point3 centroid = centroidOf(p, facet.corners);
  // Between the edges of a narrow face, other faces may be nearer to the centroid than it is.
  const auto common = commonFaces(model_.nurbs(), facet.entities, facet.corners);
  if (std::any_of(common.begin(), common.end(),
        [&](std::int32_t face)
        { return fitsEitherWay(model_.normalNear(face, centroid), normal); }))
  {
    return true;
  }
  const ClosestPoint where = nearest(centroid, unlimited);
  return fitsNormal(where.entity, where, normal);
}

std::int32_t BoundaryProjector::faceOf(const ClassifiedFacet& facet) const
{
  const auto faces = commonFaces(model_.nurbs(), facet.entities, facet.corners);
  return faces.size() == 1 ? faces[0] : faces_.nearestOf(faces, facet.points, facet.corners);
}

std::int32_t BoundaryProjector::earOf(const ClassifiedFacet& facet) const
{
  const auto isOnEdge = [](EntityId entity) { return entity && entity.dimension <= 1; };
  const auto& [a, b, c, none] = facet.entities;
  if (facet.corners != 3 || !isOnEdge(a) || !isOnEdge(b) || !isOnEdge(c))
  {
    return -1;
  }
  const auto ofTwo = commonEntities(model_.nurbs(), a, b, 1);
  const auto ofThird = entitiesAround(model_.nurbs(), c, 1);
  const auto found = std::find_if(ofTwo.begin(), ofTwo.end(),
    [&](std::int32_t edge)
    {
      return model_.nurbs().edges[edge].faces.size() == 2 &&
             std::binary_search(ofThird.begin(), ofThird.end(), edge);
    });
  return found == ofTwo.end() ? -1 : *found;
}

/// Of an ear the long side, beyond which the same face goes on, is not on the CAD edge: that runs
/// along the two others.
std::int32_t BoundaryProjector::commonCrease(const std::array<Point3, 2>& points,
  const std::array<EntityId, 2>& entities, const std::vector<FacetRecord>& onCAD) const
{
  const auto isLongSide = [&](std::int32_t edge)
  {
    return onCAD.size() == 2 && onCAD[0].face >= 0 && onCAD[0].face == onCAD[1].face &&
           (onCAD[0].ear == edge || onCAD[1].ear == edge);
  };
  const bool areTwoFaces =
    onCAD.size() == 2 && onCAD[0].face >= 0 && onCAD[1].face >= 0 && onCAD[0].face != onCAD[1].face;
  const auto between = areTwoFaces ? edgesBetween(model_.nurbs(), onCAD[0].face, onCAD[1].face)
                                   : std::vector<std::int32_t>{};
  // However far that bows.
  const auto isBetween = [&](std::int32_t edge)
  { return std::binary_search(between.begin(), between.end(), edge); };
  const Point3 middle = 0.5 * (points[0] + points[1]);
  const double limit = ClassificationTolerances::creaseDistance * distance(points[0], points[1]);
  std::int32_t best = -1;
  double bestDistance = std::numeric_limits<double>::infinity();
  for (const std::int32_t edge : commonEntities(model_.nurbs(), entities[0], entities[1], 1))
  {
    const double away = nearestOn({ 1, edge }, middle).distance;
    if (model_.nurbs().edges[edge].sharp && away < bestDistance && !isLongSide(edge) &&
        (away < limit || isBetween(edge)))
    {
      best = edge;
      bestDistance = away;
    }
  }
  return best;
}

/// A smooth edge that both ends lie on, between the faces of the facets on the two sides.
std::int32_t BoundaryProjector::commonSmoothEdge(const std::array<Point3, 2>& points,
  const std::array<EntityId, 2>& entities, const std::vector<FacetRecord>& onCAD) const
{
  if (onCAD.size() != 2 || onCAD[0].face < 0 || onCAD[1].face < 0)
  {
    return -1;
  }
  const NurbsModel& nurbs = model_.nurbs();
  const auto between = edgesBetween(nurbs, onCAD[0].face, onCAD[1].face);
  for (const std::int32_t edge : commonEntities(nurbs, entities[0], entities[1], 1))
  {
    if (!nurbs.edges[edge].sharp && std::binary_search(between.begin(), between.end(), edge) &&
        edges_.follows(edge, points))
    {
      return edge;
    }
  }
  return -1;
}

bool BoundaryProjector::isOnLineOf(std::int32_t crease, EntityId entity) const
{
  const auto edges = entitiesAround(model_.nurbs(), entity, 1);
  return std::any_of(
    edges.begin(), edges.end(), [&](std::int32_t edge) { return lines_[edge] == lines_[crease]; });
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
  const bool isInFace = onCAD.size() == 2 && onCAD[0].face == onCAD[1].face;
  const EdgeClass onFace{ EdgeClass::Smooth, isInFace ? onCAD[0].face : -1 };
  if (kind_ == BoundaryKind::Segments || !endsOnEdges)
  {
    return onFace;
  }
  const auto pairs = meshEdges(points, onCAD);
  const bool angle = std::any_of(pairs.begin(), pairs.end(), hasAngle);
  const std::int32_t common = angle ? commonCrease(points, entities, onCAD) : -1;
  const std::int32_t crease = common >= 0 ? common : edges_.findCrease(pairs).edge;
  if (crease >= 0 && isOnLineOf(crease, entities[0]) && isOnLineOf(crease, entities[1]))
  {
    return { EdgeClass::OnEdge, crease };
  }
  const std::int32_t smooth = commonSmoothEdge(points, entities, onCAD);
  return smooth >= 0 ? EdgeClass{ EdgeClass::OnEdge, smooth } : onFace;
}

ClosestPoint BoundaryProjector::projectOnEdge(std::int32_t edge, const Point3& point) const
{
  if (edge >= 0)
  {
    const ClosestPoint where = nearestOn({ 1, edge }, point);
    if (where.entity.dimension == 1 || !model_.nurbs().edges[edge].sharp)
    {
      return where;
    }
  }
  return edges_.nearestCrease(point, std::numeric_limits<double>::infinity());
}

std::vector<std::int32_t> BoundaryProjector::entitiesOf(
  const EdgeClass& edgeClass, const std::array<EntityId, 2>& entities) const
{
  const std::int8_t dimension = kind_ == BoundaryKind::Triangles ? 2 : 1;
  return isOnFace(edgeClass) ? std::vector<std::int32_t>{ edgeClass.entity }
                             : commonEntities(model_.nurbs(), entities[0], entities[1], dimension);
}

/// On an entity that both ends share: it cannot jump to the other side of something thin.
ClosestPoint BoundaryProjector::nearestOnShared(
  const EdgeClass& edgeClass, const std::array<EntityId, 2>& entities, const Point3& point) const
{
  const std::int8_t dimension = kind_ == BoundaryKind::Triangles ? 2 : 1;
  ClosestPoint best;
  for (const std::int32_t entity : entitiesOf(edgeClass, entities))
  {
    const ClosestPoint where = nearestOn({ dimension, entity }, point);
    if (isWithin(model_.nurbs(), { dimension, entity }, where.entity) && isBetter(where, best))
    {
      best = where;
    }
  }
  return best;
}

/// Beyond a smooth border of a face the surface goes on; so does a line beyond the end of an edge,
/// unless both ends of the mesh edge are on that.
bool BoundaryProjector::hasLeft(
  EntityId entity, const BoundaryEdge& edge, const ClosestPoint& where) const
{
  if (isWithin(model_.nurbs(), entity, where.entity))
  {
    return false;
  }
  if (entity.dimension == 1)
  {
    const auto common = commonEntities(model_.nurbs(), edge.entities[0], edge.entities[1], 1);
    return std::binary_search(common.begin(), common.end(), entity.index);
  }
  if (where.entity.dimension < 2)
  {
    return true;
  }
  const ClosestPoint border = nearestOn(entity, 0.5 * (edge.points[0] + edge.points[1]));
  return border.entity.dimension != 1 || model_.nurbs().edges[border.entity.index].sharp;
}

ClosestPoint BoundaryProjector::projectMidpoint(const BoundaryEdge& edge) const
{
  const auto& [a, b] = edge.points;
  const EdgeClass& edgeClass = edge.edgeClass;
  const ClosestPoint where = project(edgeClass, 0.5 * (a + b), edge.entities);
  if (!where.entity)
  {
    return where;
  }
  const ClosestPoint nose = onNose(edge, where);
  if (nose.entity)
  {
    return nose;
  }
  const bool isAtEnd =
    std::min(distance(where.point, a), distance(where.point, b)) <= atEnd * distance(a, b);
  const bool isOnEdge = edgeClass.kind == EdgeClass::OnEdge && edgeClass.entity >= 0;
  const EntityId entity{ static_cast<std::int8_t>(isOnEdge ? 1 : 2), edgeClass.entity };
  if (!isAtEnd && (edgeClass.entity < 0 || !hasLeft(entity, edge, where)))
  {
    return where;
  }
  const ClosestPoint between =
    isOnEdge ? betweenOnEdge(edge) : betweenOnFaces(edge, where.distance);
  const double limit = isOnEdge ? distance(a, b) : asNear * where.distance;
  return between.entity && (isAtEnd || between.distance <= limit) ? between : where;
}

/// Of the place of a point on a CAD edge its parameter; at an end of the edge that of the end, and
/// of a closed edge both.
std::vector<double> BoundaryProjector::parametersOn(std::int32_t edge, const Point3& point) const
{
  const NurbsEdge& curve = model_.nurbs().edges[edge];
  const ClosestPoint where = nearestOn({ 1, edge }, point);
  if (where.entity.dimension == 1)
  {
    return { where.parameters[0] };
  }
  std::vector<double> ends;
  if (where.entity == EntityId{ 0, curve.firstVertex })
  {
    ends.push_back(curve.segments.front().t0);
  }
  if (where.entity == EntityId{ 0, curve.lastVertex })
  {
    ends.push_back(curve.segments.back().t1);
  }
  return ends;
}

/// The point of the CAD edge between those nearest to the ends that is as far from one end as from
/// the other, by bisection.
ClosestPoint BoundaryProjector::betweenOnEdge(const BoundaryEdge& edge) const
{
  const auto& [a, b] = edge.points;
  const EntityId onEdge{ 1, edge.edgeClass.entity };
  std::array<double, 2> range{ 0, std::numeric_limits<double>::infinity() };
  for (const double ofA : parametersOn(onEdge.index, a))
  {
    for (const double ofB : parametersOn(onEdge.index, b))
    {
      if (std::abs(ofB - ofA) < std::abs(range[1] - range[0]))
      {
        range = { ofA, ofB };
      }
    }
  }
  ClosestPoint where;
  if (range[1] == std::numeric_limits<double>::infinity())
  {
    return where;
  }
  const bool isAFirst = range[0] < range[1];
  const Point3& first = isAFirst ? a : b;
  const Point3& last = isAFirst ? b : a;
  double low = isAFirst ? range[0] : range[1];
  double high = isAFirst ? range[1] : range[0];
  for (int k = 0; k < std::numeric_limits<double>::digits; ++k)
  {
    const double t = 0.5 * (low + high);
    const Point3 point = model_.evaluate(onEdge, { t, 0 });
    (distance(point, first) < distance(point, last) ? low : high) = t;
  }
  where.entity = onEdge;
  where.parameters = { 0.5 * (low + high), 0 };
  where.point = model_.evaluate(onEdge, where.parameters);
  where.distance = distance(where.point, 0.5 * (a + b));
  return where;
}

/// Of the places on faces of eight points round the middle, so far away from it, the one that is
/// nearest to the middle and as far from one end as from the other: these two added.
ClosestPoint BoundaryProjector::betweenOnFaces(const BoundaryEdge& edge, double away) const
{
  const Point3& a = std::min(edge.points[0], edge.points[1]);
  const Point3& b = std::max(edge.points[0], edge.points[1]);
  const Point3 middle = 0.5 * (a + b);
  const bool haveFace = !entitiesOf(edge.edgeClass, edge.entities).empty();
  double least = std::numeric_limits<double>::infinity();
  ClosestPoint best;
  for (const Vector3& direction : directionsAcross(b - a))
  {
    const Point3 beside = middle + away * direction;
    ClosestPoint where =
      haveFace ? nearestOnShared(edge.edgeClass, edge.entities, beside) : nearest(beside, 4 * away);
    where.distance = distance(where.point, middle);
    const double off =
      where.distance + std::abs(distance(where.point, a) - distance(where.point, b));
    if (where.entity.dimension == 2 && off < least)
    {
      best = where;
      least = off;
    }
  }
  return best;
}

ClosestPoint BoundaryProjector::onNose(const BoundaryEdge& edge, const ClosestPoint& where) const
{
  const auto& [a, b] = edge.points;
  const double length = distance(a, b);
  if (kind_ != BoundaryKind::Triangles || edge.edgeClass.kind != EdgeClass::Smooth ||
      where.entity.dimension != 2 || where.distance <= noseHeight * length)
  {
    return {};
  }
  const auto common = entitiesOf(edge.edgeClass, edge.entities);
  const auto normalAt = [&](int end)
  {
    const EntityId entity = edge.entities[end];
    const std::int32_t face = common.size() == 1      ? common[0]
                              : entity.dimension == 2 ? entity.index
                                                      : -1;
    return face >= 0 ? model_.normalNear(face, edge.points[end]) : Vector3{};
  };
  const Vector3 first = normalAt(0);
  const Vector3 second = normalAt(1);
  const Vector3 sum = first + second;
  if (dot(first, second) >= 0 || norm(sum) < leastNoseSum)
  {
    return {};
  }
  const Vector3 between = normalized(sum);
  const auto fits = [&](const ClosestPoint& place)
  {
    return place.entity.dimension == 2 &&
           dot(model_.normal(place.entity.index, place.parameters), between) >= noseCosine;
  };
  ClosestPoint best;
  if (fits(where))
  {
    return best;
  }
  const Point3 middle = 0.5 * (a + b);
  for (const double part : noseParts)
  {
    const Point3 point = middle + part * length * between;
    const ClosestPoint shared = nearestOnShared(edge.edgeClass, edge.entities, point);
    ClosestPoint place = shared.entity ? shared : nearest(point, 2 * length);
    place.distance = distance(place.point, middle);
    const double off = std::abs(distance(place.point, a) - distance(place.point, b));
    if (fits(place) && place.distance <= 2 * length && off <= noseBalance * length &&
        isBetter(place, best))
    {
      best = place;
    }
  }
  return best;
}

ClosestPoint BoundaryProjector::offCrease(const BoundaryEdge& edge, const ClosestPoint& where) const
{
  if (kind_ != BoundaryKind::Triangles || edge.edgeClass.kind != EdgeClass::Smooth)
  {
    return where;
  }
  const auto faces = entitiesOf(edge.edgeClass, edge.entities);
  if (where.entity.dimension == 2 &&
      (faces.empty() || std::binary_search(faces.begin(), faces.end(), where.entity.index)))
  {
    return where;
  }
  const Point3 middle = 0.5 * (edge.points[0] + edge.points[1]);
  ClosestPoint border = where; // that of the face where it is nearest, not of another one behind it
  for (std::size_t f = 0; f < faces.size(); ++f)
  {
    const ClosestPoint onFace = nearestOn({ 2, faces[f] }, middle);
    border = f == 0 || isBetter(onFace, border) ? onFace : border;
  }
  if (border.entity.dimension != 1)
  {
    return border;
  }
  if (!model_.nurbs().edges[border.entity.index].sharp)
  {
    // Beyond a smooth edge the surface goes on.
    const auto beside = entitiesAround(model_.nurbs(), border.entity, 2);
    const bool isBeside = where.entity.dimension == 2 &&
                          std::binary_search(beside.begin(), beside.end(), where.entity.index);
    return isBeside ? where : border;
  }
  // As far inside as the middle is outside; where the face is narrower than that, less.
  for (const double part : partsInside)
  {
    ClosestPoint inside =
      nearestOnShared(edge.edgeClass, edge.entities, border.point + part * (border.point - middle));
    if (inside.entity)
    {
      inside.distance = distance(middle, inside.point);
      return inside;
    }
  }
  return border;
}

ClosestPoint BoundaryProjector::project(
  const EdgeClass& edgeClass, const Point3& point, const std::array<EntityId, 2>& entities) const
{
  switch (edgeClass.kind)
  {
    case EdgeClass::OnEdge:
      return projectOnEdge(edgeClass.entity, point);
    case EdgeClass::Smooth:
    {
      const ClosestPoint shared = nearestOnShared(edgeClass, entities, point);
      return shared.entity ? shared : nearest(point, std::numeric_limits<double>::infinity());
    }
    default:
      return {};
  }
}

bool BoundaryProjector::isCorner(std::int32_t vertex) const
{
  return std::binary_search(corners_.begin(), corners_.end(), vertex);
}

} // namespace cadrefine
