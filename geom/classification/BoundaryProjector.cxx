#include <cadrefine/classification/BoundaryProjector.h>

#include <cadrefine/classification/CADAdjacency.h>
#include <cadrefine/classification/ClassificationTolerances.h>
#include <cadrefine/mesh/Quality.h>

#include <algorithm>
#include <limits>

namespace cadrefine
{
namespace
{

bool isOnFace(const EdgeClass& edgeClass)
{
  return edgeClass.kind == EdgeClass::Smooth && edgeClass.entity >= 0;
}

/// The normal at corner k of a facet: the facet's own, except for quadrilaterals, which need not be
/// flat.
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

SearchScope BoundaryProjector::scopeWithin(double limit) const
{
  SearchScope scope;
  scope.maximumDistance = limit;
  scope.faces = kind_ == BoundaryKind::Faces;
  scope.strays = kind_ == BoundaryKind::Edges;
  return scope;
}

ClosestPoint BoundaryProjector::nearest(const Point3& point, double limit) const
{
  return onSharedEdge(model_, point, model_.nearest(point, scopeWithin(limit)));
}

bool BoundaryProjector::isWithinDistance(const Point3& point, double limit) const
{
  return model_.isWithinDistance(point, scopeWithin(limit));
}

ClosestPoint BoundaryProjector::onSmallest(
  const Point3& point, double exact, const ClosestPoint& nearest) const
{
  if (!nearest.entity || nearest.distance > exact)
  {
    return nearest;
  }
  SearchScope scope = scopeWithin(exact);
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
  if (kind_ == BoundaryKind::Edges)
  {
    const ClosestPoint where = nearest(0.5 * (p[0] + p[1]), unlimited);
    return fitsTangent(model_, where, normalized(p[1] - p[0])) && isOfACorner(facet, where.entity);
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
  return fitsNormal(where.entity, where, normal) && isOfACorner(facet, where.entity);
}

bool BoundaryProjector::isBesideCAD(const std::array<Point3, 4>& p, int corners) const
{
  double longest = 0;
  for (int k = 0; k < corners; ++k)
  {
    longest = std::max(longest, distance(p[k], p[(k + 1) % corners]));
  }
  const ClosestPoint where =
    nearest(centroidOf(p, corners), ClassificationTolerances::farthestCorner * longest);
  if (!where.entity)
  {
    return false;
  }
  return kind_ == BoundaryKind::Edges
           ? fitsTangent(model_, where, normalized(p[1] - p[0]))
           : fitsNormal(where.entity, where, normalized(twofoldAreaVector(p, corners)));
}

/// Whether a corner of a facet between two cells lies on what is nearest to the middle of it.
bool BoundaryProjector::isOfACorner(const ClassifiedFacet& facet, EntityId middle) const
{
  bool isOf = !facet.isInside;
  for (int k = 0; k < facet.corners && !isOf; ++k)
  {
    const Point3& corner = facet.points[k];
    const double length = distance(corner, facet.points[(k + 1) % facet.corners]);
    isOf = !commonEntities(model_.nurbs(), facet.entities[k], middle, dimensionOf(kind_)).empty() ||
           nearestOn(middle, corner).distance <= roundedDistance(model_, length);
  }
  return isOf;
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

/// The nearest crease that both ends lie on; -1: none. The long side of an ear, beyond which the
/// same face goes on, is not on the CAD edge: that runs along the two others.
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
  // An edge between the two faces counts however far it bows.
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

/// A smooth CAD edge that both ends lie on, between the faces of the facets on the two sides; -1:
/// none.
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

/// A chord at the rim of the facets on the CAD, beside a wall that is not in it, may lead across a
/// face from one side of a crease to the other, as in half a model across a flat end: that crease
/// goes through the wall at both ends of the chord.
bool BoundaryProjector::passesThroughWall(std::int32_t crease, const std::array<Point3, 2>& points,
  const std::vector<FacetRecord>& facets) const
{
  if (facets.size() != 2 || facets[0].onCAD == facets[1].onCAD ||
      model_.nurbs().edges[crease].faces.size() != 2)
  {
    return false;
  }
  const Vector3& wall = facets[facets[0].onCAD ? 1 : 0].normal;
  return std::all_of(points.begin(), points.end(),
    [&](const Point3& end)
    {
      const ClosestPoint where = nearestOn({ 1, crease }, end);
      const Vector3 along = where.entity.dimension == 1
                              ? model_.tangent(crease, where.parameters[0])
                              : tangentAwayFrom(model_, crease, where.entity.index);
      return std::abs(dot(along, wall)) > ClassificationTolerances::throughWall;
    });
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
  if (kind_ == BoundaryKind::Edges || !endsOnEdges)
  {
    return onFace;
  }
  const auto pairs = meshEdges(points, onCAD);
  const bool angle = std::any_of(pairs.begin(), pairs.end(), hasAngle);
  const std::int32_t common = angle ? commonCrease(points, entities, onCAD) : -1;
  const std::int32_t crease = common >= 0 ? common : edges_.findCrease(pairs).edge;
  if (crease >= 0 && isOnLineOf(crease, entities[0]) && isOnLineOf(crease, entities[1]) &&
      !passesThroughWall(crease, points, facets))
  {
    return { EdgeClass::OnEdge, crease };
  }
  const std::int32_t smooth = commonSmoothEdge(points, entities, onCAD);
  return smooth >= 0 ? EdgeClass{ EdgeClass::OnEdge, smooth } : onFace;
}

/// The nearest point of a CAD edge (-1: of all creases); beyond the end of a crease, of those that
/// continue it.
ClosestPoint BoundaryProjector::projectOnEdge(std::int32_t edge, const Point3& point) const
{
  if (edge < 0)
  {
    return edges_.nearestCrease(point, std::numeric_limits<double>::infinity());
  }
  ClosestPoint where = nearestOn({ 1, edge }, point);
  EntityId end;
  while (where.entity.dimension == 0 && where.entity != end)
  {
    end = where.entity;
    for (const std::int32_t next : entitiesAround(model_.nurbs(), end, 1))
    {
      const ClosestPoint onNext =
        lines_[next] == lines_[edge] ? nearestOn({ 1, next }, point) : ClosestPoint{};
      where = isNearer(onNext, where) ? onNext : where;
    }
  }
  return where;
}

std::vector<std::int32_t> BoundaryProjector::entitiesOf(
  const EdgeClass& edgeClass, const std::array<EntityId, 2>& entities) const
{
  const std::int8_t dimension = dimensionOf(kind_);
  return isOnFace(edgeClass) ? std::vector<std::int32_t>{ edgeClass.entity }
                             : commonEntities(model_.nurbs(), entities[0], entities[1], dimension);
}

/// As it is on an entity that both ends share, it cannot jump to the other side of something thin.
ClosestPoint BoundaryProjector::nearestOnShared(
  const EdgeClass& edgeClass, const std::array<EntityId, 2>& entities, const Point3& point) const
{
  const std::int8_t dimension = dimensionOf(kind_);
  ClosestPoint best;
  for (const std::int32_t entity : entitiesOf(edgeClass, entities))
  {
    const ClosestPoint where = nearestOn({ dimension, entity }, point);
    if (isWithin(model_.nurbs(), { dimension, entity }, where.entity) && isNearer(where, best))
    {
      best = where;
    }
  }
  return best;
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
