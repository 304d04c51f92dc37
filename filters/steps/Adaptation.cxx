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
    const AdaptationObserver& observer)
    : context_(context), options_(options), observer_(observer)
  {
  }

  StepResult run(vtkPointSet* input)
  {
    observer_.progress(0);
    setMesh(projectMesh(context_, input, options_.projection), 0);
    std::string reason = reasonToStop();
    while (reason.empty())
    {
      observer_.progress(steps_ + 1);
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
  /// Takes the mesh of the next step, and measures it.
  void setMesh(StepResult step, std::int64_t markedCells)
  {
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
    return context_.exchange.any(observer_.isInterrupted()) ? "interrupted" : "";
  }

  /// Makes a step, or says why not.
  std::string refine()
  {
    RefinementOutcome refined = refineMesh(context_, result_.mesh, options_.refinement);
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
  const AdaptationObserver& observer_;
  StepResult result_;
  ConvergenceTable table_;
  int steps_ = 0;
};

} // namespace

StepResult adaptMesh(const StepContext& context, vtkPointSet* input,
  const AdaptationOptions& options, const AdaptationObserver& observer)
{
  return Adaptation(context, options, observer).run(input);
}

} // namespace cadrefine
