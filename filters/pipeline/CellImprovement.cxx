#include "pipeline/CellImprovement.h"

#include "mesh/MeshPlane.h"
#include "motion/BoundaryMotion.h"
#include "pipeline/LocalOperations.h"
#include "refinement/DistributedRefinement.h"

#include <cadrefine/base/IndicesWhere.h>
#include <cadrefine/base/ParallelFor.h>
#include <cadrefine/mesh/Quality.h>
#include <cadrefine/mesh/VertexFlags.h>
#include <cadrefine/motion/MovesOntoCAD.h>
#include <cadrefine/operations/Improvement.h>
#include <cadrefine/operations/PinchedEdges.h>

#include <vtkCellData.h>
#include <vtkPointData.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cadrefine
{
namespace
{

constexpr int maximumRounds = 6;
constexpr int ringsOfCells = 3;
/// Cells below this are operated on, too: at new vertices, and round cells below the user's limit.
constexpr double aim = 0.3;
/// Cells are cut at most `maximumCuts` times, each time in up to `mostTries` tries if one is not
/// worth it. It is worth up to `newCellsForOne` new cells for each bad one that is gone, or one new
/// cell for each `cellsForOneNew` cells.
constexpr int maximumCuts = 8;
constexpr int mostTries = 4;
constexpr std::int64_t newCellsForOne = 300;
constexpr std::int64_t cellsForOneNew = 4;
/// Where no vertex is off the CAD, there may be up to `largestGrowth` times as many cells, or
/// `fewCells`, and nothing is cut if more than one cell in `cellsForOneBad` is bad.
constexpr std::int64_t largestGrowth = 2;
constexpr std::int64_t fewCells = 5500;
constexpr std::int64_t cellsForOneBad = 3;

class CellImprovement
{
public:
  CellImprovement(
    const PipelineContext& context, MeshState& state, const CellImprovementOptions& options)
    : context_(context), exchange_(context.exchange), state_(state), options_(options),
      projector_(context.model, kindOfBoundary(exchange_, state.mesh, context.model))
  {
  }

  void run()
  {
    if (!exchange_.any(visitOwnSimplices(mesh(), [](const auto& cells) { return !cells.empty(); })))
    {
      return; // other cells do not change
    }
    plane_ = planeNormal(exchange_, mesh(), projector_.kind() == BoundaryKind::Edges);
    if (isSurface(mesh(), plane_) && projector_.kind() == BoundaryKind::Edges)
    {
      return; // the CAD's edges do not tell on which surface they are
    }
    openPinched();
    Left left = operateInRounds(options_.minimumQuality);
    const std::int64_t mostCells = std::max(largestGrowth * left.cells, fewCells);
    for (int cut = 0; cut < maximumCuts && mayCut(left) && cutUntilWorthwhile(left, mostCells);
         ++cut)
    {
    }
    if (options_.newVertices && options_.minimumQuality > 0 && options_.minimumQuality < aim)
    {
      operateInRounds(aim);
    }
  }

private:
  /// What is not yet as it should be, over all ranks.
  struct Left
  {
    std::int64_t verticesOff = 0;
    std::int64_t badCells = 0;
    std::int64_t cells = 0; ///< All simplices of the mesh's own dimension.

    std::int64_t count() const { return verticesOff + badCells; }
    bool operator==(const Left& other) const
    {
      return verticesOff == other.verticesOff && badCells == other.badCells && cells == other.cells;
    }
    /// Whether few cells are bad. Else the minimum is more than the mesh can have: cutting would go
    /// on in all of it.
    bool areFewBad() const { return badCells > 0 && badCells <= cells / cellsForOneBad; }
    /// Whether so much less is left than before that it is worth the new cells.
    bool isWorthwhile(const Left& before, std::int64_t mostCells) const
    {
      return verticesOff < before.verticesOff ||
             (verticesOff == before.verticesOff && badCells < before.badCells &&
               !hasTooManyCells(before, before.badCells - badCells, mostCells));
    }
    /// Whether there are more new cells than it is worth for so many bad cells that are gone.
    bool hasTooManyCells(const Left& before, std::int64_t gone, std::int64_t mostCells) const
    {
      return cells > mostCells ||
             cells - before.cells > std::max(newCellsForOne * gone, before.cells / cellsForOneNew);
    }
  };

  /// A mesh as it was.
  class Backup
  {
  public:
    explicit Backup(const MeshState& state)
      : mesh_(state.mesh), arrays_(state.arrays), classification_(state.classification),
        onBoundary_(state.onBoundary), stages_(state.mapping.stageCount())
    {
      // Lists of their own of the same arrays, as arrays come and go.
      arrays_.ofVertices = vtkSmartPointer<vtkPointData>::New();
      arrays_.ofVertices->ShallowCopy(state.arrays.ofVertices);
      arrays_.ofCells = vtkSmartPointer<vtkCellData>::New();
      arrays_.ofCells->ShallowCopy(state.arrays.ofCells);
    }

    void restore(MeshState& state) const
    {
      meshHasChanged(state);
      state.mesh = mesh_;
      state.arrays = arrays_;
      state.classification = classification_;
      state.onBoundary = onBoundary_;
      state.mapping.forgetAfter(stages_);
    }

  private:
    DistributedMesh mesh_;
    MeshArrays arrays_;
    std::optional<Classification> classification_;
    std::vector<unsigned char> onBoundary_;
    std::size_t stages_;
  };

  /// Does rounds of operations for vertices off the CAD and cells below `least`, as long as each
  /// leaves at least a tenth less, and returns what is left. While vertices are off, one round that
  /// brings nothing may be followed by one that does, as it smooths in the other way.
  Left operateInRounds(double least)
  {
    std::int64_t fewest = std::numeric_limits<std::int64_t>::max();
    int idle = 0;
    for (int round = 0;; ++round)
    {
      const Bad bad = findBad(least);
      const std::int64_t count = bad.left.count();
      idle = count < fewest - fewest / 10 ? 0 : idle + 1;
      fewest = std::min(fewest, count);
      if (count == 0 || idle > (bad.left.verticesOff > 0 ? 1 : 0) || round == maximumRounds)
      {
        return bad.left;
      }
      exchange_.progress().say(static_cast<double>(round) / maximumRounds,
        "improving cells, round " + std::to_string(round + 1) + " of at most " +
          std::to_string(maximumRounds));
      if (!improve(bad.vertices, round, least))
      {
        return bad.left;
      }
      moveOn(round % 2 == 0);
    }
  }

  /// Cuts until so much less is left that it is worth the new cells, and returns true; where that
  /// does not come, false, with the mesh as it was. Where operations take back what is cut, cells
  /// are cut once more before the next ones.
  bool cutUntilWorthwhile(Left& left, std::int64_t mostCells)
  {
    const Backup before(state_);
    Left now = left;
    int cutsAtOnce = 1;
    for (int tries = 0; tries < mostTries && mayCut(now); ++tries)
    {
      for (int cut = 0; cut < cutsAtOnce; ++cut)
      {
        cutBad();
      }
      const Left last = std::exchange(now, operateInRounds(options_.minimumQuality));
      if (now.isWorthwhile(left, mostCells))
      {
        left = now;
        return true;
      }
      if (left.verticesOff == 0 && now.hasTooManyCells(left, left.badCells, mostCells))
      {
        break; // it would not be worth it if no cell were bad
      }
      cutsAtOnce += now == last;
    }
    before.restore(state_);
    return false;
  }

  /// Whether cells may be cut. Beside other cells than simplices these would be cut too.
  bool mayCut(const Left& left)
  {
    return mesh().dimension == 3 && !options_.inRegion &&
           (left.verticesOff > 0 || (options_.cutsBadCells && left.areFewBad())) &&
           !exchange_.any(mesh().hasNonSimplices());
  }

  /// Bisects cells that are badly shaped and those at vertices off the CAD.
  void cutBad()
  {
    exchange_.progress().say(1, "cutting cells that operations do not help");
    const auto& distances = state_.classification->distances;
    const auto& cells = mesh().tetrahedra;
    std::vector<unsigned char> marks(cells.size(), 0);
    for (std::size_t c = 0; c < cells.size(); ++c)
    {
      marks[c] = std::any_of(
        cells[c].begin(), cells[c].end(), [&](Index vertex) { return distances[vertex] > 0; });
    }
    for (const Index cell : badCells(wanted(), options_.minimumQuality))
    {
      marks[cell] = 1;
    }
    RefinementPlan plan = planLongestEdge(exchange_, state_.mesh, marks, nullptr, true);
    plan.withOperations = true;
    cut(context_, state_, plan, NewVertices::MoveOntoCAD);
  }

  Mesh& mesh() { return state_.mesh.mesh(); }

  /// Where the vertices are wanted (see wantedPoints). Collective.
  std::vector<Point3> wanted()
  {
    return wantedPoints(
      exchange_, state_.mesh, projector_, *state_.classification, onBoundaryOf(context_, state_));
  }

  struct Bad
  {
    /// 1: a vertex of a bad cell, or one that is not where it is wanted.
    std::vector<unsigned char> vertices;
    Left left;
  };

  /// Finds vertices off the CAD, and cells below `least` once they are on it. Collective.
  Bad findBad(double least)
  {
    const auto& distances = state_.classification->distances;
    const std::vector<Point3> points = wanted();
    std::vector<unsigned char> flags(points.size(), 0);
    std::int64_t owned = 0;
    for (std::size_t v = 0; v < points.size(); ++v)
    {
      const bool isOff = distances[v] > 0;
      flags[v] = isOff || points[v] != mesh().points[v];
      owned += isOff && state_.mesh.shared.owner(static_cast<Index>(v)) == exchange_.rank();
    }
    const std::vector<Index> cells = badCells(points, least);
    flagVertices(mesh(), cells, flags);
    const auto all = visitOwnSimplices(mesh(),
      [](const auto& cellsOfMesh) { return static_cast<std::int64_t>(cellsOfMesh.size()); });
    const auto counts = exchange_.sum(
      std::vector<std::int64_t>{ owned, static_cast<std::int64_t>(cells.size()), all });
    return { std::move(flags), { counts[0], counts[1], counts[2] } };
  }

  /// Whether a cell's mean ratio is below `least`: for tetrahedra, of which there are most, by the
  /// cubes of both.
  bool isBad(
    const std::array<Index, 4>& cell, const std::vector<Point3>& points, double least) const
  {
    const auto& [a, b, c, d] = cell;
    const double twelfth = squaredEdgeLengths(points[a], points[b], points[c], points[d]) / 12;
    const double volume = sixfoldVolume(points[a], points[b], points[c], points[d]) / 2;
    const double bound = least * twelfth;
    return volume <= 0 || volume * volume < bound * bound * bound;
  }

  bool isBad(
    const std::array<Index, 3>& cell, const std::vector<Point3>& points, double least) const
  {
    const std::vector<Point3>& now = state_.mesh.mesh().points;
    const Vector3 side =
      plane_ != Vector3{} ? plane_ : twofoldAreaVector(now[cell[0]], now[cell[1]], now[cell[2]]);
    return stateAt(shapes::Triangle{}, cornersOf(cell, points), side).quality < least;
  }

  /// Cells below `least`; if that is above the user's limit, those at new vertices.
  std::vector<Index> badCells(const std::vector<Point3>& points, double least) const
  {
    return visitOwnSimplices(state_.mesh.mesh(),
      [&](const auto& cells)
      {
        return indicesWhere(state_.parallelFor, cells.size(),
          [&](std::size_t c)
          {
            return isBad(cells[c], points, least) && mayChange(cells[c]) &&
                   (least <= options_.minimumQuality || isNew(cells[c]));
          });
      });
  }

  template<std::size_t Corners>
  bool isNew(const std::array<Index, Corners>& cell) const
  {
    return std::any_of(cell.begin(), cell.end(),
      [&](Index vertex) { return state_.mesh.mesh().ids[vertex] >= *options_.newVertices; });
  }

  template<std::size_t Corners>
  bool mayChange(const std::array<Index, Corners>& cell) const
  {
    return !options_.inRegion ||
           std::all_of(cell.begin(), cell.end(),
             [&](Index vertex) { return options_.inRegion(state_.mesh.mesh().points[vertex]); });
  }

  /// The limits for a block: where a vertex is on the way to the CAD, those in flat walls beside it
  /// may go. Cells that are not bad are not to lose vertices of theirs.
  ImprovementLimits limitsFor(const EditableMesh& block, double least) const
  {
    ImprovementLimits limits{ std::max(options_.minimumQuality, aim), options_.minimumQuality,
      options_.surface };
    if (least > options_.minimumQuality)
    {
      limits.collapseBelow = options_.minimumQuality;
    }
    for (std::size_t v = 0; v < block.vertexCount(); ++v)
    {
      const EditableMesh::Vertex& vertex = block.vertex(static_cast<Index>(v));
      if (vertex.point != vertex.wanted)
      {
        limits.surface.walls = SurfaceLimits::Walls::LoseVertices;
      }
    }
    return limits;
  }

  void openPinched()
  {
    if (exchange_.any(!options_.pinched.empty()))
    {
      operate(options_.pinched, 0,
        [](BlockMesh& block, const SurfaceRule& rule)
        { return openPinchedEdges(block.mesh(), rule); });
    }
  }

  /// Improves the cells round flagged vertices once, for those below `least`. Returns whether cells
  /// have changed.
  bool improve(const std::vector<unsigned char>& flags, int round, double least)
  {
    return operate(flags, round,
      [&](BlockMesh& block, const SurfaceRule& rule)
      { return improveCells(block.mesh(), &rule, limitsFor(block.mesh(), least)); });
  }

  /// Does a round of operations on the cells round flagged vertices. Returns whether cells have
  /// changed.
  bool operate(const std::vector<unsigned char>& flags, int round, const BlockWork& work)
  {
    const std::int64_t operations = operateOnMesh(context_, state_, flags,
      { ringsOfCells, round, options_.largestBlock,
        [&](Index cell) {
          return visitOwnSimplices(
            mesh(), [&](const auto& cells) { return mayChange(cells[cell]); });
        } },
      work);
    operations_ += operations;
    context_.statistics.set("local operations", static_cast<double>(operations_));
    return operations > 0;
  }

  /// Lets vertices that stopped on the way to the CAD try again. Rounds smooth in turns for the
  /// worst cell and for most cells: where the one leaves vertices, the other may not.
  void moveOn(bool smoothWorst)
  {
    Classification& classification = *state_.classification;
    const auto& distances = classification.distances;
    if (!exchange_.any(std::any_of(
          distances.begin(), distances.end(), [](double distance) { return distance > 0; })))
    {
      return;
    }
    const auto tags = tagsOfCells(exchange_, state_);
    Moves moves = movesOntoCAD(mesh(), projector_, classification);
    const MotionTrace motion = moveOntoCAD(exchange_, state_.mesh, std::move(moves), classification,
      { projector_, onBoundaryOf(context_, state_), tags, false, true, smoothWorst });
    meshHasChanged(state_);
    followMotion(exchange_, state_, motion);
  }

  const PipelineContext& context_;
  RankExchange& exchange_;
  MeshState& state_;
  const CellImprovementOptions& options_;
  Vector3 plane_{}; ///< See planeNormal.
  const BoundaryProjector projector_;
  std::int64_t operations_ = 0;
};

} // namespace

void improveMesh(
  const PipelineContext& context, MeshState& state, const CellImprovementOptions& options)
{
  if (state.mesh.mesh().dimension >= 2 && state.classification)
  {
    CellImprovement(context, state, options).run();
  }
}

} // namespace cadrefine
