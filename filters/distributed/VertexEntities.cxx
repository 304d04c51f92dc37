#include "VertexEntities.h"

#include "CADAdjacency.h"
#include "EvenWork.h"
#include "MeshEdgeMatches.h"

#include <algorithm>

namespace cadrefine
{
namespace
{

struct VertexQuestion
{
  Point3 point;
  double limit;
  ClosestPoint hit;
  FewEntities faces;
  FewEntities edges;
};

/// The nearest point of the closures of these entities; of several that are equally near the one of
/// the smallest entity.
ClosestPoint nearestOf(
  const BoundaryProjector& projector, const FewEntities& entities, int dimension, const Point3& p)
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

/// On the nearest of its CAD edges, or where that ends, on those that continue it.
ClosestPoint placeOnEdges(const BoundaryProjector& projector, const VertexQuestion& question)
{
  const ClosestPoint place = nearestOf(projector, question.edges, 1, question.point);
  if (place.entity.dimension != 0)
  {
    return place;
  }
  const ClosestPoint crease = projector.nearestCrease(question.point, question.limit);
  const auto& lines = projector.lines();
  const auto found = entitiesAround(projector.model().nurbs(), crease.entity, 1);
  const bool continues = std::any_of(found.begin(), found.end(),
    [&](std::int32_t a)
    {
      return std::any_of(question.edges.begin(), question.edges.end(),
        [&](std::int32_t b) { return lines[a] == lines[b]; });
    });
  return continues ? crease : place;
}

ClosestPoint placeOf(const BoundaryProjector& projector, const VertexQuestion& question)
{
  ClosestPoint place = question.hit;
  if (!question.edges.empty())
  {
    place = placeOnEdges(projector, question);
  }
  else
  {
    place = nearestOf(projector, question.faces, 2, question.point);
  }
  return place.distance <= question.limit ? place : question.hit;
}

FewEntities unite(FewEntities a, const FewEntities& b)
{
  a.add(b);
  return a;
}

void addFaces(const ProjectionTask& task, const std::vector<ClosestPoint>& hits,
  const FacetClasses& facets, VertexEntities& meeting)
{
  meeting.faces.resize(hits.size());
  meeting.undecided.assign(hits.size(), 0);
  meeting.wrongSide.assign(hits.size(), 1);
  const FaceFinder finder(task.model(), facets.sides);
  for (std::size_t f = 0; f < facets.records.size(); ++f)
  {
    const FacetRecord& record = facets.records[f];
    for (int k = 0; k < task.boundary.facetCorners() && record.onCAD; ++k)
    {
      const Index vertex = task.boundary.facets[f].vertices[k];
      if (record.face < 0)
      {
        meeting.undecided[vertex] = task.triangles();
        continue;
      }
      meeting.faces[vertex].add(record.face);
      if (meeting.wrongSide[vertex] && finder.fitsAt(hits[vertex], record.normal))
      {
        meeting.wrongSide[vertex] = 0;
      }
    }
  }
  combineShared(task.exchange, task.mesh.shared, meeting.faces, unite);
  combineShared(task.exchange, task.mesh.shared, meeting.undecided,
    [](unsigned char a, unsigned char b) { return std::max(a, b); });
  combineShared(task.exchange, task.mesh.shared, meeting.wrongSide,
    [](unsigned char a, unsigned char b) { return std::min(a, b); });
}

void addEdges(
  const ProjectionTask& task, const std::vector<std::int32_t>& ofMeshEdges, VertexEntities& meeting)
{
  const auto& edges = task.boundary.edges.edges();
  for (std::size_t e = 0; e < edges.size(); ++e)
  {
    for (const Index vertex : edges[e])
    {
      if (ofMeshEdges[e] >= 0)
      {
        meeting.edges[vertex].add(ofMeshEdges[e]);
      }
    }
  }
  combineShared(task.exchange, task.mesh.shared, meeting.edges, unite);
}

/// Number of mesh edges along creases at each vertex.
std::vector<std::int32_t> countCreases(
  const ProjectionTask& task, const std::vector<std::int32_t>& ofMeshEdges)
{
  const auto& edges = task.boundary.edges.edges();
  const auto owned = task.boundary.sharedEdges.ownedHere(static_cast<Index>(edges.size()));
  std::vector<std::int32_t> creases(task.points().size(), 0);
  for (std::size_t e = 0; e < edges.size(); ++e)
  {
    const std::int32_t edge = ofMeshEdges[e];
    const bool counts = owned[e] && edge >= 0 && task.model().nurbs().edges[edge].sharp;
    creases[edges[e][0]] += counts;
    creases[edges[e][1]] += counts;
  }
  combineShared(
    task.exchange, task.mesh.shared, creases, [](std::int32_t a, std::int32_t b) { return a + b; });
  return creases;
}

void findDangling(const ProjectionTask& task, const std::vector<FacetRecord>& records,
  const std::vector<std::int32_t>& ofMeshEdges, VertexEntities& meeting)
{
  std::vector<unsigned char> inside(task.points().size(), 1);
  for (std::size_t f = 0; f < records.size(); ++f)
  {
    for (int k = 0; k < 3 && !records[f].onCAD; ++k)
    {
      inside[task.boundary.facets[f].vertices[k]] = 0;
    }
  }
  combineShared(task.exchange, task.mesh.shared, inside,
    [](unsigned char a, unsigned char b) { return std::min(a, b); });
  const auto creases = countCreases(task, ofMeshEdges);
  for (std::size_t v = 0; v < creases.size(); ++v)
  {
    meeting.dangling[v] = inside[v] && creases[v] == 1;
  }
}

} // namespace

VertexEntities findVertexEntities(
  const ProjectionTask& task, const std::vector<ClosestPoint>& hits, const FacetClasses& facets)
{
  const auto& records = facets.records;
  VertexEntities meeting;
  meeting.edges.resize(hits.size());
  addFaces(task, hits, facets, meeting);
  const double exact = 1e-9 * task.model().size();
  meeting.settled.resize(hits.size());
  std::transform(hits.begin(), hits.end(), meeting.settled.begin(),
    [&](const ClosestPoint& hit) { return hit.distance <= exact; });
  const auto ofEdges = findCADEdges(task, hits, records, meeting.settled);
  addEdges(task, ofEdges, meeting);
  meeting.dangling.assign(hits.size(), 0);
  if (task.triangles())
  {
    findDangling(task, records, ofEdges, meeting);
  }
  return meeting;
}

void placeVertices(
  const ProjectionTask& task, const VertexEntities& meeting, std::vector<ClosestPoint>& hits)
{
  if (!task.triangles())
  {
    return;
  }
  std::vector<std::size_t> vertices;
  std::vector<VertexQuestion> questions;
  for (std::size_t v = 0; v < hits.size(); ++v)
  {
    if (hits[v].entity &&
        (!meeting.edges[v].empty() || (meeting.wrongSide[v] && !meeting.faces[v].empty())))
    {
      vertices.push_back(v);
      questions.push_back(
        { task.points()[v], task.limit(v), hits[v], meeting.faces[v], meeting.edges[v] });
    }
  }
  const auto answers = answerEvenly<ClosestPoint>(task.exchange, std::move(questions),
    [&](const VertexQuestion& question) { return placeOf(task.projector, question); },
    { "placing", "vertices" });
  for (std::size_t i = 0; i < vertices.size(); ++i)
  {
    hits[vertices[i]] = answers.values[i];
  }
}

} // namespace cadrefine
