#include "FilterRun.h"

#include <vtkCallbackCommand.h>

namespace cadtest
{
namespace
{

void keepText(vtkObject*, unsigned long, void* errors, void* text)
{
  static_cast<std::vector<std::string>*>(errors)->push_back(static_cast<const char*>(text));
}

/// Keeps the errors of `object` in `errors` instead of printing them.
void observe(vtkObject* object, std::vector<std::string>& errors)
{
  vtkNew<vtkCallbackCommand> command;
  command->SetCallback(keepText);
  command->SetClientData(&errors);
  object->AddObserver(vtkCommand::ErrorEvent, command);
}

} // namespace

Outcome execute(vtkAlgorithm* filter)
{
  Outcome outcome;
  std::vector<std::string> ofExecutive;
  observe(filter, outcome.errors);
  observe(filter->GetExecutive(), ofExecutive);
  outcome.succeeded = filter->GetExecutive()->Update(0) != 0 && ofExecutive.empty();
  outcome.output = filter->GetOutputDataObject(0);
  filter->RemoveAllObservers();
  filter->GetExecutive()->RemoveAllObservers();
  return outcome;
}

FilterRun::FilterRun(const std::string& cadFile, vtkMultiProcessController* controller)
  : controller_(controller)
{
  vtkNew<vtkCADReader> reader;
  reader->SetController(controller);
  reader->SetFileName(cadFile.c_str());
  const Outcome outcome = execute(reader);
  if (!outcome.succeeded)
  {
    throw std::runtime_error("the reader failed: " + cadFile);
  }
  cad_ = outcome.output;
}

FilterRun::FilterRun(vtkDataObject* cad, vtkMultiProcessController* controller)
  : cad_(cad), controller_(controller)
{
}

FilterRun::Data FilterRun::require(const Outcome& outcome)
{
  if (!outcome.succeeded || !outcome.errors.empty())
  {
    throw std::runtime_error(
      "the filter failed" + (outcome.errors.empty() ? "" : ": " + outcome.errors.front()));
  }
  return outcome.pointSet();
}

FilterRun::Data FilterRun::project(vtkPointSet* mesh) const
{
  return run<vtkProjectOntoCAD>(mesh, [](vtkProjectOntoCAD*) {});
}

FilterRun::Data FilterRun::measure(vtkPointSet* mesh, int depth) const
{
  return run<vtkCADGeometricError>(
    mesh, [&](vtkCADGeometricError* filter) { filter->SetRecursionDepth(depth); });
}

FilterRun::Data FilterRun::refineUniformly(vtkPointSet* mesh, int levels) const
{
  return run<vtkRefineWithCAD>(mesh,
    [&](vtkRefineWithCAD* filter)
    {
      filter->SetMethod(vtkRefineWithCAD::UNIFORM_BISECTION);
      filter->SetLevels(levels);
    });
}

FilterRun::Data FilterRun::refineStraight(vtkPointSet* mesh, int levels) const
{
  return run<vtkRefineWithCAD>(mesh,
    [&](vtkRefineWithCAD* filter)
    {
      filter->SetMethod(vtkRefineWithCAD::UNIFORM_BISECTION);
      filter->SetLevels(levels);
      filter->ProjectNewVerticesOff();
    });
}

FilterRun::Data FilterRun::refineWhereErrorExceeds(vtkPointSet* mesh, double threshold) const
{
  return run<vtkRefineWithCAD>(mesh,
    [&](vtkRefineWithCAD* filter)
    {
      filter->SetMarkingArray("GeometricError");
      filter->SetThreshold(threshold);
    });
}

} // namespace cadtest
