#include "classification/DistributedBoundary.h"

#include "classification/BoundaryCache.h"
#include "classification/OddFacets.h"
#include "comm/CollectiveErrors.h"
#include "comm/SharedEdges.h"
#include "comm/Threads.h"
#include "mesh/BoundaryFacets.h"
#include "mesh/MeshPlane.h"

#include <cadrefine/base/BoundingBox.h>
#include <cadrefine/classification/ClassificationTolerances.h>
#include <cadrefine/mesh/Quality.h>

#include <algorithm>
#include <limits>

namespace cadrefine
{
namespace
{

void listEdges(const Mesh& mesh, DistributedBoundary& boundary)
{
  boundary.edges = EdgeList(mesh.ids);
  for (const Facet& facet : boundary.facets)
  {
    std::array<Index, 4> edges{ -1, -1, -1, -1 };
    for (int k = 0; k < facet.edges(); ++k)
    {
      edges[k] =
        boundary.edges.findOrAdd(facet.vertices[k], facet.vertices[(k + 1) % facet.corners()]);
    }
    boundary.facetEdges.push_back(edges);
  }
}

void measureVertices(
  RankExchange& exchange, const DistributedMesh& mesh, DistributedBoundary& boundary)
{
  const auto& points = mesh.mesh().points;
  boundary.onBoundary.assign(points.size(), 0);
  boundary.longestEdge.assign(points.size(), 0.0);
  boundary.shortestEdge.assign(points.size(), std::numeric_limits<double>::infinity());
  for (const auto& ends : boundary.edges.edges())
  {
    const double length = distance(points[ends[0]], points[ends[1]]);
    for (const Index vertex : ends)
    {
      boundary.onBoundary[vertex] = 1;
      boundary.longestEdge[vertex] = std::max(boundary.longestEdge[vertex], length);
      boundary.shortestEdge[vertex] = std::min(boundary.shortestEdge[vertex], length);
    }
  }
  combineFlags(exchange, mesh.shared, boundary.onBoundary);
  combineLargest(exchange, mesh.shared, boundary.longestEdge);
  combineSmallest(exchange, mesh.shared, boundary.shortestEdge);
}

/// Whether the face of a facet, or whether it is on the CAD, may depend on the facets beside it.
bool dependsOnNeighbours(const FacetRecord& record)
{
  return record.odd || record.ear >= 0;
}

bool isClassified(const ClassifiedFacet& facet)
{
  const auto end = facet.entities.begin() + facet.corners;
  return std::all_of(
    facet.entities.begin(), end, [](EntityId entity) { return static_cast<bool>(entity); });
}

/// A record on its way to the rank that has the edge too.
struct SentRecord
{
  std::int64_t edge; ///< Place in the neighbour's list.
  FacetRecord record;
};

} // namespace

bool isPlanar(RankExchange& exchange, const std::vector<Point3>& points, const CADModel& model)
{
  if (model.count(2) == 0)
  {
    return true;
  }
  const Vector3 normal = normalOfPoints(exchange, points);
  if (std::count(normal.begin(), normal.end(), 0.0) >= 2)
  {
    return normal != Vector3{};
  }
  double offset = -std::numeric_limits<double>::infinity();
  for (const Point3& point : points)
  {
    offset = std::max(offset, dot(normal, point));
  }
  offset = exchange.max(offset);
  const double size = std::max(model.size(), combineBoxes(exchange, boxOf(points)).diagonal());
  return liesInPlane(model.nurbs(), normal, offset, ClassificationTolerances::exact * size);
}

BoundaryKind kindOfBoundary(
  RankExchange& exchange, const DistributedMesh& mesh, const CADModel& model)
{
  const Mesh& piece = mesh.mesh();
  return piece.dimension == 2 && isPlanar(exchange, piece.points, model) ? BoundaryKind::Edges
                                                                         : BoundaryKind::Faces;
}

DistributedBoundary findBoundary(RankExchange& exchange, const DistributedMesh& mesh,
  const CADModel& model, const std::vector<unsigned char>& among)
{
  DistributedBoundary boundary;
  const Mesh& piece = mesh.mesh();
  boundary.kind = kindOfBoundary(exchange, mesh, model);
  if (piece.dimension == 3 || boundary.kind == BoundaryKind::Edges)
  {
    boundary.facets = findBoundaryFacets(exchange, mesh, among);
  }
  else
  {
    boundary.facets = facetsOfSurface(piece);
    boundary.ofSurface = true;
  }
  listEdges(piece, boundary);
  boundary.sharedEdges = findSharedEdges(exchange, mesh.shared, piece.ids, boundary.edges.edges());
  measureVertices(exchange, mesh, boundary);
  return boundary;
}

std::vector<std::vector<FacetRecord>> gatherFacetRecords(RankExchange& exchange,
  const DistributedBoundary& boundary, const std::vector<FacetRecord>& ofFacets)
{
  std::vector<std::vector<FacetRecord>> ofEdges(boundary.edges.edges().size());
  for (std::size_t f = 0; f < ofFacets.size(); ++f)
  {
    for (const Index edge : boundary.facetEdges[f])
    {
      if (edge >= 0)
      {
        ofEdges[edge].push_back(ofFacets[f]);
      }
    }
  }
  const auto& shared = boundary.sharedEdges;
  std::vector<std::vector<SentRecord>> outgoing(shared.neighbours.size());
  for (std::size_t n = 0; n < shared.neighbours.size(); ++n)
  {
    for (std::size_t k = 0; k < shared.items[n].size(); ++k)
    {
      for (const FacetRecord& record : ofEdges[shared.items[n][k]])
      {
        outgoing[n].push_back({ static_cast<std::int64_t>(k), record });
      }
    }
  }
  const auto incoming = exchange.exchange(shared.neighbours, outgoing);
  for (std::size_t n = 0; n < incoming.size(); ++n)
  {
    for (const SentRecord& sent : incoming[n])
    {
      ofEdges[shared.items[n][sent.edge]].push_back(sent.record);
    }
  }
  return ofEdges;
}

ClassifiedFacet classifiedFacet(
  const Mesh& mesh, const std::vector<EntityId>& entities, const Facet& facet)
{
  ClassifiedFacet result;
  result.corners = facet.corners();
  result.isInside = facet.isInside;
  for (int k = 0; k < result.corners; ++k)
  {
    result.points[k] = mesh.points[facet.vertices[k]];
    result.entities[k] = entities[facet.vertices[k]];
  }
  return result;
}

FacetRecord makeRecord(const BoundaryProjector& projector, const ClassifiedFacet& facet)
{
  FacetRecord record;
  if (projector.kind() == BoundaryKind::Faces)
  {
    const Vector3 twofoldArea = twofoldAreaVector(facet.points, facet.corners);
    record.normal = normalized(twofoldArea);
    record.area = 0.5 * norm(twofoldArea);
    record.ear = projector.earOf(facet);
  }
  record.onCAD = isClassified(facet) && projector.isOnCAD(facet) ? 1 : 0;
  record.isInside = facet.isInside ? 1 : 0;
  return record;
}

Point3 centroidOf(const Mesh& mesh, const Facet& facet)
{
  Point3 sum{};
  for (const Index vertex : facet)
  {
    sum = sum + mesh.points[vertex];
  }
  return (1.0 / facet.corners()) * sum;
}

EntityId faceOf(const BoundaryProjector& projector, const Point3& centroid, int common)
{
  if (common >= 0)
  {
    return { 2, common };
  }
  const ClosestPoint nearest = projector.nearest(centroid, std::numeric_limits<double>::infinity());
  const int face = nearest.entity ? firstFaceAt(projector.model().nurbs(), nearest.entity) : -1;
  return face < 0 ? EntityId{} : EntityId{ 2, face };
}

EntityId edgeOf(const CADModel& model, const ClosestPoint& middle)
{
  if (middle.entity && middle.entity.dimension == 0)
  {
    const auto& edges = model.nurbs().vertices[middle.entity.index].edges;
    return edges.empty() ? EntityId{} : EntityId{ 1, edges.front() };
  }
  return middle.entity;
}

std::array<bool, 4> cornersOff(const Classification& classification, const Facet& facet)
{
  std::array<bool, 4> off{};
  std::transform(facet.vertices.begin(), facet.vertices.end(), off.begin(),
    [&](Index vertex) { return vertex >= 0 && classification.distances[vertex] > 0; });
  return off;
}

BoundaryClasses classifyBoundary(RankExchange& exchange, const Mesh& mesh,
  const DistributedBoundary& boundary, const std::vector<EntityId>& entities,
  const BoundaryProjector& projector, const BoundaryCache& cache)
{
  BoundaryClasses classes;
  const ParallelFor parallelFor = forOnThreads(exchange);
  auto& records = classes.facets;
  records.resize(boundary.facets.size());
  classes.known.assign(records.size(), -1);
  const auto classifyFacet = [&](std::size_t f)
  {
    const ClassifiedFacet facet = classifiedFacet(mesh, entities, boundary.facets[f]);
    FacetRecord& record = records[f];
    classes.known[f] = cache.find(mesh, boundary.facets[f], facet);
    if (classes.known[f] >= 0 && !dependsOnNeighbours(cache.record(classes.known[f])))
    {
      record = cache.record(classes.known[f]);
      return;
    }
    classes.known[f] = -1; // its neighbours may have changed
    record = makeRecord(projector, facet);
    record.odd = !record.onCAD && facet.corners > 2 && isClassified(facet);
    if (boundary.kind == BoundaryKind::Faces)
    {
      record.face = record.onCAD ? projector.faceOf(facet) : -1;
    }
  };
  agreeOnFailure(
    exchange, [&] { forEachIndex(parallelFor, records.size(), coarseGrain, classifyFacet); });
  auto ofEdges = gatherFacetRecords(exchange, boundary, records);
  if (joinOddFacets(exchange, mesh, boundary, entities, projector.model(), ofEdges, records))
  {
    ofEdges = gatherFacetRecords(exchange, boundary, records);
  }
  if (joinEars(exchange, mesh, boundary, projector.model().nurbs(), ofEdges, records))
  {
    ofEdges = gatherFacetRecords(exchange, boundary, records);
  }
  const auto& edges = boundary.edges.edges();
  classes.ofEdges.resize(edges.size());
  const auto classifyEdge = [&](std::size_t e)
  {
    const auto [a, b] = edges[e];
    classes.ofEdges[e] = projector.classify(
      { mesh.points[a], mesh.points[b] }, { entities[a], entities[b] }, ofEdges[e]);
  };
  agreeOnFailure(
    exchange, [&] { forEachIndex(parallelFor, edges.size(), coarseGrain, classifyEdge); });
  return classes;
}

ClassifiedBoundary findClassifiedBoundary(RankExchange& exchange, const DistributedMesh& mesh,
  const CADModel& model, const Classification& classification, const BoundaryCache& cache,
  const std::vector<unsigned char>& among)
{
  DistributedBoundary boundary = findBoundary(exchange, mesh, model, among);
  BoundaryProjector projector(model, boundary.kind);
  BoundaryClasses classes =
    classifyBoundary(exchange, mesh.mesh(), boundary, classification.entities, projector, cache);
  return { std::move(projector), std::move(boundary), std::move(classes) };
}

} // namespace cadrefine
