#include "Adaptation.h"

#include "ConvergenceTable.h"
#include "ErrorStep.h"
#include "ProjectionStep.h"

#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkPointSet.h>
#include <vtkTable.h>

#include <string>
#include <utility>

namespace cadrefine
{
namespace
{

class Adaptation
{
public:
  Adaptation(const StepContext& context, const AdaptationOptions& options,
    const std::function<bool()>& isInterrupted)
    : context_(context), options_(options), isInterrupted_(isInterrupted)
  {
  }

  StepResult run(vtkPointSet* input)
  {
    {
      const Progress::Part step = beginStep(0, "Projection");
      setMesh(project(input), 0);
    }
    std::string reason = reasonToStop();
    while (reason.empty())
    {
      const Progress::Part step = beginStep(steps_ + 1, "Step " + std::to_string(steps_ + 1));
      reason = refine();
      if (reason.empty())
      {
        reason = reasonToStop();
      }
    }
    table_.setStopReason(reason);
    result_.table = table_.table();
    return std::move(result_);
  }

private:
  static constexpr double partOfMeasuring = 0.7; ///< Of a step, where it begins.

  Progress& progress() const { return context_.exchange.progress(); }

  /// Says its name; the part of it in the progress.
  Progress::Part beginStep(int step, const std::string& name) const
  {
    const double length = 1.0 / (1 + options_.maximumSteps);
    progress().say(step * length, name);
    return { progress(), step * length, (step + 1) * length, name + ": " };
  }

  StepResult project(vtkPointSet* input) const
  {
    const Progress::Part part(progress(), 0, partOfMeasuring);
    return projectMesh(context_, input, options_.projection);
  }

  /// Takes the mesh of the next step, and measures it.
  void setMesh(StepResult step, std::int64_t markedCells)
  {
    const Progress::Part part(progress(), partOfMeasuring, 1);
    StepResult measured = measureMesh(context_, step.mesh, options_.recursionDepth);
    result_.mesh = measured.mesh;
    result_.route.append(std::move(step.route));
    result_.route.append(std::move(measured.route));
    if (context_.exchange.rank() == 0)
    {
      table_.addStep(markedCells, result_.mesh);
    }
  }

  /// Why there must be no further step, before it is known what it would be; empty if it may.
  std::string reasonToStop() const
  {
    const double error =
      result_.mesh->GetFieldData()->GetArray("GlobalGeometricError")->GetComponent(0, 0);
    if (options_.targetError > 0 && error <= options_.targetError)
    {
      return "the global geometric error has reached its target (TargetError)";
    }
    if (steps_ == options_.maximumSteps)
    {
      return "all steps are done (MaximumSteps)";
    }
    return context_.exchange.any(isInterrupted_()) ? "interrupted" : "";
  }

  RefinementOutcome refineNext() const
  {
    const Progress::Part part(progress(), 0, partOfMeasuring);
    return refineMesh(context_, result_.mesh, options_.refinement);
  }

  /// Makes a step, or says why not.
  std::string refine()
  {
    RefinementOutcome refined = refineNext();
    if (refined.markedCells == 0)
    {
      return "no cell is marked";
    }
    if (refined.limited)
    {
      return "there would be more cells than allowed (MaximumCells)";
    }
    ++steps_;
    setMesh(std::move(refined.result), refined.markedCells);
    return "";
  }

  const StepContext& context_;
  const AdaptationOptions& options_;
  const std::function<bool()>& isInterrupted_;
  StepResult result_;
  ConvergenceTable table_;
  int steps_ = 0;
};

} // namespace

StepResult adaptMesh(const StepContext& context, vtkPointSet* input,
  const AdaptationOptions& options, const std::function<bool()>& isInterrupted)
{
  return Adaptation(context, options, isInterrupted).run(input);
}

} // namespace cadrefine
