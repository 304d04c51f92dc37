#include "classification/VertexClassification.h"

#include "classification/EdgeClassification.h"
#include "comm/LoadBalancedMap.h"

#include <cadrefine/classification/CADAdjacency.h>

#include <algorithm>

namespace cadrefine
{
namespace
{

struct VertexQuery
{
  Point3 point;
  double limit;
  bool settled;
  ClosestPoint hit;
  SmallEntitySet faces;
  SmallEntitySet edges;
};

/// The nearest point of the closures of these entities; of several that are equally near the one of
/// the smallest entity.
ClosestPoint nearestOf(const BoundaryProjector& projector, const SmallEntitySet& entities,
  int dimension, const Point3& p)
{
  ClosestPoint best;
  for (const std::int32_t index : entities)
  {
    const ClosestPoint where =
      projector.nearestOn({ static_cast<std::int8_t>(dimension), index }, p);
    if (where.distance < best.distance ||
        (where.distance == best.distance && where.entity < best.entity))
    {
      best = where;
    }
  }
  return best;
}

/// The place of a vertex on the nearest of its CAD edges, or where that ends, on those that
/// continue it.
ClosestPoint placeOnEdges(const BoundaryProjector& projector, const VertexQuery& query)
{
  const ClosestPoint place = nearestOf(projector, query.edges, 1, query.point);
  if (place.entity.dimension != 0)
  {
    return place;
  }
  const ClosestPoint crease = projector.nearestCrease(query.point, query.limit);
  const auto& lines = projector.lines();
  const auto found = entitiesAround(projector.model().nurbs(), crease.entity, 1);
  const bool continues = std::any_of(found.begin(), found.end(),
    [&](std::int32_t a)
    {
      return std::any_of(query.edges.begin(), query.edges.end(),
        [&](std::int32_t b) { return lines[a] == lines[b]; });
    });
  return continues ? crease : place;
}

/// Whether the vertex lies on one of its CAD edges already, or on an end of one.
bool isInPlace(const NurbsModel& model, const VertexQuery& query)
{
  if (!query.settled || query.hit.entity.dimension > 1)
  {
    return false;
  }
  const auto around = entitiesAround(model, query.hit.entity, 1);
  return std::any_of(
    around.begin(), around.end(), [&](std::int32_t edge) { return query.edges.has(edge); });
}

ClosestPoint placeOf(const BoundaryProjector& projector, const VertexQuery& query)
{
  ClosestPoint place = query.hit;
  if (isInPlace(projector.model().nurbs(), query))
  {
    return place;
  }
  if (!query.edges.empty())
  {
    place = placeOnEdges(projector, query);
  }
  else
  {
    place = nearestOf(projector, query.faces, 2, query.point);
  }
  return place.distance <= query.limit ? place : query.hit;
}

SmallEntitySet unite(SmallEntitySet a, const SmallEntitySet& b)
{
  a.add(b);
  return a;
}

void addFaces(const ProjectionTask& task, const std::vector<ClosestPoint>& hits,
  const FacetClasses& facets, VertexClassification& meeting)
{
  meeting.faces.resize(hits.size());
  meeting.undecided.assign(hits.size(), 0);
  meeting.wrongSide.assign(hits.size(), 1);
  const FaceFinder finder(task.model(), facets.sides);
  for (std::size_t f = 0; f < facets.records.size(); ++f)
  {
    const FacetRecord& record = facets.records[f];
    if (!record.onCAD)
    {
      continue;
    }
    for (const Index vertex : task.boundary.facets[f])
    {
      if (record.face < 0)
      {
        meeting.undecided[vertex] = task.ofFaces();
        continue;
      }
      meeting.faces[vertex].add(record.face);
      if (meeting.wrongSide[vertex] && finder.fitsAt(hits[vertex], record.normal, record.isInside))
      {
        meeting.wrongSide[vertex] = 0;
      }
    }
  }
  combineShared(task.exchange, task.mesh.shared, meeting.faces, unite);
  combineFlags(task.exchange, task.mesh.shared, meeting.undecided);
  combineSmallest(task.exchange, task.mesh.shared, meeting.wrongSide);
}

void addEdges(const ProjectionTask& task, VertexClassification& meeting)
{
  const auto& edges = task.boundary.edges.edges();
  for (std::size_t e = 0; e < edges.size(); ++e)
  {
    for (const Index vertex : edges[e])
    {
      if (meeting.ofMeshEdges[e] >= 0)
      {
        meeting.edges[vertex].add(meeting.ofMeshEdges[e]);
      }
    }
  }
  combineShared(task.exchange, task.mesh.shared, meeting.edges, unite);
}

} // namespace

VertexClassification classifyVertices(
  const ProjectionTask& task, const std::vector<ClosestPoint>& hits, const FacetClasses& facets)
{
  VertexClassification meeting;
  meeting.edges.resize(hits.size());
  addFaces(task, hits, facets, meeting);
  meeting.settled.resize(hits.size());
  for (std::size_t v = 0; v < hits.size(); ++v)
  {
    meeting.settled[v] = hits[v].entity && hits[v].distance <= task.exact(v);
  }
  meeting.ofMeshEdges = findCADEdges(task, hits, facets.records, meeting.settled);
  addEdges(task, meeting);
  return meeting;
}

void placeVertices(
  const ProjectionTask& task, const VertexClassification& meeting, std::vector<ClosestPoint>& hits)
{
  if (!task.ofFaces())
  {
    return;
  }
  NumberedQueries<VertexQuery> asked;
  for (std::size_t v = 0; v < hits.size(); ++v)
  {
    if (hits[v].entity &&
        (!meeting.edges[v].empty() || (meeting.wrongSide[v] && !meeting.faces[v].empty())))
    {
      asked.add(v, { task.points()[v], task.limit(v), meeting.settled[v] != 0, hits[v],
                     meeting.faces[v], meeting.edges[v] });
    }
  }
  answerBalanced<ClosestPoint>(
    task.exchange, std::move(asked),
    [&](const VertexQuery& query) { return placeOf(task.projector, query); },
    [&](std::size_t v, const ClosestPoint& where) { hits[v] = where; },
    { "classifying", "vertices" });
}

} // namespace cadrefine
