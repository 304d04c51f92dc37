#include "RefinementStep.h"

#include "Agreement.h"
#include "Balancing.h"
#include "DistributedRefinement.h"
#include "Error.h"
#include "EvenWork.h"
#include "MeshSummary.h"
#include "MidNodePlacing.h"

#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

namespace cadrefine
{
namespace
{

/// The refinement of one data set, level by level.
class Refiner
{
public:
  Refiner(const StepContext& context, const RefinementOptions& options)
    : context_(context), exchange_(context.exchange), options_(options)
  {
  }

  RefinementOutcome run(vtkPointSet* input)
  {
    checkOutput(input);
    load(input);
    lookForInvalidCells();
    if (options_.levels == 0)
    {
      return { { makeOutput(input), std::move(route_) }, 0, false };
    }
    {
      const Progress::Part part = beginLevel(0);
      makePlan();
      const bool limited = isTooLarge();
      if (limited || (options_.onlyIfMarked && markedCells_ == 0))
      {
        return { {}, markedCells_, limited };
      }
      if (options_.balance && exchange_.size() > 1)
      {
        balanceCells(input);
      }
      refineOnce();
    }
    context_.statistics.set("new cells imbalance after",
      findImbalance(exchange_, static_cast<std::int64_t>(mesh_.mesh().cellCount())));
    for (int level = 1; level < options_.levels; ++level)
    {
      const Progress::Part part = beginLevel(level);
      makePlan();
      refineOnce();
    }
    return { { makeOutput(input), std::move(route_) }, markedCells_, false };
  }

private:
  Progress& progress() const { return exchange_.progress(); }

  /// The part of a level in the progress; the mesh is read before the first one.
  Progress::Part beginLevel(int level) const
  {
    constexpr double reading = 0.1;
    const double length = (1 - reading) / options_.levels;
    const std::string name = options_.levels > 1 ? "level " + std::to_string(level + 1) + " of " +
                                                     std::to_string(options_.levels) + ": "
                                                 : "";
    return { progress(), reading + level * length, reading + (level + 1) * length, name };
  }

  void checkOutput(vtkPointSet* input) const
  {
    if (options_.quadraticCells && vtkPolyData::SafeDownCast(input))
    {
      throw Error("poly data cannot hold quadratic cells; make the mesh an unstructured grid first "
                  "(the filter Append Datasets does), or switch Quadratic Cells off");
    }
  }

  RunStatistics::Stopwatch watch(const char* name) const
  {
    return RunStatistics::Stopwatch(context_.statistics, name);
  }

  void load(vtkPointSet* source)
  {
    progress().say(0, "reading the mesh");
    {
      const auto stopwatch = watch("seconds reading cells");
      mesh_ = makeDistributedMesh(exchange_, source);
      if (mesh_.mesh().dimension == 0)
      {
        throw Error("the mesh has no triangles or tetrahedra to refine");
      }
      arrays_ = readArrays(source, mesh_.converted);
      route_.convert(source, mesh_.converted);
    }
    boundary_.reset();
    const auto stopwatch = watch("seconds projection");
    classified_ = options_.projectNewVertices || exchange_.any(hasClassification(source));
    if (classified_)
    {
      attempt(exchange_,
        [&] { positions_ = readClassification(source, mesh_.converted.pointOf, context_.model); });
    }
  }

  void lookForInvalidCells()
  {
    if (!options_.projectNewVertices)
    {
      return;
    }
    const std::string warning = warningOfInvalidCells(exchange_, mesh_);
    hasInvalidCells_ = !warning.empty();
    if (hasInvalidCells_ && exchange_.rank() == 0)
    {
      context_.warn(warning);
    }
  }

  NewVertices whatBecomesOfNewVertices() const
  {
    if (!options_.projectNewVertices)
    {
      return NewVertices::StayStraight;
    }
    return hasInvalidCells_ ? NewVertices::MoveAndMend : NewVertices::MoveOntoCAD;
  }

  /// Of the mesh as it is.
  const ClassifiedBoundary& boundary()
  {
    if (!boundary_)
    {
      const auto stopwatch = watch("seconds projection");
      boundary_.emplace(findClassifiedBoundary(exchange_, mesh_, context_.model, positions_));
    }
    return *boundary_;
  }

  void makePlan()
  {
    const bool cutFacets = options_.cutFacets && classified_ && !options_.uniform;
    std::optional<FacetsToCut> toCut;
    if (cutFacets)
    {
      toCut.emplace(FacetsToCut{ boundary(), positions_ });
    }
    progress().say(0, "marking cells");
    const auto stopwatch = watch("seconds marking");
    if (options_.uniform)
    {
      plan_ = planUniform(exchange_, mesh_);
      markedCells_ = countMesh(exchange_, mesh_).cells;
      return;
    }
    const auto marks = markCells(exchange_, mesh_, arrays_, options_.criteria);
    markedCells_ = exchange_.sum(std::count(marks.begin(), marks.end(), 1));
    context_.statistics.set("marked cells", static_cast<double>(markedCells_));
    plan_ = planLongestEdge(exchange_, mesh_, marks, toCut ? &*toCut : nullptr);
  }

  /// Cells that the plan makes of each cell, in the order of makePointSet.
  std::vector<std::int64_t> childCounts() const
  {
    std::vector<std::int64_t> counts;
    counts.reserve(mesh_.mesh().cellCount());
    for (const auto& firsts : countChildren(mesh_.mesh(), plan_))
    {
      std::transform(firsts.begin() + 1, firsts.end(), firsts.begin(), std::back_inserter(counts),
        [](Index end, Index first) { return end - first; });
    }
    return counts;
  }

  /// Whether the plan makes more cells of the mesh's own dimension than allowed.
  bool isTooLarge()
  {
    if (options_.maximumCells == 0)
    {
      return false;
    }
    const auto firsts = countChildren(mesh_.mesh(), plan_)[mesh_.mesh().dimension];
    return exchange_.sum(firsts.empty() ? 0 : firsts.back()) > options_.maximumCells;
  }

  /// Puts the cells where the plan makes equal work, if they are not.
  void balanceCells(vtkPointSet* input)
  {
    Redistribution balanced;
    progress().say(0.1, "sharing out the cells over the ranks");
    {
      const auto stopwatch = watch("seconds balancing");
      const auto weights = childCounts();
      context_.statistics.set("new cells imbalance before",
        findImbalance(
          exchange_, std::accumulate(weights.begin(), weights.end(), std::int64_t{ 0 })));
      if (isBalanced(exchange_, mesh_, weights))
      {
        return;
      }
      balanced = redistribute(exchange_, mesh_, input, weights);
    }
    route_ = {}; // cells were sent from the input, not from the mesh
    route_.redistribute(std::move(balanced.delivery));
    load(balanced.mesh);
    makePlan();
  }

  void refineOnce()
  {
    RefinementTrace trace = classified_
                              ? refineOntoCAD(exchange_, mesh_, plan_, boundary(), positions_,
                                  whatBecomesOfNewVertices(), context_.statistics)
                              : refine(exchange_, mesh_, plan_, context_.statistics);
    boundary_.reset();
    projectedPoints_ += trace.projectedPoints;
    const auto stopwatch = watch("seconds copying fields");
    arrays_ = refineArrays(arrays_, trace.parentEdges, trace.firstChildren);
    route_.refine(std::move(trace));
  }

  void makeQuadratic()
  {
    if (classified_)
    {
      projectedPoints_ += placeMidNodes(
        exchange_, mesh_, boundary(), positions_, options_.projectNewVertices, context_.statistics);
    }
    else
    {
      addMidNodes(exchange_, mesh_);
    }
    const auto stopwatch = watch("seconds copying fields");
    const auto& edges = mesh_.converted.midNodes->table.edges;
    arrays_ = withMidNodes(arrays_, edges);
    route_.addMidNodes(edges);
  }

  /// In the class of `prototype`.
  vtkSmartPointer<vtkPointSet> makeOutput(vtkPointSet* prototype)
  {
    if (options_.quadraticCells)
    {
      makeQuadratic();
    }
    vtkSmartPointer<vtkPointSet> output;
    {
      const auto stopwatch = watch("seconds writing cells");
      output = makePointSet(prototype, mesh_.mesh(), mesh_.converted.midNodes);
      setArrays(arrays_, mesh_.converted, output);
    }
    const auto stopwatch = watch("seconds summary");
    if (classified_)
    {
      writeClassification(output, positions_);
      summariseProjection(exchange_, mesh_, positions_, projectedPoints_, output);
    }
    summariseMesh(exchange_, mesh_, summariseQuality(exchange_, mesh_), output);
    return output;
  }

  const StepContext& context_;
  RankExchange& exchange_;
  const RefinementOptions& options_;
  DistributedMesh mesh_;
  MeshArrays arrays_;
  ArrayRoute route_;
  bool classified_ = false;      ///< The mesh knows its places on the CAD.
  bool hasInvalidCells_ = false; ///< Of the input.
  Classification positions_;
  std::optional<ClassifiedBoundary> boundary_;
  RefinementPlan plan_;
  std::int64_t markedCells_ = 0; ///< By the last plan.
  std::int64_t projectedPoints_ = 0;
};

} // namespace

RefinementOutcome refineMesh(
  const StepContext& context, vtkPointSet* input, const RefinementOptions& options)
{
  return Refiner(context, options).run(input);
}

} // namespace cadrefine
