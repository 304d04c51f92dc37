#include "pipeline/Adaptation.h"

#include "fields/CADArrays.h"
#include "pipeline/BoundaryMesh.h"
#include "pipeline/Coarsening.h"
#include "pipeline/ConvergenceTable.h"
#include "pipeline/ErrorMeasurement.h"
#include "pipeline/InputSplit.h"
#include "pipeline/MeshSummary.h"
#include "pipeline/Projection.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkPointData.h>
#include <vtkTable.h>

#include <cstdint>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace cadrefine
{
namespace
{

/// The parts of a step that are timed.
namespace phases
{
constexpr const char* project = "project";
constexpr const char* refine = "refine";
constexpr const char* error = "error";
} // namespace phases

class Adaptation
{
public:
  Adaptation(const PipelineContext& context, const AdaptationOptions& options,
    const AdaptationObserver& observer)
    : context_(context), exchange_(context.exchange), options_(options), observer_(observer)
  {
  }

  PipelineResult run(vtkPointSet* input)
  {
    if (options_.quadraticCells)
    {
      checkForQuadraticCells(input);
    }
    begin(input);
    std::string reason = reasonToStop();
    while (reason.empty())
    {
      reason = makeStep();
      if (reason.empty())
      {
        reason = reasonToStop();
      }
    }
    table_.setStopReason(reason);
    if (options_.quadraticCells && !isInterrupted())
    {
      makeQuadratic();
    }
    return result();
  }

private:
  /// Part of a step's progress at which measuring begins.
  static constexpr double partOfMeasuring = 0.7;

  Progress& progress() const { return exchange_.progress(); }

  bool isInterrupted() const { return exchange_.any(observer_.isInterrupted()); }

  std::int64_t mostSteps() const
  {
    return std::int64_t{ options_.uniformSteps } + options_.maximumSteps;
  }

  bool isUniform() const { return steps_ < options_.uniformSteps || options_.refinement.uniform; }

  /// Begins a step: says its name, and returns its part of the progress.
  Progress::Part beginStep(std::int64_t step, const std::string& name)
  {
    costs_.clear();
    seconds_.clear();
    for (const char* phase : { phases::project, phases::refine, phases::error })
    {
      seconds_.set(phase, 0);
    }
    const double length =
      1.0 / static_cast<double>(1 + mostSteps() + (options_.quadraticCells ? 1 : 0));
    const auto number = static_cast<double>(step);
    progress().say(number * length, name);
    return { progress(), number * length, (number + 1) * length, name + ": " };
  }

  /// Does `work`, a function of the context, as a phase of the step.
  template<class Work>
  void inPhase(const char* name, const Work& work)
  {
    RunStatistics& costs = costs_[name];
    const RunStatistics::Sent before = RunStatistics::sentBy(exchange_);
    {
      const RunStatistics::Stopwatch ofStep(seconds_, name);
      const RunStatistics::Stopwatch ofAll(
        context_.statistics, std::string("seconds ") + name + " phase");
      work(PipelineContext{ exchange_, context_.model, costs, context_.warn });
    }
    context_.statistics.take(costs);
    if (observer_.onStep)
    {
      costs.gather(exchange_, before);
    }
  }

  /// Makes step 0, in which the input is projected or taken as it is.
  void begin(vtkPointSet* input)
  {
    const Progress::Part step = beginStep(0, options_.startProjected ? "Input" : "Projection");
    {
      const Progress::Part part(progress(), 0, partOfMeasuring);
      options_.startProjected ? takeProjected(input) : project(input);
    }
    measure(0);
    tell(options_.startProjected ? "input" : "projection");
  }

  void read(vtkPointSet* input, CellOrder order)
  {
    state_ = readMesh(exchange_, input, order);
    state_.mapping.require(options_.fieldNeeds);
    state_.remembers = true;
  }

  void project(vtkPointSet* input)
  {
    inPhase(phases::project,
      [&](const PipelineContext& context)
      {
        read(input, CellOrder::First);
        fitReport_ = projectMesh(context, state_, options_.projection);
      });
  }

  /// Reads a mesh that is projected already. Cells of second order can only be measured.
  void takeProjected(vtkPointSet* input)
  {
    const bool isMeasuredAlone = mostSteps() == 0 && !options_.quadraticCells;
    read(input, isMeasuredAlone ? CellOrder::FirstOrSecond : CellOrder::First);
    readClassification(context_, input, state_);
    vtkFieldData* ofMesh = state_.arrays.ofMesh;
    summariseMesh(exchange_, state_.mesh, qualityOf(exchange_, state_), ofMesh);
    summariseProjection(exchange_, state_.mesh, *state_.classification, 0, ofMesh);
  }

  /// Measures the mesh that a step has made.
  void measure(std::int64_t markedCells)
  {
    const Progress::Part part(progress(), partOfMeasuring, 1);
    inPhase(phases::error, [&](const PipelineContext& context)
      { measureMesh(context, state_, options_.recursionDepth, options_.projection.faces); });
    if (exchange_.rank() == 0)
    {
      table_.addStep(markedCells, state_.arrays.ofMesh);
    }
  }

  /// Why there must be no further step, before it is known what it would be; empty if it may.
  std::string reasonToStop() const
  {
    const double error = state_.arrays.ofMesh->GetArray(arrays::globalError)->GetComponent(0, 0);
    const bool mayStop = steps_ > options_.uniformSteps || options_.coarseningFraction == 0;
    if (options_.targetError > 0 && error <= options_.targetError && mayStop)
    {
      return "the global geometric error has reached its target (TargetError)";
    }
    if (steps_ == mostSteps())
    {
      return "all steps are done (MaximumSteps)";
    }
    return isInterrupted() ? "interrupted" : "";
  }

  RefinementOutcome refine(const RefinementOptions& options)
  {
    const Progress::Part part(progress(), 0, partOfMeasuring);
    RefinementOutcome outcome;
    inPhase(phases::refine,
      [&](const PipelineContext& context) { outcome = refineMesh(context, state_, options); });
    if (outcome.refined)
    {
      told_ = {};
    }
    return outcome;
  }

  /// The criteria that keep cells from being coarsened, by the values of the mesh as it is.
  std::vector<MarkingCriterion> criteriaToKeep()
  {
    std::vector<MarkingCriterion> criteria;
    for (const MarkingCriterion& criterion : options_.refinement.criteria)
    {
      criteria.push_back(asThreshold(exchange_, state_.mesh, state_.arrays, criterion));
    }
    const EntitySelection faces = selectFaces(context_, state_, options_.refinement.faces);
    std::set<double> tolerances(faces.chordTolerances.begin(), faces.chordTolerances.end());
    tolerances.erase(0);
    if (!tolerances.empty())
    {
      criteria.push_back(
        { arrays::chordError, MarkingCriterion::Strategy::AtLeast, *tolerances.begin() });
    }
    for (MarkingCriterion& criterion : criteria)
    {
      criterion.value *= options_.coarseningFraction;
    }
    return criteria;
  }

  /// Coarsens cells that none of the criteria marks. Returns whether the mesh has changed.
  bool coarsen(std::vector<MarkingCriterion> criteria)
  {
    CoarseningOptions options;
    options.criteria = std::move(criteria);
    options.targetError = options_.targetError;
    options.minimumQuality = *options_.refinement.minimumQuality;
    std::int64_t gone = 0;
    inPhase(phases::refine,
      [&](const PipelineContext& context) { gone = coarsenMesh(context, state_, options); });
    if (gone > 0)
    {
      told_ = {};
    }
    return gone > 0;
  }

  /// Makes a step, or says why not.
  std::string makeStep()
  {
    const Progress::Part step = beginStep(steps_ + 1, "Step " + std::to_string(steps_ + 1));
    const bool uniform = isUniform();
    RefinementOptions options = options_.refinement;
    options.uniform = uniform;
    std::vector<MarkingCriterion> toKeep;
    if (!uniform && options_.coarseningFraction > 0)
    {
      toKeep = criteriaToKeep();
      options.keepsError = options_.targetError > 0;
    }
    const RefinementOutcome outcome = refine(options);
    if (outcome.markedCells > 0 && outcome.limited)
    {
      return "the next step would exceed the number of cells allowed (MaximumCells)";
    }
    const bool coarsened = !toKeep.empty() && coarsen(std::move(toKeep));
    if (outcome.markedCells == 0 && !coarsened)
    {
      return "no cell is marked: " + outcome.whyNone;
    }
    ++steps_;
    measure(outcome.markedCells);
    tell(uniform ? "uniform" : "longest-edge");
    return "";
  }

  /// Makes the step after all others, in which cells become quadratic.
  void makeQuadratic()
  {
    const Progress::Part step = beginStep(1 + mostSteps(), "Quadratic cells");
    RefinementOptions options = options_.refinement;
    options.levels = 0;
    options.quadraticCells = true;
    refine(options);
    measure(0);
    tell("quadratic");
  }

  MeshWithBoundary makeMesh()
  {
    MeshWithBoundary made = options_.boundaryCells ? makeDataSetWithBoundary(context_, state_)
                                                   : MeshWithBoundary{ makeDataSet(state_), {} };
    removeQualities(made.mesh->GetCellData());
    return made;
  }

  /// Tells who wants to know of the step that has been made.
  void tell(const char* kind)
  {
    if (!observer_.onStep)
    {
      return;
    }
    told_ = makeMesh();
    exchange_.agree(""); // so that all ranks have it, or none goes on
    observer_.onStep({ told_.mesh, state_.mapping, told_.selection, table_.table(), fitReport_,
      statisticsOf(kind) });
  }

  /// The statistics of a step, see AdaptationStep.
  std::string statisticsOf(const char* kind)
  {
    std::ostringstream text;
    text << R"({"step": )" << toldSteps_++ << R"(, "kind": ")" << kind << R"(", "seconds": )"
         << seconds_.json() << R"(, "costs": {)";
    const char* separator = "";
    for (const auto& [phase, costs] : costs_)
    {
      text << separator << '"' << phase << "\": " << costs.json();
      separator = ", ";
    }
    text << "}}";
    return text.str();
  }

  PipelineResult result()
  {
    MeshWithBoundary last = told_.mesh ? std::move(told_) : makeMesh();
    state_.mapping.convert(std::move(last.selection));
    return { last.mesh, std::move(state_.mapping), table_.table(), std::move(fitReport_) };
  }

  const PipelineContext& context_;
  RankExchange& exchange_;
  const AdaptationOptions& options_;
  const AdaptationObserver& observer_;
  MeshState state_;
  ConvergenceTable table_;
  std::string fitReport_;
  std::int64_t steps_ = 0;
  std::map<std::string, RunStatistics> costs_; ///< Costs of the step, by phase.
  RunStatistics seconds_;                      ///< Seconds of its phases, on this rank.
  MeshWithBoundary told_;                      ///< The mesh as it is, where it was told of.
  int toldSteps_ = 0;
};

} // namespace

PipelineResult adaptMesh(const PipelineContext& context, vtkPointSet* input,
  const AdaptationOptions& options, const AdaptationObserver& observer)
{
  return Adaptation(context, options, observer).run(input);
}

} // namespace cadrefine
