#include "pipeline/CellImprovement.h"

#include "fields/ArrayTransfer.h"
#include "motion/BoundaryMotion.h"
#include "operations/BlockOperations.h"
#include "refinement/DistributedRefinement.h"

#include <cadrefine/base/IndicesWhere.h>
#include <cadrefine/base/ParallelFor.h>
#include <cadrefine/mesh/Quality.h>
#include <cadrefine/motion/MoveGuard.h>

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkTypeInt64Array.h>

#include <algorithm>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace cadrefine
{
namespace
{

constexpr int maximumRounds = 6;
constexpr int ringsOfCells = 3;
/// Cells below this are operated on in the neighbourhood of those below the user's limit.
constexpr double aim = 0.3;

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

class CellImprovement
{
public:
  CellImprovement(
    const PipelineContext& context, MeshState& state, const CellImprovementOptions& options)
    : context_(context), exchange_(context.exchange), state_(state), options_(options)
  {
  }

  void run()
  {
    std::int64_t before = std::numeric_limits<std::int64_t>::max();
    for (int round = 0; round < maximumRounds; ++round)
    {
      const auto [flags, count] = findBad();
      if (count == 0 || count >= before)
      {
        return;
      }
      before = count;
      exchange_.progress().say(static_cast<double>(round) / maximumRounds,
        "improving cells, round " + std::to_string(round + 1) + " of at most " +
          std::to_string(maximumRounds));
      if (!operate(flags, round))
      {
        return;
      }
      moveOn();
    }
  }

private:
  SimplexMesh& mesh() { return state_.mesh.mesh(); }

  /// Where the vertices are wanted. Collective.
  std::vector<Point3> wantedPoints()
  {
    const BoundaryProjector& projector = boundaryOf(context_, state_).projector;
    const Classification& classification = *state_.classification;
    std::vector<Point3> wanted = mesh().points;
    for (std::size_t v = 0; v < wanted.size(); ++v)
    {
      if (classification.distances[v] > 0)
      {
        wanted[v] = projector.nearestOn(classification.entities[v], wanted[v]).point;
      }
    }
    return wanted;
  }

  struct Bad
  {
    std::vector<unsigned char> vertices; ///< 1: of a bad cell, or off the CAD.
    std::int64_t count = 0;              ///< Such cells and vertices over all ranks.
  };

  /// Vertices off the CAD, and cells that are badly shaped once they are on it. Collective.
  Bad findBad()
  {
    const auto& distances = state_.classification->distances;
    std::vector<unsigned char> flags(mesh().points.size(), 0);
    std::transform(distances.begin(), distances.end(), flags.begin(),
      [](double distance) { return distance > 0; });
    const std::vector<Index> off =
      indicesWhere(flags.size(), [&](std::size_t v) { return flags[v] != 0; });
    const bool anyOff = exchange_.any(!off.empty());
    if (!anyOff && qualityOf(exchange_, state_).minimum() >= options_.minimumQuality)
    {
      return {};
    }
    const auto owned = std::count_if(off.begin(), off.end(),
      [&](Index vertex) { return state_.mesh.shared.owner(vertex) == exchange_.rank(); });
    const std::vector<Index> cells = badCells(anyOff ? wantedPoints() : mesh().points);
    flagVertices(mesh(), cells, flags);
    return { std::move(flags), exchange_.sum(owned + static_cast<std::ptrdiff_t>(cells.size())) };
  }

  std::vector<Index> badCells(const std::vector<Point3>& points) const
  {
    const auto& cells = state_.mesh.mesh().tetrahedra;
    return collect<Index>(state_.parallelFor, cells.size(), fineGrain,
      [&](std::size_t begin, std::size_t end, std::vector<Index>& bad)
      {
        for (std::size_t c = begin; c < end; ++c)
        {
          const auto& [i, j, k, l] = cells[c];
          if (mayChange(cells[c]) &&
              meanRatio(points[i], points[j], points[k], points[l]) < options_.minimumQuality)
          {
            bad.push_back(static_cast<Index>(c));
          }
        }
      });
  }

  bool mayChange(const std::array<Index, 4>& cell) const
  {
    return !options_.inRegion ||
           std::all_of(cell.begin(), cell.end(),
             [&](Index vertex) { return options_.inRegion(state_.mesh.mesh().points[vertex]); });
  }

  /// Brings each block to one rank. The blocks after that.
  OperationBlocks gather(OperationBlocks blocks)
  {
    const auto ranks = ranksOfBlocks(exchange_, state_.mesh, blocks);
    if (!exchange_.any(!ranks.empty()))
    {
      return blocks;
    }
    const vtkIdType first = firstCellOfDimension(mesh(), 3);
    vtkNew<vtkTypeInt64Array> ofCells;
    ofCells->SetName(blockArray);
    ofCells->SetNumberOfValues(static_cast<vtkIdType>(mesh().cellCount()));
    ofCells->FillValue(-1);
    std::copy(blocks.ofCells.begin(), blocks.ofCells.end(), ofCells->GetPointer(first));
    state_.arrays.ofCells->AddArray(ofCells);
    meshHasChanged(state_);
    redistribute(context_, state_, ranks);
    const auto* sent =
      vtkTypeInt64Array::SafeDownCast(state_.arrays.ofCells->GetAbstractArray(blockArray));
    blocks.ofCells.clear();
    for (std::size_t c = 0; c < mesh().tetrahedra.size(); ++c)
    {
      blocks.ofCells.push_back(
        sent->GetValue(firstCellOfDimension(mesh(), 3) + static_cast<vtkIdType>(c)));
    }
    state_.arrays.ofCells->RemoveArray(blockArray);
    return blocks;
  }

  /// Returns whether cells have changed.
  bool operate(const std::vector<unsigned char>& flags, int round)
  {
    const BlockSettings settings{ ringsOfCells, round, options_.largestBlock,
      [&](const std::array<Index, 4>& cell) { return mayChange(cell); } };
    const OperationBlocks blocks =
      gather(findOperationBlocks(exchange_, state_.mesh, flags, settings, state_.parallelFor));
    ClassifiedBoundary& boundary = boundaryOf(context_, state_);
    const CellLabels labels{ labelsOf(state_.arrays.ofCells, firstCellOfDimension(mesh(), 3),
                               mesh().tetrahedra.size()),
      labelsOf(state_.arrays.ofCells, firstCellOfDimension(mesh(), 2), mesh().triangles.size()) };
    const OperationTask task{ blocks, labels,
      { std::max(options_.minimumQuality, aim), options_.minimumQuality } };
    OperationTrace trace = operateOnBlocks(
      exchange_, state_.mesh, *state_.classification, boundary, task, state_.parallelFor);
    meshHasChanged(state_);
    state_.onBoundary.clear();
    state_.arrays = refineArrays(state_.arrays, trace.cells.parentEdges, trace.cells.firstChildren);
    ArraySelection kept{
      std::vector<vtkIdType>(trace.keptVertices.begin(), trace.keptVertices.end()), {}
    };
    state_.arrays = select(state_.arrays, kept);
    state_.mapping.refine(std::move(trace.cells));
    state_.mapping.convert(std::move(kept));
    operations_ += trace.operations;
    context_.statistics.set("local operations", static_cast<double>(operations_));
    return trace.operations > 0;
  }

  /// Vertices that stopped on the way to the CAD try again.
  void moveOn()
  {
    ClassifiedBoundary& boundary = boundaryOf(context_, state_);
    Classification& classification = *state_.classification;
    Moves moves = movesOntoCAD(mesh(), boundary.projector, classification);
    moveOntoCAD(exchange_, state_.mesh, std::move(moves), classification,
      { boundary.projector, boundary.boundary.onBoundary, false, true });
    meshHasChanged(state_);
  }

  const PipelineContext& context_;
  RankExchange& exchange_;
  MeshState& state_;
  const CellImprovementOptions& options_;
  std::int64_t operations_ = 0;
};

} // namespace

void improveCells(
  const PipelineContext& context, MeshState& state, const CellImprovementOptions& options)
{
  if (state.mesh.mesh().dimension == 3 && state.classification)
  {
    CellImprovement(context, state, options).run();
  }
}

} // namespace cadrefine
