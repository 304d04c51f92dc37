#include <cadrefine/nurbs/ClosestPointSearch.h>

#include <cadrefine/nurbs/FetchAhead.h>
#include <cadrefine/nurbs/LeafQuery.h>
#include <cadrefine/nurbs/SearchStructure.h>

#include <cmath>

namespace cadrefine
{
namespace
{

/// How an entity takes part in a query.
enum class Role
{
  none,
  itself,
  border ///< An edge that is not asked for, but ends a face that is: the answer names the face.
};

Role roleOf(const SearchEntity& entity, const SearchScope& scope)
{
  if (entity.stray && !scope.strays)
  {
    return Role::none;
  }
  switch (entity.id.dimension)
  {
    case 0:
      return scope.vertices ? Role::itself : Role::none;
    case 1:
      if (scope.edges || (scope.sharpEdges && entity.sharp))
      {
        return Role::itself;
      }
      return scope.faces && entity.face >= 0 ? Role::border : Role::none;
    default:
      return scope.faces ? Role::itself : Role::none;
  }
}

void visitTree(const SearchStructure& structure, BoundingBoxTree::Root root, const Point3& q,
  const SearchScope& scope, LeafQuery& query)
{
  const auto squaredLimit = [&query]()
  {
    const double limit = query.candidates().limit();
    return limit * limit;
  };
  structure.tree.visitNear(
    root, q, squaredLimit, [&](int item) { fetchAhead(&structure.leaves[item]); },
    [&](int item, double squaredDistance)
    {
      const SearchLeaf& leaf = structure.leaves[item];
      const SearchEntity& entity = structure.entities[leaf.entity];
      const Role role = roleOf(entity, scope);
      if (role == Role::itself)
      {
        query.visit(leaf, entity.id, false, squaredDistance);
      }
      else if (role == Role::border)
      {
        query.visit(leaf, { 2, entity.face }, true, squaredDistance);
      }
    });
}

/// In terms of the model's size: distances from points beyond `tooFar` differ by rounding alone, so
/// that a search would look at all of the model; the nearest place is then that from a point at
/// `asFar` in the same direction, but for an eighth of the size over it.
constexpr double tooFar = 1e8;
constexpr double asFar = 1e7;

} // namespace

struct ClosestPointSearch::Implementation
{
  explicit Implementation(const NurbsModel& model) : structure(model) {}

  template<class Visit>
  ClosestPoint answerTo(const Point3& point, double maximumDistance, const Visit& visit) const;
  Point3 nearer(const Point3& point) const;
  ClosestPoint answer(const Point3& q, LeafQuery& query) const;
  ClosestPoint onPatch(const Point3& q, const Candidate& candidate) const;
  ClosestPoint onBorder(const Point3& q, const Candidate& candidate) const;
  void visitEntity(EntityId id, const Point3& q, LeafQuery& query) const;
  void visitEdge(int edge, const Point3& q, LeafQuery& query) const;

  SearchStructure structure;
};

/// The point at the candidate's parameters, evaluated as anyone else would.
ClosestPoint ClosestPointSearch::Implementation::onPatch(
  const Point3& q, const Candidate& candidate) const
{
  const SearchPatch& patch = structure.patches[candidate.patch];
  ClosestPoint result;
  result.entity = candidate.id;
  result.parameters = patch.parametersAt(candidate.s, candidate.t);
  if (patch.trim)
  {
    result.borderEdge = patch.trim->edge;
    result.parameters = structure.onGrid(patch.entity, evaluate(*patch.trim, result.parameters[0]));
    result.point = structure.patchAt(patch.entity, result.parameters).evaluateAt(result.parameters);
  }
  else
  {
    result.point = patch.evaluateAt(result.parameters);
  }
  const Seams& seams = structure.entities[patch.entity].seams;
  if (seams.any())
  {
    const SearchPatch* grid = &structure.patches[structure.entities[patch.entity].firstPatch];
    const auto canonical = seams.canonical(grid, result.point, result.parameters);
    if (canonical != result.parameters)
    {
      result.parameters = canonical;
      result.point = structure.patchAt(patch.entity, canonical).evaluateAt(canonical);
    }
  }
  result.distance = distance(result.point, q);
  return result;
}

/// The point of the face nearest to the candidate, which is on an edge that bounds the face.
ClosestPoint ClosestPointSearch::Implementation::onBorder(
  const Point3& q, const Candidate& candidate) const
{
  const Point3 onEdge =
    evaluateLocal(structure.patches[candidate.patch].view, candidate.s, candidate.t);
  LeafQuery query(structure, onEdge, std::numeric_limits<double>::infinity());
  query.ignoreTrim();
  const SearchEntity& face = structure.entities[structure.entityNumber(candidate.id)];
  visitTree(structure, face.root, onEdge, {}, query);
  query.finish();
  const Candidate* onFace = query.candidates().winner();
  if (!onFace)
  {
    // Nothing is left of the face within its loops: the edge is all there is.
    Candidate edge = candidate;
    edge.id = structure.entities[structure.patches[candidate.patch].entity].id;
    return onPatch(q, edge);
  }
  return onPatch(q, *onFace);
}

/// Finishes the query.
ClosestPoint ClosestPointSearch::Implementation::answer(const Point3& q, LeafQuery& query) const
{
  query.finish();
  ClosestPoint result;
  if (const Candidate* winner = query.candidates().winner())
  {
    if (winner->patch < 0)
    {
      result.entity = winner->id;
      result.point = structure.model.vertices[winner->id.index].point;
      result.parameters.fill(std::numeric_limits<double>::quiet_NaN());
      result.distance = winner->distance;
    }
    else
    {
      result = winner->border ? onBorder(q, *winner) : onPatch(q, *winner);
    }
  }
  result.converged = query.converged();
  return result;
}

Point3 ClosestPointSearch::Implementation::nearer(const Point3& point) const
{
  const Vector3 away = point - structure.centre;
  const double most = tooFar * structure.size;
  if (std::abs(away[0]) <= most && std::abs(away[1]) <= most && std::abs(away[2]) <= most)
  {
    return point;
  }
  const double length = std::hypot(away[0], away[1], away[2]); // squares might overflow
  return structure.centre + (asFar * structure.size / length) * away;
}

/// Answers a query; `visit(q, query)` visits the leaves that may hold the place that is nearest to
/// q.
template<class Visit>
ClosestPoint ClosestPointSearch::Implementation::answerTo(
  const Point3& point, double maximumDistance, const Visit& visit) const
{
  if (!isFinite(point))
  {
    return {};
  }
  const Point3 q = nearer(point);
  LeafQuery query(structure, q, maximumDistance);
  visit(q, query);
  ClosestPoint result = answer(q, query);
  if (result.entity && q != point)
  {
    result.distance = distance(result.point, point);
    return result.distance <= maximumDistance ? result : ClosestPoint{};
  }
  return result;
}

void ClosestPointSearch::Implementation::visitEntity(
  EntityId id, const Point3& q, LeafQuery& query) const
{
  visitTree(structure, structure.entities[structure.entityNumber(id)].root, q, {}, query);
}

void ClosestPointSearch::Implementation::visitEdge(
  int index, const Point3& q, LeafQuery& query) const
{
  const NurbsEdge& edge = structure.model.edges[index];
  visitEntity({ 1, index }, q, query);
  for (const std::int32_t vertex : { edge.firstVertex, edge.lastVertex })
  {
    if (vertex >= 0)
    {
      visitEntity({ 0, vertex }, q, query);
    }
  }
}

ClosestPointSearch::ClosestPointSearch(const NurbsModel& model)
  : implementation_(std::make_unique<const Implementation>(model))
{
}

ClosestPointSearch::~ClosestPointSearch() = default;

ClosestPoint ClosestPointSearch::nearest(const Point3& point, const SearchScope& scope) const
{
  const SearchStructure& structure = implementation_->structure;
  return implementation_->answerTo(point, scope.maximumDistance,
    [&](const Point3& q, LeafQuery& query)
    { visitTree(structure, structure.root, q, scope, query); });
}

bool ClosestPointSearch::isWithinDistance(const Point3& point, const SearchScope& scope) const
{
  const SearchStructure& structure = implementation_->structure;
  if (!isFinite(point) || implementation_->nearer(point) != point)
  {
    return static_cast<bool>(nearest(point, scope).entity);
  }
  LeafQuery query(structure, point, scope.maximumDistance);
  query.takeAny();
  visitTree(structure, structure.root, point, scope, query);
  query.finish();
  return query.candidates().winner() != nullptr;
}

ClosestPoint ClosestPointSearch::nearestOn(EntityId entity, const Point3& point) const
{
  const SearchStructure& structure = implementation_->structure;
  if (!entity || entity.dimension > 2 || entity.index < 0 ||
      entity.index >= structure.model.count(entity.dimension))
  {
    return {};
  }
  return implementation_->answerTo(point, std::numeric_limits<double>::infinity(),
    [&](const Point3& q, LeafQuery& query)
    {
      switch (entity.dimension)
      {
        case 0:
          implementation_->visitEntity(entity, q, query);
          break;
        case 1:
          implementation_->visitEdge(entity.index, q, query);
          break;
        default:
          visitTree(
            structure, structure.entities[structure.entityNumber(entity)].closure, q, {}, query);
      }
    });
}

ClosestPoint ClosestPointSearch::nearestOnSurface(int face, const Point3& point) const
{
  if (face < 0 || face >= implementation_->structure.model.count(2))
  {
    return {};
  }
  return implementation_->answerTo(point, std::numeric_limits<double>::infinity(),
    [&](const Point3& q, LeafQuery& query)
    {
      query.ignoreTrim();
      implementation_->visitEntity({ 2, face }, q, query);
    });
}

double ClosestPointSearch::modelSize() const
{
  return implementation_->structure.size;
}

} // namespace cadrefine
