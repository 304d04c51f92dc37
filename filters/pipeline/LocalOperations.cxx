#include "pipeline/LocalOperations.h"

#include "fields/CellTags.h"
#include "motion/BoundaryMotion.h"

#include <cadrefine/base/IndicesWhere.h>
#include <cadrefine/mesh/VertexFlags.h>

#include <algorithm>
#include <utility>

namespace cadrefine
{
namespace
{

/// Brings each block to one rank. Returns the blocks after that.
OperationBlocks gather(const PipelineContext& context, MeshState& state, OperationBlocks blocks)
{
  const Mesh& mesh = state.mesh.mesh();
  const auto ranks = ranksOfBlocks(context.exchange, state.mesh, blocks);
  if (!context.exchange.any(!ranks.empty()))
  {
    return blocks;
  }
  std::vector<std::int64_t> ofCells(
    static_cast<std::size_t>(firstCellOfDimension(mesh, mesh.dimension)), -1);
  ofCells.insert(ofCells.end(), blocks.ofCells.begin(), blocks.ofCells.end());
  redistribute(context, state, ranks, &ofCells);
  blocks.ofCells.assign(
    ofCells.begin() + firstCellOfDimension(mesh, mesh.dimension), ofCells.end());
  return blocks;
}

/// The boundary at the blocks: facets of their cells, with those beside these. Collective.
ClassifiedBoundary boundaryAt(const PipelineContext& context, const MeshState& state,
  const OperationBlocks& blocks, const std::vector<unsigned char>& onBoundary)
{
  const Mesh& mesh = state.mesh.mesh();
  std::vector<unsigned char> flags(mesh.points.size(), 0);
  flagVertices(mesh,
    indicesWhere(blocks.ofCells.size(), [&](std::size_t c) { return blocks.ofCells[c] >= 0; }),
    flags);
  flagRings(context.exchange, state.mesh, 1, flags, state.parallelFor);
  std::transform(flags.begin(), flags.end(), onBoundary.begin(), flags.begin(),
    [](unsigned char isNear, unsigned char isOn) { return isNear && isOn; });
  return findClassifiedBoundary(
    context.exchange, state.mesh, context.model, *state.classification, state.cache, flags);
}

/// The flags of the vertices that are left, given those of old and new ones.
std::vector<unsigned char> flagsOfKept(const std::vector<unsigned char>& ofOld,
  const std::vector<unsigned char>& ofNew, const std::vector<Index>& kept)
{
  const auto oldCount = static_cast<Index>(ofOld.size());
  std::vector<unsigned char> result(kept.size());
  std::transform(kept.begin(), kept.end(), result.begin(),
    [&](Index vertex) { return vertex < oldCount ? ofOld[vertex] : ofNew[vertex - oldCount]; });
  return result;
}

} // namespace

void findNumberings(RankExchange& exchange, MeshState& state)
{
  const Mesh& mesh = state.mesh.mesh();
  if (!state.numberings && mesh.dimension > 0)
  {
    state.numberings =
      findNumberings(exchange, state.arrays.ofCells, cellsOf(mesh, mesh.dimension));
  }
}

std::vector<std::uint64_t> tagsOfCells(RankExchange& exchange, MeshState& state)
{
  const Mesh& mesh = state.mesh.mesh();
  findNumberings(exchange, state);
  auto tags = state.numberings ? tagHashesOf(state.arrays.ofCells, cellsOf(mesh, mesh.dimension),
                                   *state.numberings)
                               : std::vector<std::uint64_t>{};
  const bool isTagged =
    std::any_of(tags.begin(), tags.end(), [](std::uint64_t tag) { return tag != 0; });
  return exchange.any(isTagged) ? tags : std::vector<std::uint64_t>{};
}

std::int64_t operateOnMesh(const PipelineContext& context, MeshState& state,
  const std::vector<unsigned char>& flags, const BlockSettings& settings, const BlockWork& work)
{
  RankExchange& exchange = context.exchange;
  const OperationBlocks blocks = gather(
    context, state, findOperationBlocks(exchange, state.mesh, flags, settings, state.parallelFor));
  const std::vector<unsigned char>& onBoundary = onBoundaryOf(context, state);
  const ClassifiedBoundary boundary = boundaryAt(context, state, blocks, onBoundary);
  const Mesh& mesh = state.mesh.mesh();
  findNumberings(exchange, state);
  const auto labels = [&](int dimension)
  { return labelsOf(state.arrays.ofCells, cellsOf(mesh, dimension), *state.numberings); };
  const CellLabels ofCells{ labels(3), labels(2), labels(1) };
  const FieldNeeds& needs = state.mapping.needs();
  const auto wanted =
    wantedPoints(exchange, state.mesh, boundary.projector, *state.classification, onBoundary);
  OperationTrace trace = operateOnBlocks(exchange, state.mesh, *state.classification, boundary,
    { blocks, wanted, ofCells, work, { needs.means, !needs.densities.empty() } },
    state.parallelFor);
  context.statistics.add("seconds operation kernels", trace.seconds);
  if (trace.operations == 0)
  {
    return 0;
  }
  state.onBoundary = flagsOfKept(onBoundary, trace.onBoundary, trace.keptVertices);
  meshHasChanged(state);
  const std::size_t done = state.mapping.stageCount();
  state.mapping.refine(std::move(trace.cells));
  state.mapping.convert(
    { std::vector<vtkIdType>(trace.keptVertices.begin(), trace.keptVertices.end()), {} });
  followMapping(exchange, state, done);
  return trace.operations;
}

} // namespace cadrefine
