#include "pipeline/LocalOperations.h"

#include "fields/ArrayTransfer.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkTypeInt64Array.h>

#include <algorithm>
#include <map>
#include <utility>

namespace cadrefine
{
namespace
{

constexpr const char* blockArray = "cadrefine:block";

/// Numbers of the different tags of `count` cells from the first one on.
std::vector<Index> labelsOf(vtkCellData* data, vtkIdType first, std::size_t count)
{
  std::vector<Index> labels(count, 0);
  for (int a = 0; a < data->GetNumberOfArrays(); ++a)
  {
    vtkDataArray* array = data->GetArray(a);
    if (!array || !isTag(array))
    {
      continue;
    }
    std::map<std::pair<Index, std::vector<double>>, Index> numbers;
    std::vector<double> tag(array->GetNumberOfComponents());
    for (std::size_t c = 0; c < count; ++c)
    {
      array->GetTuple(first + static_cast<vtkIdType>(c), tag.data());
      const auto next = static_cast<Index>(numbers.size());
      labels[c] = numbers.emplace(std::pair(labels[c], tag), next).first->second;
    }
  }
  return labels;
}

/// Brings each block to one rank. The blocks after that.
OperationBlocks gather(const PipelineContext& context, MeshState& state, OperationBlocks blocks)
{
  const SimplexMesh& mesh = state.mesh.mesh();
  const auto ranks = ranksOfBlocks(context.exchange, state.mesh, blocks);
  if (!context.exchange.any(!ranks.empty()))
  {
    return blocks;
  }
  const vtkIdType first = firstCellOfDimension(mesh, mesh.dimension);
  vtkNew<vtkTypeInt64Array> ofCells;
  ofCells->SetName(blockArray);
  ofCells->SetNumberOfValues(static_cast<vtkIdType>(mesh.cellCount()));
  ofCells->FillValue(-1);
  std::copy(blocks.ofCells.begin(), blocks.ofCells.end(), ofCells->GetPointer(first));
  state.arrays.ofCells->AddArray(ofCells);
  meshHasChanged(state);
  redistribute(context, state, ranks);
  const auto* sent =
    vtkTypeInt64Array::SafeDownCast(state.arrays.ofCells->GetAbstractArray(blockArray));
  blocks.ofCells.clear();
  const vtkIdType firstSent = firstCellOfDimension(mesh, mesh.dimension);
  for (std::size_t c = 0; c < state.mesh.converted.cellIds[mesh.dimension].size(); ++c)
  {
    blocks.ofCells.push_back(sent->GetValue(firstSent + static_cast<vtkIdType>(c)));
  }
  state.arrays.ofCells->RemoveArray(blockArray);
  return blocks;
}

} // namespace

std::int64_t operate(const PipelineContext& context, MeshState& state,
  const std::vector<unsigned char>& flags, const BlockSettings& settings, const BlockWork& work)
{
  RankExchange& exchange = context.exchange;
  const OperationBlocks blocks = gather(
    context, state, findOperationBlocks(exchange, state.mesh, flags, settings, state.parallelFor));
  ClassifiedBoundary& boundary = boundaryOf(context, state);
  const SimplexMesh& mesh = state.mesh.mesh();
  const auto labels = [&](int dimension, std::size_t count)
  { return labelsOf(state.arrays.ofCells, firstCellOfDimension(mesh, dimension), count); };
  const CellLabels ofCells{ labels(3, mesh.tetrahedra.size()), labels(2, mesh.triangles.size()),
    labels(1, mesh.segments.size()) };
  OperationTrace trace = operateOnBlocks(exchange, state.mesh, *state.classification, boundary,
    { blocks, ofCells, work, state.mapping.conserves() }, state.parallelFor);
  meshHasChanged(state);
  state.onBoundary.clear();
  const std::size_t done = state.mapping.stageCount();
  state.mapping.refine(std::move(trace.cells));
  state.mapping.convert(
    { std::vector<vtkIdType>(trace.keptVertices.begin(), trace.keptVertices.end()), {} });
  followMapping(exchange, state, done);
  return trace.operations;
}

} // namespace cadrefine
