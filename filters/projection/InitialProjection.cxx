#include "projection/InitialProjection.h"

#include "classification/Conflicts.h"
#include "classification/CornerAssignment.h"
#include "classification/FacetClassification.h"
#include "classification/VertexClassification.h"
#include "comm/CollectiveErrors.h"
#include "comm/LoadBalancedMap.h"
#include "comm/Threads.h"
#include "comm/WorkSteps.h"
#include "motion/BoundaryMotion.h"

#include <cadrefine/cad/model/EntitySelection.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

namespace cadrefine
{
namespace
{

/// A point that looks for its nearest one on the CAD, up to a limit.
struct PointQuestion
{
  Point3 point;
  double limit;
  double exact;
};

struct NearestPoints
{
  std::vector<ClosestPoint> hits; ///< Nearest point of each vertex; none of those that did not ask.
  std::int64_t asked = 0;         ///< Vertices that asked, over all ranks.
  std::int64_t slow = 0;          ///< Vertices that asked whose query has not converged.
  WorkBalance balance;
};

NearestPoints findNearest(const ProjectionTask& task)
{
  const auto& points = task.points();
  const auto owned = task.mesh.shared.ownedHere(static_cast<Index>(points.size()));
  NearestPoints result;
  NumberedQueries<PointQuestion> asked;
  for (std::size_t v = 0; v < points.size(); ++v)
  {
    if (task.boundary.onBoundary[v] && task.options.inRegion(points[v]))
    {
      asked.add(v, { points[v], task.limit(v), task.exact(v) });
      result.asked += owned[v];
    }
  }
  result.hits.resize(points.size());
  result.balance = answerBalanced<ClosestPoint>(
    task.exchange, std::move(asked),
    [&](const PointQuestion& query)
    {
      const ClosestPoint nearest = task.projector.nearest(query.point, query.limit);
      return task.projector.onSmallest(query.point, query.exact, nearest);
    },
    [&](std::size_t v, const ClosestPoint& hit)
    {
      result.hits[v] = hit;
      result.slow += owned[v] && !hit.converged;
    },
    { "projecting", "vertices" });
  result.asked = task.exchange.sum(result.asked);
  result.slow = task.exchange.sum(result.slow);
  return result;
}

/// 1 for vertices of facets on the CAD, on whatever rank these are.
std::vector<unsigned char> findVerticesOnCAD(
  const ProjectionTask& task, const std::vector<FacetRecord>& records)
{
  std::vector<unsigned char> onCAD(task.points().size(), 0);
  for (std::size_t f = 0; f < records.size(); ++f)
  {
    for (const Index vertex : task.boundary.facets[f])
    {
      onCAD[vertex] = onCAD[vertex] || records[f].onCAD;
    }
  }
  combineFlags(task.exchange, task.mesh.shared, onCAD);
  return onCAD;
}

/// Takes facets that lie on other faces (of a planar mesh, edges) than these off the CAD.
void leaveOut(const ProjectionTask& task, const EntitySelection& chosen,
  const ParallelFor& parallelFor, std::vector<FacetRecord>& records)
{
  const auto decide = [&](std::size_t f)
  {
    if (!records[f].onCAD)
    {
      return;
    }
    const Point3 centroid = centroidOf(task.mesh.mesh(), task.boundary.facets[f]);
    const EntityId entity =
      task.ofFaces() ? faceOf(task.projector, centroid, records[f].face)
                     : edgeOf(task.model(),
                         task.projector.nearest(centroid, std::numeric_limits<double>::infinity()));
    records[f].onCAD = chosen.contains(task.model().nurbs(), entity);
  };
  agreeOnFailure(
    task.exchange, [&] { forEachIndex(parallelFor, records.size(), coarseGrain, decide); });
}

/// 1 for vertices of the boundary, 2 for those outside the region.
std::vector<unsigned char> findFixed(const ProjectionTask& task)
{
  std::vector<unsigned char> fixed = task.boundary.onBoundary;
  for (std::size_t v = 0; v < fixed.size(); ++v)
  {
    fixed[v] = task.options.inRegion(task.points()[v]) ? fixed[v] : 2;
  }
  return fixed;
}

} // namespace

ProjectionResult projectBoundary(RankExchange& exchange, DistributedMesh& mesh,
  const BoundaryProjector& projector, const DistributedBoundary& boundary,
  const ProjectionOptions& options)
{
  const ProjectionTask task{ exchange, mesh, projector, boundary, options };
  WorkSteps steps(exchange.progress());
  steps.begin(0, 0.6);
  NearestPoints nearest = findNearest(task);
  auto& hits = nearest.hits;
  steps.begin(0.6, 0.75);
  FacetClasses facets = classifyFacets(task, hits);
  auto onCAD = findVerticesOnCAD(task, facets.records);
  steps.begin(0.75, 0.85);
  const VertexClassification meeting = classifyVertices(task, hits, facets);
  placeVertices(task, meeting, hits);
  steps.begin(0.85, 1);

  ProjectionResult result;
  const auto taken = giveCorners(task, meeting, onCAD, hits);
  result.conflicts = findConflicts(task, facets, meeting, onCAD, taken, hits);
  if (!options.faces.empty())
  {
    const EntitySelection chosen =
      selectEntities(task.model(), task.boundary.facetDimension(), options.faces, "Faces");
    leaveOut(task, chosen, forOnThreads(exchange), facets.records);
    onCAD = findVerticesOnCAD(task, facets.records);
  }
  result.classification.resize(hits.size());
  result.distancesBefore.assign(hits.size(), 0);
  Moves moves(mesh.mesh().points);
  for (std::size_t v = 0; v < hits.size(); ++v)
  {
    if (onCAD[v] && hits[v].entity)
    {
      result.classification.set(static_cast<Index>(v), hits[v]);
      result.distancesBefore[v] = distance(mesh.mesh().points[v], hits[v].point);
      moves.add(static_cast<Index>(v), hits[v].point);
    }
  }
  result.motion = moveOntoCAD(exchange, mesh, std::move(moves), result.classification,
    { projector, findFixed(task), options.tags, options.mendCells });
  result.projectedPoints = nearest.asked;
  result.slowPoints = nearest.slow;
  result.balance = nearest.balance;
  result.facets = facets.records;
  return result;
}

ProjectionResult projectPoints(RankExchange& exchange, DistributedMesh& mesh, const CADModel& model,
  const ProjectionOptions& options)
{
  auto& points = mesh.mesh().points;
  ProjectionResult result;
  result.motion.before = points;
  result.classification.resize(points.size());
  result.conflicts.assign(points.size(), 0);
  const auto owned = mesh.shared.ownedHere(static_cast<Index>(points.size()));
  std::optional<EntitySelection> chosen;
  if (!options.faces.empty())
  {
    chosen = selectEntities(model, model.count(2) > 0 ? 2 : 1, options.faces, "Faces");
  }
  SearchScope scope;
  scope.maximumDistance = options.maximumDistance.value_or(scope.maximumDistance);
  NumberedQueries<Point3> asked;
  for (std::size_t v = 0; v < points.size(); ++v)
  {
    if (options.inRegion(points[v]))
    {
      asked.add(v, points[v]);
      result.projectedPoints += owned[v];
    }
  }
  result.balance = answerBalanced<ClosestPoint>(
    exchange, std::move(asked), [&](const Point3& point) { return model.nearest(point, scope); },
    [&](std::size_t v, const ClosestPoint& hit)
    {
      result.slowPoints += owned[v] && !hit.converged;
      if (hit.entity && (!chosen || chosen->contains(model.nurbs(), hit.entity)))
      {
        result.classification.set(static_cast<Index>(v), hit);
        points[v] = hit.point;
      }
    },
    { "projecting", "points" });
  result.projectedPoints = exchange.sum(result.projectedPoints);
  result.slowPoints = exchange.sum(result.slowPoints);
  return result;
}

} // namespace cadrefine
