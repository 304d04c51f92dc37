#include <cadrefine/classification/MidpointProjection.h>

#include <cadrefine/classification/CADAdjacency.h>
#include <cadrefine/classification/ClassificationTolerances.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace cadrefine
{
namespace
{

/// A place inside a face is looked for as far from its border as the middle is, then up to this
/// many times at half the distance, and as often at twice the distance.
constexpr int halvingsInside = 10;
/// A place nearer to a plane than this part of the model's size is in it.
constexpr double planeTolerance = 1e-13;
/// Limit on the steps of Newton's method, each of which doubles the digits.
constexpr int mostSteps = 20;
/// The least sine between a plane and the CAD, for the line in which they meet: of 10 degrees.
constexpr double leastSlope = 0.17;
/// A place on a face is taken instead of one on its border that is up to so many times nearer.
constexpr double asNear = 1.25;
/// Ends that are nearer to the border of a face than this part of the edge's length are on it.
constexpr double atBorder = 1e-3;
/// The CAD is so far from the middle of an edge that leads across a bore, in parts of its length.
constexpr double farAcross = 0.1;
/// There its normal and that of the mesh have at most this cosine.
constexpr double opposed = -0.3;
/// A place nearer to an end of a mesh edge than this part of its length is not that of its middle.
constexpr double atEnd = 0.1;

/// A mesh edge may lead across a nose if the CAD is so high over its middle, in parts of its
/// length.
constexpr double noseHeight = 0.05;
/// Least length of the sum of the normals at its ends: those of both sides of a plate tell no
/// direction.
constexpr double leastNoseSum = 0.1;
/// How far from the middle the front of a nose, or the bottom of a groove, is looked for, in parts
/// of the mesh edge's length.
constexpr std::array noseParts{ 0.5, 1.0, 2.0, -0.5, -1.0, -2.0 };
/// That place is as far from one end as from the other, but for this part of the length.
constexpr double noseBalance = 0.5;
/// The normal there is within 45 degrees of the direction between those at the ends.
const double noseCosine = ClassificationTolerances::cosineOfDegrees(45);

/// Unit vectors perpendicular to a vector, 45 degrees apart.
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

/// Whether a place has left the face or edge that the mesh edge is on. It has not where the surface
/// goes on beyond a smooth border of the face, or a line beyond the end of the edge, unless both
/// ends of the mesh edge are on that edge.
bool hasLeft(const BoundaryProjector& projector, EntityId entity, const BoundaryEdge& edge,
  const ClosestPoint& where)
{
  if (isWithin(projector.model().nurbs(), entity, where.entity))
  {
    return false;
  }
  if (entity.dimension == 1)
  {
    const auto common =
      commonEntities(projector.model().nurbs(), edge.entities[0], edge.entities[1], 1);
    return std::binary_search(common.begin(), common.end(), entity.index);
  }
  if (where.entity.dimension < 2)
  {
    return true;
  }
  const ClosestPoint border = projector.nearestOn(entity, 0.5 * (edge.points[0] + edge.points[1]));
  return border.entity.dimension != 1 || projector.model().nurbs().edges[border.entity.index].sharp;
}

/// The parameter of the place of a point on a CAD edge; at an end of the edge that of the end, or
/// of both ends if the edge is closed.
std::vector<double> parametersOn(
  const BoundaryProjector& projector, std::int32_t edge, const Point3& point)
{
  const NurbsEdge& curve = projector.model().nurbs().edges[edge];
  const ClosestPoint where = projector.nearestOn({ 1, edge }, point);
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
ClosestPoint betweenOnEdge(const BoundaryProjector& projector, const BoundaryEdge& edge)
{
  const auto& [a, b] = edge.points;
  const EntityId onEdge{ 1, edge.edgeClass.entity };
  std::array<double, 2> range{ 0, std::numeric_limits<double>::infinity() };
  for (const double ofA : parametersOn(projector, onEdge.index, a))
  {
    for (const double ofB : parametersOn(projector, onEdge.index, b))
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
    const Point3 point = projector.model().evaluate(onEdge, { t, 0 });
    (distance(point, first) < distance(point, last) ? low : high) = t;
  }
  where.entity = onEdge;
  where.parameters = { 0.5 * (low + high), 0 };
  where.point = projector.model().evaluate(onEdge, where.parameters);
  where.distance = distance(where.point, 0.5 * (a + b));
  return where;
}

/// Of the places on faces of eight points round the middle, at distance `away` from it, returns the
/// one with the least sum of its distance from the middle and the difference of its distances from
/// the ends.
ClosestPoint betweenOnFaces(
  const BoundaryProjector& projector, const BoundaryEdge& edge, double away)
{
  const Point3& a = std::min(edge.points[0], edge.points[1]);
  const Point3& b = std::max(edge.points[0], edge.points[1]);
  const Point3 middle = 0.5 * (a + b);
  const bool haveFace = !projector.entitiesOf(edge.edgeClass, edge.entities).empty();
  double least = std::numeric_limits<double>::infinity();
  ClosestPoint best;
  for (const Vector3& direction : directionsAcross(b - a))
  {
    const Point3 beside = middle + away * direction;
    ClosestPoint where = haveFace ? projector.nearestOnShared(edge.edgeClass, edge.entities, beside)
                                  : projector.nearest(beside, 4 * away);
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

/// The face that a place is inside, or a face at the smooth edge that it is on, as at a seam; -1:
/// it is elsewhere.
std::int32_t faceAt(const NurbsModel& model, const ClosestPoint& place)
{
  const auto [dimension, index] = place.entity;
  if (dimension == 1)
  {
    const NurbsEdge& edge = model.edges[index];
    return edge.sharp || edge.faces.empty() ? -1 : edge.faces.front();
  }
  return dimension == 2 ? index : -1;
}

/// Whether edges of a face that are no seams meet at a CAD vertex.
bool isCorner(const NurbsModel& model, EntityId vertex, std::int32_t face)
{
  const auto edges =
    vertex.dimension == 0 ? entitiesAround(model, vertex, 1) : std::vector<std::int32_t>{};
  const auto isOfFace = [&](std::int32_t edge)
  {
    const auto& faces = model.edges[edge].faces;
    return !isSeam(model.edges[edge]) && std::binary_search(faces.begin(), faces.end(), face);
  };
  return std::count_if(edges.begin(), edges.end(), isOfFace) > 1;
}

/// The place that is as far from the border of its face as the ends of the edge are in the mean,
/// over the place of the border that is nearest to the middle; with no entity if they are on the
/// border, or an end or that place is a corner, where the face may taper to nothing.
ClosestPoint placeAcross(
  const BoundaryProjector& projector, const BoundaryEdge& edge, const ClosestPoint& border)
{
  const auto& [a, b] = edge.points;
  const auto faces = projector.entitiesOf(edge.edgeClass, edge.entities);
  const auto isAtCorner = [&](EntityId end)
  { return isCorner(projector.model().nurbs(), end, faces.front()); };
  if (border.entity.dimension != 1 || faces.empty() ||
      std::any_of(edge.entities.begin(), edge.entities.end(), isAtCorner))
  {
    return {};
  }
  const double away = 0.5 * (projector.nearestOn(border.entity, a).distance +
                              projector.nearestOn(border.entity, b).distance);
  if (!(away > atBorder * distance(a, b)))
  {
    return {};
  }
  const CADModel& model = projector.model();
  const Vector3 across = cross(model.normalNear(faces.front(), border.point),
    model.tangent(border.entity.index, border.parameters[0]));
  ClosestPoint best; // beside the border, the face is on one side of it
  for (const double step : { away, -away })
  {
    const ClosestPoint place =
      projector.nearestOnShared(edge.edgeClass, edge.entities, border.point + step * across);
    best = isNearer(place, best) ? place : best;
  }
  best.distance = distance(0.5 * (a + b), best.point);
  return best;
}

} // namespace

ClosestPoint projectMidpoint(const BoundaryProjector& projector, const BoundaryEdge& edge)
{
  const auto& [a, b] = edge.points;
  const EdgeClass& edgeClass = edge.edgeClass;
  const ClosestPoint where = projector.project(edgeClass, 0.5 * (a + b), edge.entities);
  if (!where.entity)
  {
    return where;
  }
  const ClosestPoint nose = onNose(projector, edge, where);
  if (nose.entity)
  {
    return nose;
  }
  const bool isAtEnd =
    std::min(distance(where.point, a), distance(where.point, b)) <= atEnd * distance(a, b);
  const bool isOnEdge = edgeClass.kind == EdgeClass::OnEdge && edgeClass.entity >= 0;
  const EntityId entity{ static_cast<std::int8_t>(isOnEdge ? 1 : 2), edgeClass.entity };
  if (!isAtEnd && (edgeClass.entity < 0 || !hasLeft(projector, entity, edge, where)))
  {
    return where;
  }
  const ClosestPoint between =
    isOnEdge ? betweenOnEdge(projector, edge) : betweenOnFaces(projector, edge, where.distance);
  const double limit = isOnEdge ? distance(a, b) : asNear * where.distance;
  return between.entity && (isAtEnd || between.distance <= limit) ? between : where;
}

ClosestPoint onNose(
  const BoundaryProjector& projector, const BoundaryEdge& edge, const ClosestPoint& where)
{
  const auto& [a, b] = edge.points;
  const double length = distance(a, b);
  if (projector.kind() != BoundaryKind::Faces || edge.edgeClass.kind != EdgeClass::Smooth ||
      where.entity.dimension != 2 || where.distance <= noseHeight * length)
  {
    return {};
  }
  const auto common = projector.entitiesOf(edge.edgeClass, edge.entities);
  const auto normalAt = [&](int end)
  {
    const EntityId entity = edge.entities[end];
    const std::int32_t face = common.size() == 1      ? common[0]
                              : entity.dimension == 2 ? entity.index
                                                      : -1;
    return face >= 0 ? projector.model().normalNear(face, edge.points[end]) : Vector3{};
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
           dot(projector.model().normal(place.entity.index, place.parameters), between) >=
             noseCosine;
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
    const ClosestPoint shared = projector.nearestOnShared(edge.edgeClass, edge.entities, point);
    ClosestPoint place = shared.entity ? shared : projector.nearest(point, 2 * length);
    place.distance = distance(place.point, middle);
    const double off = std::abs(distance(place.point, a) - distance(place.point, b));
    if (fits(place) && place.distance <= 2 * length && off <= noseBalance * length &&
        isNearer(place, best))
    {
      best = place;
    }
  }
  return best;
}

ClosestPoint offBorder(
  const BoundaryProjector& projector, const BoundaryEdge& edge, const ClosestPoint& where)
{
  if (projector.kind() != BoundaryKind::Faces || edge.edgeClass.kind != EdgeClass::Smooth)
  {
    return where;
  }
  const auto faces = projector.entitiesOf(edge.edgeClass, edge.entities);
  if (where.entity.dimension == 2 &&
      (faces.empty() || std::binary_search(faces.begin(), faces.end(), where.entity.index)))
  {
    return where;
  }
  const Point3 middle = 0.5 * (edge.points[0] + edge.points[1]);
  ClosestPoint border = where; // that of the face where it is nearest, not of another one behind it
  bool isInside = false;       // of that face, as at its seam
  for (std::size_t f = 0; f < faces.size(); ++f)
  {
    const ClosestPoint onFace = projector.nearestOn({ 2, faces[f] }, middle);
    if (f == 0 || isNearer(onFace, border))
    {
      border = onFace;
      isInside = isWithin(projector.model().nurbs(), { 2, faces[f] }, border.entity);
    }
  }
  const auto edges = entitiesAround(projector.model().nurbs(), border.entity, 1);
  if (isInside || edges.empty())
  {
    return border;
  }
  const bool isSmooth = std::none_of(edges.begin(), edges.end(),
    [&](std::int32_t of) { return projector.model().nurbs().edges[of].sharp; });
  const ClosestPoint across = isSmooth ? placeAcross(projector, edge, border) : ClosestPoint{};
  if (across.entity)
  {
    return across;
  }
  // As far inside as the middle is outside, or half as far where the surface goes on beyond; where
  // the face is narrower than that, less, and where that is next to nothing, more.
  for (int step = isSmooth ? 1 : 0; step <= 2 * halvingsInside; ++step)
  {
    const double part = std::ldexp(1.0, step <= halvingsInside ? -step : step - halvingsInside);
    ClosestPoint inside = projector.nearestOnShared(
      edge.edgeClass, edge.entities, border.point + part * (border.point - middle));
    if (inside.entity)
    {
      inside.distance = distance(middle, inside.point);
      return inside;
    }
  }
  return border;
}

ClosestPoint inPlane(const BoundaryProjector& projector, const BoundaryEdge& edge,
  const ClosestPoint& where, const Vector3& normal)
{
  const CADModel& model = projector.model();
  const double tolerance = planeTolerance * model.size();
  const Point3 middle = 0.5 * (edge.points[0] + edge.points[1]);
  if (edge.edgeClass.kind != EdgeClass::Smooth ||
      std::abs(dot(where.point - middle, normal)) <= tolerance)
  {
    return where;
  }
  Point3 point = middle;
  ClosestPoint place = where;
  for (int step = 0; step < mostSteps && place.entity.dimension == 2; ++step)
  {
    const Vector3 ofCAD = model.normal(place.entity.index, place.parameters);
    const Vector3 along = ofCAD - dot(ofCAD, normal) * normal;
    const double slope = squaredNorm(along);
    if (slope < leastSlope * leastSlope)
    {
      return where;
    }
    point = point + (dot(place.point - point, ofCAD) / slope) * along;
    place = projector.nearestOnShared(edge.edgeClass, edge.entities, point);
    if (place.distance <= tolerance && place.entity)
    {
      place.distance = distance(place.point, middle);
      return place.distance <= where.distance / leastSlope ? place : where;
    }
  }
  return where;
}

ClosestPoint placeBeside(const BoundaryProjector& projector, const BoundaryEdge& edge,
  const Vector3& direction, const std::vector<double>& parts,
  const std::function<bool(const ClosestPoint&)>& accepts)
{
  const Point3 middle = 0.5 * (edge.points[0] + edge.points[1]);
  const double length = distance(edge.points[0], edge.points[1]);
  for (const double part : parts)
  {
    ClosestPoint place =
      projector.project(edge.edgeClass, middle + part * length * direction, edge.entities);
    place.distance = distance(place.point, middle);
    if (place.entity && place.distance <= length && accepts(place))
    {
      return place;
    }
  }
  return {};
}

bool isFarAcross(
  const BoundaryProjector& projector, const BoundaryEdge& edge, const ClosestPoint& where)
{
  return edge.edgeClass.kind == EdgeClass::Smooth &&
         faceAt(projector.model().nurbs(), where) >= 0 &&
         where.distance > farAcross * distance(edge.points[0], edge.points[1]);
}

ClosestPoint facing(const BoundaryProjector& projector, const BoundaryEdge& edge,
  const ClosestPoint& where, const Vector3& normal, const FaceSides& sides)
{
  const CADModel& model = projector.model();
  const auto cosine = [&](const ClosestPoint& place, std::int32_t face)
  {
    const Vector3 ofCAD = place.entity.dimension == 2 ? model.normal(face, place.parameters)
                                                      : model.normalNear(face, place.point);
    return sides[face] * dot(ofCAD, normal);
  };
  if (cosine(where, faceAt(model.nurbs(), where)) > opposed)
  {
    return where;
  }
  const ClosestPoint place =
    placeBeside(projector, edge, normal, { 0.125, -0.125, 0.25, -0.25, 0.5, -0.5, 1.0, -1.0 },
      [&](const ClosestPoint& candidate)
      {
        const std::int32_t face = faceAt(model.nurbs(), candidate);
        return face >= 0 && cosine(candidate, face) > -opposed;
      });
  return place.entity ? place : where;
}

} // namespace cadrefine
