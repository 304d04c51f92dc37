#include "classification/FacetClassification.h"

#include "classification/FacetsOffCAD.h"
#include "classification/OddFacets.h"
#include "comm/CollectiveErrors.h"
#include "comm/LoadBalancedMap.h"
#include "comm/Threads.h"

#include <cadrefine/classification/CADAdjacency.h>
#include <cadrefine/classification/ClassificationTolerances.h>
#include <cadrefine/mesh/Quality.h>

#include <algorithm>
#include <array>
#include <map>

namespace cadrefine
{
namespace
{

/// Whether the facet looks alike on the CAD: no edge shorter than half of it or longer than twice,
/// not less than a quarter of its area, if all corners come onto edges, and, where the user sets no
/// limit, no corner farther away than half of the longest edge. Facets of walls and of the far
/// field collapse when their corners are projected, and so do those beside a face, in its plane, as
/// on a plane of symmetry.
bool keepsItsShape(
  const ProjectionTask& task, const std::vector<ClosestPoint>& hits, const Facet& facet)
{
  const auto& points = task.points();
  const int corners = facet.corners();
  double longest = 0;
  double farthest = 0;
  for (int k = 0; k < corners; ++k)
  {
    const Index a = facet.vertices[k];
    const Index b = facet.vertices[(k + 1) % corners];
    const double before = distance(points[a], points[b]);
    const double after = distance(hits[a].point, hits[b].point);
    if (after < ClassificationTolerances::leastShrinking * before ||
        before < ClassificationTolerances::leastShrinking * after)
    {
      return false;
    }
    longest = std::max(longest, before);
    farthest = std::max(farthest, hits[a].distance);
  }
  const bool isAlongEdges = std::all_of(
    facet.begin(), facet.end(), [&](Index vertex) { return hits[vertex].entity.dimension < 2; });
  if (corners > 2 && isAlongEdges)
  {
    std::array<Point3, 4> projected{};
    std::transform(facet.begin(), facet.end(), projected.begin(),
      [&](Index vertex) { return hits[vertex].point; });
    if (norm(twofoldAreaVector(projected, corners)) <
        ClassificationTolerances::leastArea *
          norm(twofoldAreaVector(pointsOf(task.mesh.mesh(), facet), corners)))
    {
      return false;
    }
  }
  return task.options.maximumDistance ||
         farthest <= ClassificationTolerances::farthestCorner * longest;
}

std::vector<FacetRecord> makeRecords(
  const ProjectionTask& task, const std::vector<ClosestPoint>& hits, const ParallelFor& parallelFor)
{
  std::vector<EntityId> entities(hits.size());
  std::transform(
    hits.begin(), hits.end(), entities.begin(), [](const ClosestPoint& hit) { return hit.entity; });
  const auto recordOf = [&](const Facet& facet)
  {
    FacetRecord record =
      makeRecord(task.projector, classifiedFacet(task.mesh.mesh(), entities, facet));
    record.onCAD = record.onCAD && keepsItsShape(task, hits, facet);
    record.free = std::any_of(facet.begin(), facet.end(),
      [&](Index vertex) { return !task.options.inRegion(task.points()[vertex]); });
    return record;
  };
  const auto& facets = task.boundary.facets;
  std::vector<FacetRecord> records(facets.size());
  forEachIndex(parallelFor, facets.size(), coarseGrain,
    [&](std::size_t f) { records[f] = recordOf(facets[f]); });
  return records;
}

/// 1 for vertices that are, like all vertices that share a boundary edge with them, nearest to one
/// face.
std::vector<unsigned char> findThoseAmongTheirOwn(
  const ProjectionTask& task, const std::vector<ClosestPoint>& hits)
{
  std::vector<unsigned char> result(hits.size());
  std::transform(hits.begin(), hits.end(), result.begin(),
    [](const ClosestPoint& hit) { return hit.entity.dimension == 2; });
  for (const auto& [a, b] : task.boundary.edges.edges())
  {
    if (hits[a].entity != hits[b].entity)
    {
      result[a] = 0;
      result[b] = 0;
    }
  }
  combineSmallest(task.exchange, task.mesh.shared, result);
  return result;
}

std::vector<FaceMatch> findFaces(
  const ProjectionTask& task, const std::vector<ClosestPoint>& hits, const FacetClasses& classes)
{
  const auto& records = classes.records;
  const auto amongTheirOwn = findThoseAmongTheirOwn(task, hits);
  const FaceFinder finder(task.model(), classes.sides);
  NumberedQueries<CornerHits> asked;
  for (std::size_t f = 0; f < records.size(); ++f)
  {
    if (!records[f].onCAD)
    {
      continue;
    }
    CornerHits query;
    query.exact = 1;
    query.isInside = records[f].isInside;
    query.corners = task.boundary.facets[f].corners();
    for (int k = 0; k < query.corners; ++k)
    {
      const Index vertex = task.boundary.facets[f].vertices[k];
      query.points[k] = task.points()[vertex];
      query.hits[k] = hits[vertex];
      query.amongItsOwn[k] = amongTheirOwn[vertex];
      query.exact = query.exact && hits[vertex].distance <= task.exact(vertex);
    }
    asked.add(f, query);
  }
  std::vector<FaceMatch> matches(records.size());
  answerBalanced<FaceMatch>(
    task.exchange, std::move(asked), [&](const CornerHits& query) { return finder.find(query); },
    [&](std::size_t f, const FaceMatch& match) { matches[f] = match; },
    { "finding the CAD faces of", "facets" });
  return matches;
}

/// The face that most of these neighbours of `facet` have; of several such faces its own or the
/// first.
std::int32_t majority(const FacetRecord& facet, const std::vector<FacetRecord>& neighbours)
{
  const double smooth = ClassificationTolerances::smoothFacetsCosine();
  std::map<std::int32_t, int> votes;
  for (const FacetRecord& neighbour : neighbours)
  {
    if (neighbour.face >= 0 && dot(neighbour.normal, facet.normal) >= smooth)
    {
      ++votes[neighbour.face];
    }
  }
  std::int32_t best = facet.face;
  for (const auto& [face, count] : votes)
  {
    best = count > votes[best] ? face : best;
  }
  return best;
}

/// Gives facets that are not sure of their face that of most of their neighbours. Only sure ones
/// are asked, so that the order of the facets does not matter.
void askNeighbours(const ProjectionTask& task, const std::vector<FaceMatch>& matches,
  std::vector<FacetRecord>& records)
{
  std::vector<FacetRecord> sure = records;
  for (std::size_t f = 0; f < sure.size(); ++f)
  {
    sure[f].face = matches[f].certain ? records[f].face : -1;
  }
  const auto ofEdges = gatherFacetRecords(task.exchange, task.boundary, sure);
  for (std::size_t f = 0; f < records.size(); ++f)
  {
    if (records[f].onCAD && !matches[f].certain)
    {
      std::vector<FacetRecord> neighbours;
      for (int k = 0; k < task.boundary.facets[f].edges(); ++k)
      {
        const auto& ofEdge = ofEdges[task.boundary.facetEdges[f][k]];
        neighbours.insert(neighbours.end(), ofEdge.begin(), ofEdge.end());
      }
      records[f].face = majority(records[f], neighbours);
    }
  }
}

} // namespace

FaceSides findSides(RankExchange& exchange, const CADModel& model,
  const DistributedBoundary& boundary, const std::vector<FacetRecord>& records,
  const std::function<ClosestPoint(Index)>& placeOf)
{
  const std::size_t faces = model.nurbs().faces.size();
  std::vector<std::int64_t> votes(2 * faces, 0); // alike, opposite
  for (std::size_t f = 0; f < records.size(); ++f)
  {
    if (!records[f].onCAD || records[f].isInside)
    {
      continue;
    }
    for (const Index vertex : boundary.facets[f])
    {
      const ClosestPoint place = placeOf(vertex);
      if (place.entity.dimension != 2)
      {
        continue;
      }
      const Vector3 normal = model.normal(place.entity.index, place.parameters);
      if (fitsEitherWay(normal, records[f].normal))
      {
        const bool isOpposite = dot(normal, records[f].normal) < 0;
        ++votes[place.entity.index + (isOpposite ? faces : 0)];
      }
    }
  }
  votes = exchange.sum(votes);
  const auto opposite = votes.begin() + static_cast<std::ptrdiff_t>(faces);
  return decideSides({ votes.begin(), opposite }, { opposite, votes.end() });
}

FacetClasses classifyFacets(const ProjectionTask& task, const std::vector<ClosestPoint>& hits)
{
  FacetClasses classes;
  auto& records = classes.records;
  const ParallelFor parallelFor = forOnThreads(task.exchange);
  agreeOnFailure(task.exchange, [&] { records = makeRecords(task, hits, parallelFor); });
  leaveEndsOfLayers(task, hits, records);
  leaveWalls(task, hits, records);
  if (!task.ofFaces())
  {
    return classes;
  }
  classes.sides = findSides(task.exchange, task.model(), task.boundary, records,
    [&](Index vertex) { return hits[vertex]; });
  const auto matches = findFaces(task, hits, classes);
  for (std::size_t f = 0; f < records.size(); ++f)
  {
    records[f].face = matches[f].face;
  }
  askNeighbours(task, matches, records);
  joinEars(task.exchange, task.mesh.mesh(), task.boundary, task.model().nurbs(),
    gatherFacetRecords(task.exchange, task.boundary, records), records);
  return classes;
}

} // namespace cadrefine
