#include "pipeline/MeshState.h"

#include "balancing/Redistribution.h"
#include "classification/EdgeMidpoints.h"
#include "comm/CollectiveErrors.h"
#include "comm/Threads.h"
#include "fields/CADArrays.h"
#include "fields/Densities.h"
#include "pipeline/LocalOperations.h"
#include "pipeline/MeshSummary.h"

#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkPointData.h>

#include <algorithm>
#include <utility>

namespace cadrefine
{

namespace
{

/// Whether all ranks know which vertices are on the boundary. Collective.
bool knowsBoundary(RankExchange& exchange, const MeshState& state)
{
  return !exchange.any(state.onBoundary.size() != state.mesh.mesh().points.size());
}

/// Adds the interpolation of the vertices that moved inside the mesh to the mapping. Collective.
void interpolate(RankExchange& exchange, MeshState& state, const MotionTrace& motion)
{
  auto interpolation = interpolationOf(exchange, state.mesh, motion.before, motion.inside);
  if (interpolation)
  {
    state.mapping.interpolate(std::move(*interpolation));
  }
}

} // namespace

MeshState readMesh(RankExchange& exchange, vtkPointSet* input, CellOrder order)
{
  exchange.progress().say(0, "reading the mesh");
  MeshState state;
  state.parallelFor = forOnThreads(exchange);
  state.mesh = makeDistributedMesh(exchange, input, order);
  ArraySelection selection = selectionOf(input, state.mesh.converted);
  state.arrays = select(arraysOf(input), selection);
  state.mapping.convert(std::move(selection));
  state.prototype.TakeReference(input->NewInstance());
  return state;
}

void readClassification(const PipelineContext& context, vtkPointSet* input, MeshState& state)
{
  agreeOnFailure(context.exchange,
    [&]
    {
      setClassification(
        state, readClassification(input, state.mesh.converted.pointOf, context.model));
    });
}

void setClassification(MeshState& state, Classification classification)
{
  for (const char* name :
    { arrays::dimension, arrays::entity, arrays::parameters, arrays::distance })
  {
    state.arrays.ofVertices->RemoveArray(name);
  }
  state.classification = std::move(classification);
}

ClassifiedBoundary& boundaryOf(const PipelineContext& context, MeshState& state)
{
  if (!state.boundary)
  {
    state.boundary = std::make_unique<ClassifiedBoundary>(findClassifiedBoundary(context.exchange,
      state.mesh, context.model, *state.classification, state.cache, state.onBoundary));
  }
  return *state.boundary;
}

const std::vector<unsigned char>& onBoundaryOf(const PipelineContext& context, MeshState& state)
{
  if (!knowsBoundary(context.exchange, state))
  {
    state.onBoundary = boundaryOf(context, state).boundary.onBoundary;
  }
  return state.onBoundary;
}

std::vector<EntityId> entitiesOfFacets(const PipelineContext& context, MeshState& state)
{
  ClassifiedBoundary& classified = boundaryOf(context, state);
  const DistributedBoundary& boundary = classified.boundary;
  const Mesh& mesh = state.mesh.mesh();
  const bool ofFaces = boundary.kind == BoundaryKind::Faces;
  if (!ofFaces && !classified.midpoints)
  {
    findMidpoints(context.exchange, mesh, *state.classification, state.cache, classified);
  }
  std::vector<EntityId> entities(boundary.facets.size());
  const auto find = [&](std::size_t f)
  {
    const FacetRecord& record = classified.classes.facets[f];
    if (record.onCAD && ofFaces)
    {
      entities[f] = faceOf(classified.projector, centroidOf(mesh, boundary.facets[f]), record.face);
    }
    else if (record.onCAD)
    {
      entities[f] = edgeOf(context.model, (*classified.midpoints)[boundary.facetEdges[f][0]]);
    }
  };
  agreeOnFailure(
    context.exchange, [&] { forEachIndex(state.parallelFor, entities.size(), coarseGrain, find); });
  return entities;
}

EntitySelection selectFaces(
  const PipelineContext& context, MeshState& state, const std::vector<std::string>& faces)
{
  const DistributedBoundary& boundary = boundaryOf(context, state).boundary;
  return selectEntities(context.model, boundary.facetDimension(), faces, "Faces");
}

std::vector<unsigned char> facetsOn(
  const PipelineContext& context, MeshState& state, const std::vector<std::string>& faces)
{
  if (faces.empty())
  {
    return {};
  }
  const EntitySelection chosen = selectFaces(context, state, faces);
  const std::vector<EntityId> entities = entitiesOfFacets(context, state);
  std::vector<unsigned char> flags(entities.size());
  std::transform(entities.begin(), entities.end(), flags.begin(),
    [&](EntityId entity) { return chosen.contains(context.model.nurbs(), entity); });
  return flags;
}

const QualitySummary& qualityOf(RankExchange& exchange, MeshState& state)
{
  if (!state.quality)
  {
    state.quality = summariseQuality(exchange, state.mesh);
  }
  return *state.quality;
}

bool warnOfInvalidCells(const PipelineContext& context, MeshState& state)
{
  const std::string warning = warningOfInvalidCells(
    qualityOf(context.exchange, state), countMesh(context.exchange, state.mesh));
  if (!warning.empty())
  {
    context.warn(warning);
  }
  return !warning.empty();
}

void followMapping(RankExchange& exchange, MeshState& state, std::size_t done)
{
  state.arrays = state.mapping.follow(exchange, std::move(state.arrays), done);
}

void followMotion(RankExchange& exchange, MeshState& state, const MotionTrace& motion)
{
  const std::size_t done = state.mapping.stageCount();
  interpolate(exchange, state, motion);
  if (!state.mapping.needs().densities.empty())
  {
    state.mapping.scale(densitiesOfMoved(state.mesh.mesh(), motion.before));
  }
  followMapping(exchange, state, done);
}

void meshHasChanged(MeshState& state)
{
  state.boundary.reset();
  state.quality.reset();
}

std::int64_t cut(const PipelineContext& context, MeshState& state, const RefinementPlan& plan,
  NewVertices newVertices)
{
  const bool keepsDensities = !state.mapping.needs().densities.empty();
  std::vector<Point3> before = keepsDensities ? state.mesh.mesh().points : std::vector<Point3>{};
  const std::vector<double> sizes = keepsDensities && state.mesh.mesh().hasNonSimplices()
                                      ? sizesOfCells(state.mesh.mesh(), before)
                                      : std::vector<double>{};
  auto [trace, motion] =
    state.classification
      ? refineOntoCAD(context.exchange, state.mesh, plan, boundaryOf(context, state),
          *state.classification, { newVertices, tagsOfCells(context.exchange, state) },
          context.statistics)
      : CutOntoCAD{ refine(context.exchange, state.mesh, plan, context.statistics), {} };
  meshHasChanged(state);
  state.onBoundary = std::move(trace.onBoundary);
  const std::int64_t projectedPoints = trace.projectedPoints;
  const RunStatistics::Stopwatch stopwatch(context.statistics, "seconds copying fields");
  if (keepsDensities)
  {
    trace.ofDensities = densitiesOfRefined(state.mesh.mesh(), trace, std::move(before), sizes);
  }
  const std::size_t done = state.mapping.stageCount();
  state.mapping.refine(std::move(trace));
  interpolate(context.exchange, state, motion);
  followMapping(context.exchange, state, done);
  return projectedPoints;
}

vtkSmartPointer<vtkPointSet> makeDataSet(const MeshState& state)
{
  const ConvertedMesh& converted = state.mesh.converted;
  auto output =
    makePointSet(state.prototype, converted.mesh, converted.midNodes, state.parallelFor);
  setArrays(state.arrays, converted, output, state.parallelFor);
  if (state.classification)
  {
    writeClassification(output, *state.classification);
  }
  return output;
}

void redistribute(const PipelineContext& context, MeshState& state, const std::vector<int>& ranks,
  std::vector<std::int64_t>* ofCells)
{
  RankExchange& exchange = context.exchange;
  const bool isBoundaryKnown = knowsBoundary(exchange, state);
  Redistribution sent = redistribute(exchange, std::move(state.mesh), ranks);
  state.onBoundary =
    isBoundaryKnown ? sent.ofVertices(exchange, state.onBoundary) : std::vector<unsigned char>{};
  if (state.classification)
  {
    auto& [entities, parameters, distances] = *state.classification;
    entities = sent.ofVertices(exchange, entities);
    parameters = sent.ofVertices(exchange, parameters);
    distances = sent.ofVertices(exchange, distances);
  }
  if (ofCells)
  {
    *ofCells = sent.ofCells(exchange, *ofCells);
  }
  meshHasChanged(state);
  state.mesh = std::move(sent.mesh);
  const std::size_t done = state.mapping.stageCount();
  state.mapping.redistribute(std::move(sent.delivery));
  followMapping(exchange, state, done);
}

PipelineResult resultOf(MeshState state)
{
  return { makeDataSet(state), std::move(state.mapping) };
}

} // namespace cadrefine
