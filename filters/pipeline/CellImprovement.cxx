#include "pipeline/CellImprovement.h"

#include "mesh/MeshPlane.h"
#include "motion/BoundaryMotion.h"
#include "pipeline/LocalOperations.h"
#include "refinement/DistributedRefinement.h"

#include <cadrefine/base/IndicesWhere.h>
#include <cadrefine/base/ParallelFor.h>
#include <cadrefine/mesh/Quality.h>
#include <cadrefine/motion/MoveGuard.h>
#include <cadrefine/operations/Improvement.h>

#include <algorithm>
#include <limits>
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
    if (mesh().dimension == 2)
    {
      plane_ = planeNormal(exchange_, mesh());
      if (plane_ == Vector3{} &&
          boundaryOf(context_, state_).boundary.kind == BoundaryKind::Segments)
      {
        return; // the CAD's edges do not tell on which surface they are
      }
    }
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
      if (!improve(flags, round))
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

  double qualityOfCell(const std::array<Index, 4>& cell, const std::vector<Point3>& points) const
  {
    const auto& [i, j, k, l] = cell;
    return meanRatio(points[i], points[j], points[k], points[l]);
  }

  double qualityOfCell(const std::array<Index, 3>& cell, const std::vector<Point3>& points) const
  {
    const std::vector<Point3>& now = state_.mesh.mesh().points;
    const Vector3 side =
      plane_ != Vector3{} ? plane_ : twofoldAreaVector(now[cell[0]], now[cell[1]], now[cell[2]]);
    return stateOf(cell, points, side).quality;
  }

  std::vector<Index> badCells(const std::vector<Point3>& points) const
  {
    return visitCells(state_.mesh.mesh(),
      [&](const auto& cells)
      {
        return collect<Index>(state_.parallelFor, cells.size(), fineGrain,
          [&](std::size_t begin, std::size_t end, std::vector<Index>& bad)
          {
            for (std::size_t c = begin; c < end; ++c)
            {
              if (mayChange(cells[c]) && qualityOfCell(cells[c], points) < options_.minimumQuality)
              {
                bad.push_back(static_cast<Index>(c));
              }
            }
          });
      });
  }

  template<std::size_t Corners>
  bool mayChange(const std::array<Index, Corners>& cell) const
  {
    return !options_.inRegion ||
           std::all_of(cell.begin(), cell.end(),
             [&](Index vertex) { return options_.inRegion(state_.mesh.mesh().points[vertex]); });
  }

  /// Returns whether cells have changed.
  bool improve(const std::vector<unsigned char>& flags, int round)
  {
    const ImprovementLimits limits{ std::max(options_.minimumQuality, aim), options_.minimumQuality,
      options_.surface };
    const std::int64_t operations = operate(context_, state_, flags,
      { ringsOfCells, round, options_.largestBlock,
        [&](Index cell)
        { return visitCells(mesh(), [&](const auto& cells) { return mayChange(cells[cell]); }); } },
      [&](BlockMesh& block, const SurfaceRule& rule)
      { return improveCells(block.mesh(), &rule, limits); });
    operations_ += operations;
    context_.statistics.set("local operations", static_cast<double>(operations_));
    return operations > 0;
  }

  /// Vertices that stopped on the way to the CAD try again.
  void moveOn()
  {
    ClassifiedBoundary& boundary = boundaryOf(context_, state_);
    Classification& classification = *state_.classification;
    const std::vector<Point3> before = pointsToKeep(state_);
    Moves moves = movesOntoCAD(mesh(), boundary.projector, classification);
    moveOntoCAD(exchange_, state_.mesh, std::move(moves), classification,
      { boundary.projector, boundary.boundary.onBoundary, false, true });
    meshHasChanged(state_);
    scaleDensities(exchange_, state_, before);
  }

  const PipelineContext& context_;
  RankExchange& exchange_;
  MeshState& state_;
  const CellImprovementOptions& options_;
  Vector3 plane_{}; ///< See planeNormal.
  std::int64_t operations_ = 0;
};

} // namespace

void improveCells(
  const PipelineContext& context, MeshState& state, const CellImprovementOptions& options)
{
  if (state.mesh.mesh().dimension >= 2 && state.classification)
  {
    CellImprovement(context, state, options).run();
  }
}

} // namespace cadrefine
