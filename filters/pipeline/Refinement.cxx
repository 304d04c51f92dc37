#include "pipeline/Refinement.h"

#include "balancing/Balancing.h"
#include "comm/LoadBalancedMap.h"
#include "fields/CADArrays.h"
#include "fields/Densities.h"
#include "mesh/MeshPlane.h"
#include "pipeline/CellImprovement.h"
#include "pipeline/LocalOperations.h"
#include "pipeline/MeshSummary.h"
#include "quadratic/MidNodePlacing.h"
#include "refinement/DistributedRefinement.h"

#include <cadrefine/base/Error.h>

#include <vtkPolyData.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <numeric>
#include <optional>
#include <set>
#include <string>

namespace cadrefine
{
namespace
{

/// For the sake of mid nodes cells are bisected at most `mostRounds` times, and there are at most
/// `largestGrowth` times as many of them, or `fewCells`.
constexpr int mostRounds = 16;
constexpr std::int64_t largestGrowth = 2;
constexpr std::int64_t fewCells = 40000;

/// Which edges a level cuts, and why.
struct Level
{
  RefinementPlan plan;
  std::int64_t markedCells = 0; ///< Number of marked cells, over all ranks.
};

/// The refinement of one mesh, level by level.
class Refiner
{
public:
  Refiner(const PipelineContext& context, const RefinementOptions& options, MeshState& state)
    : context_(context), exchange_(context.exchange), options_(options), state_(state)
  {
  }

  RefinementOutcome run()
  {
    check();
    newVertices_ = whatBecomesOfNewVertices();
    if (options_.minimumQuality)
    {
      findNumberings(exchange_, state_);
    }
    RefinementOutcome outcome;
    for (int l = 0; l < options_.levels && outcome.refined; ++l)
    {
      const Progress::Part part = beginLevel(l);
      Level level = planLevel();
      outcome.markedCells = level.markedCells;
      if (l == 0)
      {
        outcome.limited = isTooLarge(level.plan);
        outcome.refined = !outcome.limited && !(options_.onlyIfMarked && level.markedCells == 0);
      }
      if (l == 0 && outcome.refined && options_.balance && exchange_.size() > 1)
      {
        balanceCells(level);
      }
      if (outcome.refined)
      {
        refineOnce(level.plan);
      }
      if (l == 0 && outcome.refined)
      {
        context_.statistics.set("new cells imbalance after",
          findImbalance(exchange_, static_cast<std::int64_t>(state_.mesh.mesh().cellCount())));
      }
    }
    if (outcome.markedCells == 0 && !outcome.refined)
    {
      outcome.whyNone = reasonOfNoMarks();
    }
    if (outcome.refined)
    {
      finish();
    }
    return outcome;
  }

private:
  Progress& progress() const { return exchange_.progress(); }

  Progress::Part beginLevel(int level) const
  {
    const double length = 1.0 / options_.levels;
    const std::string name = options_.levels > 1 ? "level " + std::to_string(level + 1) + " of " +
                                                     std::to_string(options_.levels) + ": "
                                                 : "";
    return { progress(), level * length, (level + 1) * length, name };
  }

  RunStatistics::Stopwatch watch(const char* name) const
  {
    return RunStatistics::Stopwatch(context_.statistics, name);
  }

  void check() const
  {
    if (state_.mesh.mesh().dimension == 0)
    {
      throw Error("the mesh has no cells of area or volume to refine");
    }
    if (options_.quadraticCells)
    {
      checkForQuadraticCells(state_.prototype);
    }
  }

  NewVertices whatBecomesOfNewVertices()
  {
    if (!options_.projectNewVertices)
    {
      return NewVertices::StayStraight;
    }
    return warnOfInvalidCells(context_, state_) ? NewVertices::MoveAndMend
                                                : NewVertices::MoveOntoCAD;
  }

  ClassifiedBoundary& boundary()
  {
    const auto stopwatch = watch("seconds projection");
    return boundaryOf(context_, state_);
  }

  Level planLevel()
  {
    const bool cutFacets = options_.cutFacets && state_.classification && !options_.uniform;
    std::optional<FacetsToCut> toCut;
    if (cutFacets)
    {
      toCut.emplace(FacetsToCut{ boundary(), *state_.classification });
    }
    progress().say(0, "marking cells");
    const auto stopwatch = watch("seconds marking");
    if (options_.uniform)
    {
      return { planUniform(exchange_, state_.mesh), countMesh(exchange_, state_.mesh).cells };
    }
    const auto marks = marksOfCells();
    const std::int64_t marked = exchange_.sum(std::count(marks.begin(), marks.end(), 1));
    context_.statistics.set("marked cells", static_cast<double>(marked));
    return { planLongestEdge(
               exchange_, state_.mesh, marks, toCut ? &*toCut : nullptr, options_.keepLayers),
      marked };
  }

  /// 1 for cells with a facet whose CAD entity `isWanted`, given those of the facets.
  template<class IsWanted>
  std::vector<unsigned char> cellsAt(
    const std::vector<EntityId>& entities, const IsWanted& isWanted) const
  {
    const Mesh& mesh = state_.mesh.mesh();
    std::vector<unsigned char> cells(state_.mesh.converted.cellIds[mesh.dimension].size(), 0);
    for (std::size_t f = 0; f < entities.size(); ++f)
    {
      if (isWanted(entities[f]))
      {
        cells[state_.boundary->boundary.facets[f].cell] = 1;
      }
    }
    return cells;
  }

  std::vector<unsigned char> marksOfCells()
  {
    auto marks = markCells(exchange_, state_.mesh, state_.arrays, options_.criteria);
    if (options_.faces.empty() || !state_.classification)
    {
      return marks;
    }
    const EntitySelection faces = selectFaces(context_, state_, options_.faces);
    if (!options_.onlyAtFaces && !faces.hasTolerances())
    {
      return marks;
    }
    if (options_.criteria.empty() && faces.hasTolerances())
    {
      std::fill(marks.begin(), marks.end(), 0);
    }
    const std::vector<EntityId> entities = entitiesOfFacets(context_, state_);
    if (options_.onlyAtFaces)
    {
      const auto there = cellsAt(
        entities, [&](EntityId entity) { return faces.contains(context_.model.nurbs(), entity); });
      std::transform(marks.begin(), marks.end(), there.begin(), marks.begin(), std::bit_and<>());
    }
    markByTolerances(faces, entities, marks);
    return marks;
  }

  /// Marks cells whose chord error is larger than the tolerance of a face that they are at.
  void markByTolerances(const EntitySelection& faces, const std::vector<EntityId>& entities,
    std::vector<unsigned char>& marks)
  {
    std::set<double> tolerances(faces.chordTolerances.begin(), faces.chordTolerances.end());
    tolerances.erase(0);
    for (const double tolerance : tolerances)
    {
      const auto there = cellsAt(entities, [&](EntityId entity)
        { return entity && faces.chordTolerances[entity.index] == tolerance; });
      const auto large = markCells(exchange_, state_.mesh, state_.arrays,
        { { arrays::chordError, MarkingCriterion::Strategy::Threshold, tolerance } });
      for (std::size_t c = 0; c < marks.size(); ++c)
      {
        marks[c] |= there[c] & large[c];
      }
    }
  }

  std::string reasonOfNoMarks()
  {
    std::string reason = describeLargest(exchange_, state_.mesh, state_.arrays, options_.criteria);
    const char* separator = reason.empty() ? "" : "; ";
    if (options_.onlyAtFaces)
    {
      reason += std::string(separator) + "only cells at the chosen faces (Faces) count";
    }
    else if (!options_.faces.empty() &&
             selectFaces(context_, state_, options_.faces).hasTolerances())
    {
      reason += std::string(separator) + "no ChordError is above the tolerance of its face (Faces)";
    }
    return reason;
  }

  /// Whether the plan makes more cells of the mesh's own dimension than allowed.
  bool isTooLarge(const RefinementPlan& plan) const
  {
    if (options_.maximumCells == 0)
    {
      return false;
    }
    return countPlanned(plan) > options_.maximumCells;
  }

  /// The cells of the mesh's own dimension that the plan makes, over all ranks.
  std::int64_t countPlanned(const RefinementPlan& plan) const
  {
    const Mesh& mesh = state_.mesh.mesh();
    const auto firsts = countChildren(mesh, plan)[mesh.dimension];
    return exchange_.sum(firsts.empty() ? 0 : firsts.back());
  }

  /// How many cells the plan makes of each cell, in the order of makePointSet.
  std::vector<std::int64_t> childCounts(const RefinementPlan& plan) const
  {
    std::vector<std::int64_t> counts;
    counts.reserve(state_.mesh.mesh().cellCount());
    for (const auto& firsts : countChildren(state_.mesh.mesh(), plan))
    {
      std::transform(firsts.begin() + 1, firsts.end(), firsts.begin(), std::back_inserter(counts),
        [](Index end, Index first) { return end - first; });
    }
    return counts;
  }

  /// Puts the cells where the plan makes equal work, if they are not, and plans anew.
  void balanceCells(Level& level)
  {
    progress().say(0.1, "redistributing cells over the ranks");
    {
      const auto stopwatch = watch("seconds balancing");
      const auto weights = childCounts(level.plan);
      context_.statistics.set("new cells imbalance before",
        findImbalance(
          exchange_, std::accumulate(weights.begin(), weights.end(), std::int64_t{ 0 })));
      if (isBalanced(exchange_, state_.mesh, weights))
      {
        return;
      }
      redistribute(context_, state_, ranksByWeight(exchange_, state_.mesh, weights));
    }
    level = planLevel();
  }

  void refineOnce(RefinementPlan& plan)
  {
    const GlobalId newVertices = state_.mesh.vertexIdBound;
    const bool withOperations = options_.projectNewVertices && options_.minimumQuality;
    plan.withOperations = withOperations;
    if (state_.classification)
    {
      boundary(); // so that its time is that of the projection
    }
    projectedPoints_ += cut(context_, state_, plan, newVertices_);
    if (withOperations)
    {
      const auto stopwatch = watch("seconds local operations");
      CellImprovementOptions improvement{ *options_.minimumQuality };
      improvement.surface.keepsError = options_.keepsError;
      improvement.newVertices = newVertices;
      improveMesh(context_, state_, improvement);
    }
  }

  /// Places mid nodes. Cells that keep them from the CAD are bisected, and all nodes placed anew,
  /// until there are no such cells, or too many cells.
  void placeNodes()
  {
    const bool mayBisect = options_.projectNewVertices && options_.minimumQuality &&
                           !exchange_.any(state_.mesh.mesh().hasNonSimplices());
    std::int64_t mostCells =
      std::max(largestGrowth * countMesh(exchange_, state_.mesh).cells, fewCells);
    if (options_.maximumCells > 0)
    {
      mostCells = std::min(mostCells, options_.maximumCells);
    }
    for (int round = 0;; ++round)
    {
      const GlobalId idBound = state_.mesh.vertexIdBound;
      const PlacedMidNodes placed = placeMidNodes(exchange_, state_.mesh, boundary(),
        *state_.classification, options_.projectNewVertices, context_.statistics);
      auto plan =
        mayBisect && round < mostRounds ? planForNodes(placed.tooCurved, round) : std::nullopt;
      if (!plan || countPlanned(*plan) > mostCells)
      {
        projectedPoints_ += placed.projected;
        return;
      }
      removeMidNodes(state_.mesh, *state_.classification, idBound);
      refineOnce(*plan);
    }
  }

  /// The plan that bisects cells that are too curved; none where there are none. In every third
  /// round the edges are those that get nodes to the CAD soonest, in the others those that keep
  /// cells well shaped and few.
  std::optional<RefinementPlan> planForNodes(const std::vector<unsigned char>& tooCurved, int round)
  {
    if (!exchange_.any(std::count(tooCurved.begin(), tooCurved.end(), 1) > 0))
    {
      return std::nullopt;
    }
    const bool atCAD = round % 3 == 2;
    return planFromEdges(exchange_, state_.mesh,
      edgesOfTooCurved(state_.mesh, *state_.classification, tooCurved, atCAD), options_.keepLayers);
  }

  void makeQuadratic()
  {
    if (state_.classification)
    {
      placeNodes();
    }
    else
    {
      addMidNodes(exchange_, state_.mesh);
    }
    meshHasChanged(state_);
    const auto stopwatch = watch("seconds copying fields");
    const auto& edges = state_.mesh.converted.midNodes->table.edges;
    const std::size_t done = state_.mapping.stageCount();
    state_.mapping.addMidNodes(edges);
    if (!state_.mapping.needs().densities.empty())
    {
      const Mesh& mesh = state_.mesh.mesh();
      state_.mapping.scale(
        densitiesOfCurved(mesh, *state_.mesh.converted.midNodes, planeNormal(exchange_, mesh)));
    }
    followMapping(exchange_, state_, done);
  }

  void finish()
  {
    if (options_.quadraticCells)
    {
      makeQuadratic();
    }
    const auto stopwatch = watch("seconds summary");
    vtkFieldData* ofMesh = state_.arrays.ofMesh;
    if (state_.classification)
    {
      summariseProjection(exchange_, state_.mesh, *state_.classification, projectedPoints_, ofMesh);
    }
    summariseMesh(exchange_, state_.mesh, qualityOf(exchange_, state_), ofMesh);
  }

  const PipelineContext& context_;
  RankExchange& exchange_;
  const RefinementOptions& options_;
  MeshState& state_;
  NewVertices newVertices_ = NewVertices::StayStraight;
  std::int64_t projectedPoints_ = 0;
};

} // namespace

void checkForQuadraticCells(vtkPointSet* data)
{
  if (vtkPolyData::SafeDownCast(data))
  {
    throw Error("poly data cannot hold quadratic cells; convert the mesh to an unstructured grid "
                "first (filter Append Datasets), or turn Quadratic Cells off");
  }
}

RefinementOutcome refineMesh(
  const PipelineContext& context, MeshState& state, const RefinementOptions& options)
{
  return Refiner(context, options, state).run();
}

} // namespace cadrefine
