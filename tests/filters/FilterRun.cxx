#include "FilterRun.h"

#include "DataSets.h"
#include "MeshChecks.h"

#include <vtkCallbackCommand.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>

#include <algorithm>

namespace cadtest
{
namespace
{

void keepText(vtkObject*, unsigned long, void* texts, void* text)
{
  static_cast<std::vector<std::string>*>(texts)->push_back(static_cast<const char*>(text));
}

/// Keeps what `object` reports by `event` in `texts` instead of printing it.
void observe(vtkObject* object, unsigned long event, std::vector<std::string>& texts)
{
  vtkNew<vtkCallbackCommand> command;
  command->SetCallback(keepText);
  command->SetClientData(&texts);
  object->AddObserver(event, command);
}

} // namespace

Outcome execute(vtkAlgorithm* filter)
{
  Outcome outcome;
  std::vector<std::string> ofExecutive;
  observe(filter, vtkCommand::ErrorEvent, outcome.errors);
  observe(filter, vtkCommand::WarningEvent, outcome.warnings);
  observe(filter->GetExecutive(), vtkCommand::ErrorEvent, ofExecutive);
  outcome.succeeded = filter->GetExecutive()->Update(0) != 0 && ofExecutive.empty();
  outcome.output = filter->GetOutputDataObject(0);
  if (filter->GetNumberOfOutputPorts() > 1)
  {
    outcome.secondOutput = filter->GetOutputDataObject(1);
  }
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
    throw std::runtime_error("the reader failed: " + cadFile +
                             (outcome.errors.empty() ? "" : ": " + outcome.errors.front()));
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

void FilterRun::expectValid(vtkPointSet* input, vtkPointSet* output)
{
  if (!input || !output)
  {
    return;
  }
  const cadrefine::Mesh before = toMesh(input);
  const cadrefine::Mesh after = toMesh(output);
  if (after.dimension == before.dimension && areCellsValid(before))
  {
    EXPECT_TRUE(areCellsValid(after));
  }
}

double FilterRun::qualityPercentile(vtkPointSet* mesh, double part) const
{
  const Data data = run<vtkMeshValidity>(mesh, [](vtkMeshValidity*) {});
  vtkDataArray* array = data->GetCellData()->GetArray("CellQuality");
  std::vector<double> qualities(static_cast<std::size_t>(array->GetNumberOfTuples()));
  for (std::size_t c = 0; c < qualities.size(); ++c)
  {
    qualities[c] = array->GetTuple1(static_cast<vtkIdType>(c));
  }
  const auto place =
    qualities.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(qualities.size()));
  std::nth_element(qualities.begin(), place, qualities.end());
  return *place;
}

FilterRun::Data FilterRun::moveOntoCAD(vtkPointSet* mesh) const
{
  return run<vtkProjectOntoCAD>(
    mesh, [](vtkProjectOntoCAD* filter) { filter->SetOperations(vtkProjectOntoCAD::CUT_ONLY); });
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
