#include "pipeline/Projection.h"

#include "comm/WorkSteps.h"
#include "mesh/BoundaryFacets.h"
#include "pipeline/CellImprovement.h"
#include "pipeline/FitReport.h"
#include "pipeline/LocalOperations.h"
#include "pipeline/MeshSummary.h"
#include "pipeline/PropertyCheck.h"
#include "projection/InitialProjection.h"

#include <cadrefine/base/Error.h>
#include <cadrefine/base/IndicesWhere.h>
#include <cadrefine/base/MixedBits.h>

#include <vtkPointData.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <utility>

namespace cadrefine
{
namespace
{

struct Projection
{
  ProjectionResult result;
  Fit fit;
  std::vector<unsigned char> pinched = {}; ///< See CellImprovementOptions.
};

/// 1 for the ends of edges with more than two outer facets of a mesh of volume; empty where no rank
/// has such an edge. Collective.
std::vector<unsigned char> findPinched(
  RankExchange& exchange, const DistributedMesh& mesh, const DistributedBoundary& boundary)
{
  if (mesh.mesh().dimension < 3)
  {
    return {};
  }
  const auto& edges = boundary.edges.edges();
  std::vector<std::int32_t> facetsAt(edges.size(), 0);
  for (std::size_t f = 0; f < boundary.facets.size(); ++f)
  {
    for (int k = 0; k < boundary.facets[f].edges() && !boundary.facets[f].isInside; ++k)
    {
      ++facetsAt[boundary.facetEdges[f][k]];
    }
  }
  combineShared(exchange, boundary.sharedEdges, facetsAt, std::plus<>());
  std::vector<unsigned char> flags(mesh.mesh().points.size(), 0);
  for (std::size_t e = 0; e < edges.size(); ++e)
  {
    for (const Index end : edges[e])
    {
      flags[end] = flags[end] || facetsAt[e] > 2;
    }
  }
  combineFlags(exchange, mesh.shared, flags);
  const bool any = std::any_of(flags.begin(), flags.end(), [](unsigned char flag) { return flag; });
  return exchange.any(any) ? flags : std::vector<unsigned char>{};
}

/// Warns where cells of different tags meet on curved CAD faces (of a planar mesh: edges), but the
/// mesh lists no cells between them: there its vertices and facets are not taken for those of the
/// CAD. Looks at about a thousand vertices at most. Collective.
void warnOfUnlistedInterface(const PipelineContext& context, const MeshState& state,
  const BoundaryProjector& projector, const ProjectionOptions& options)
{
  constexpr std::int64_t most = 1000;
  constexpr double onCAD = 1e-5; // of the size
  constexpr double alike = 1e-3; // directions
  constexpr std::int64_t fewest = 3;
  const CADModel& model = context.model;
  const Mesh& mesh = state.mesh.mesh();
  const auto owned = state.mesh.shared.ownedHere(static_cast<Index>(mesh.points.size()));
  const auto between = verticesBetweenTags(context.exchange, state.mesh, options.tags);
  const auto vertices = indicesWhere(mesh.points.size(),
    [&](std::size_t v) { return owned[v] && !state.onBoundary[v] && between[v]; });
  const auto stride = static_cast<std::uint64_t>(1 + context.exchange.sum(vertices.size()) / most);
  std::map<EntityId, Vector3> first;
  std::int64_t count = 0;
  for (const Index v : vertices)
  {
    if (mixedBits(static_cast<std::uint64_t>(mesh.ids[v])) % stride != 0 ||
        !options.inRegion(mesh.points[v]))
    {
      continue;
    }
    const ClosestPoint where = projector.nearest(mesh.points[v], onCAD * model.size());
    if (where.entity.dimension == dimensionOf(projector.kind()))
    {
      const std::int32_t index = where.entity.index;
      const Vector3 direction = where.entity.dimension == 2
                                  ? model.normal(index, where.parameters)
                                  : model.tangent(index, where.parameters[0]);
      const Vector3& other = first.emplace(where.entity, direction).first->second;
      count += norm(cross(direction, other)) > alike;
    }
  }
  if (context.exchange.sum(count) >= fewest)
  {
    context.warn(
      "cells of different tags (cell arrays of whole numbers, such as gmsh:physical) meet on "
      "curved " +
      std::string(projector.kind() == BoundaryKind::Faces ? "faces" : "edges") +
      " of the CAD, but the mesh lists no cells between them: this interface will not follow the "
      "CAD, and its geometric error does not count; list its " +
      (projector.kind() == BoundaryKind::Faces ? "triangles" : "lines") +
      " as cells of the mesh (in gmsh, as a physical group)");
  }
}

Projection projectCells(const PipelineContext& context, MeshState& state, ProjectionOptions options)
{
  context.exchange.progress().say(0.05, "finding the boundary");
  WorkSteps steps(context.exchange.progress());
  steps.begin(0.1, 0.9);
  const DistributedBoundary boundary = findBoundary(context.exchange, state.mesh, context.model);
  const BoundaryProjector projector(context.model, boundary.kind);
  state.onBoundary = boundary.onBoundary;
  options.mendCells = warnOfInvalidCells(context, state);
  options.tags = tagsOfCells(context.exchange, state);
  Projection projection;
  projection.result = projectBoundary(context.exchange, state.mesh, projector, boundary, options);
  steps.begin(0.9, 1);
  if (options.faces.empty())
  {
    warnOfUnlistedInterface(context, state, projector, options);
  }
  projection.fit =
    findFit({ context.exchange, state.mesh, projector, boundary, options }, projection.result);
  projection.pinched = findPinched(context.exchange, state.mesh, boundary);
  return projection;
}

Projection projectAlone(
  const PipelineContext& context, DistributedMesh& points, const ProjectionOptions& options)
{
  Projection projection;
  projection.result = projectPoints(context.exchange, points, context.model, options);
  projection.fit = findFitOfPoints(context.exchange, points, context.model, projection.result);
  return projection;
}

/// Why no vertex lies on the CAD.
std::string reasonOfNone(
  const Projection& projection, const ProjectionOptions& options, const std::string& cadUnit)
{
  const std::string none = "no vertex could be projected onto the CAD: ";
  if (projection.result.projectedPoints == 0)
  {
    return none + "the region (Region) contains no boundary vertex";
  }
  if (!options.faces.empty())
  {
    return none + "no boundary facet lies on the chosen faces (Faces)";
  }
  if (options.region)
  {
    return none + "no boundary facet lies on the CAD with all of its vertices in the region " +
           "(Region); enlarge the region";
  }
  const std::string farther = options.maximumDistance
                                ? "MaximumDistance"
                                : "its longest edges (set MaximumDistance to allow more)";
  const std::string misfit = warningOfMisfit(projection.fit, cadUnit, true);
  return none + "every boundary facet is either farther from the CAD than " + farther +
         " or not aligned with it; " + misfit;
}

/// Tells what does not fit; throws Error where nothing lies on the CAD.
void judge(const PipelineContext& context, const Projection& projection,
  const ProjectionOptions& options, std::int64_t verticesOnCAD)
{
  const std::string& unit = context.model.unit();
  if (verticesOnCAD == 0)
  {
    throw Error(reasonOfNone(projection, options, unit));
  }
  const bool isWhole = !options.region && options.faces.empty();
  for (const std::string& warning :
    { warningOfMisfit(projection.fit, unit, isWhole), warningOfStrays(projection.fit) })
  {
    if (!warning.empty())
    {
      context.warn(warning);
    }
  }
}

} // namespace

ProjectionOptions makeProjectionOptions(
  const double* region, double maximumDistance, std::vector<std::string> faces)
{
  checkProperty("MaximumDistance", maximumDistance, 0);
  ProjectionOptions options;
  options.faces = std::move(faces);
  if (maximumDistance > 0)
  {
    constexpr double anyDistance = 0x1p172; // between coordinates that meshes may have
    options.maximumDistance = std::min(maximumDistance, anyDistance);
  }
  if (region)
  {
    checkBox("Region", region);
    std::copy_n(region, 6, options.region.emplace().begin());
  }
  return options;
}

std::string projectMesh(
  const PipelineContext& context, MeshState& state, const ProjectionOptions& options)
{
  RankExchange& exchange = context.exchange;
  const BoundingBox box = findBox(exchange, state.mesh.mesh());
  Projection projection = state.mesh.mesh().dimension == 0
                            ? projectAlone(context, state.mesh, options)
                            : projectCells(context, state, options);
  meshHasChanged(state);
  projection.fit.meshBox = box;
  ProjectionResult& result = projection.result;
  recordBalance(context.statistics, "points", result.balance);
  context.statistics.set("points not converged", static_cast<double>(result.slowPoints));

  setClassification(state, std::move(result.classification));
  followMotion(exchange, state, result.motion);
  writeConflicts(state.arrays.ofVertices, result.conflicts);
  if (options.minimumQuality)
  {
    CellImprovementOptions improvement{ *options.minimumQuality };
    if (options.region)
    {
      improvement.inRegion = [&](const Point3& point) { return options.inRegion(point); };
    }
    improvement.pinched = std::move(projection.pinched);
    improveMesh(context, state, improvement);
  }
  if (state.mesh.mesh().dimension > 0)
  {
    const BoundaryProjector projector(
      context.model, kindOfBoundary(exchange, state.mesh, context.model));
    findVerticesOff(exchange, state.mesh, projector, onBoundaryOf(context, state),
      *state.classification, options, projection.fit);
  }
  vtkFieldData* ofMesh = state.arrays.ofMesh;
  summariseMesh(exchange, state.mesh, qualityOf(exchange, state), ofMesh);
  const std::int64_t onCAD = summariseProjection(
    exchange, state.mesh, *state.classification, result.projectedPoints, ofMesh);
  judge(context, projection, options, onCAD);
  writeFit(ofMesh, projection.fit);
  return describeFit(projection.fit, context.model.unit());
}

} // namespace cadrefine
