#include "Pipeline.h"

namespace cadtest
{

Pipeline::Pipeline(vtkPointSet* piece, const std::string& cadFile,
  vtkMultiProcessController* controller, const Setup& setup)
{
  series->setMesh(piece);
  cad->SetController(controller);
  cad->SetFileName(cadFile.c_str());
  connect(project, series, controller);
  connect(measure, project, controller);
  connect(refine, measure, controller);
  connect(validity, refine, controller);
  connect(adapt, series, controller);
  refine->SetMarkingArray("GeometricError");
  refine->SetThreshold(0.01);
  refine->SetLevels(2);
  adapt->SetMaximumSteps(2);
  adapt->SetErrorMarking(vtkAdaptToCAD::THRESHOLD);
  adapt->SetErrorThreshold(0.01);
  setup(*this);
}

std::vector<vtkMeshAlgorithm*> Pipeline::filters() const
{
  return { project, measure, refine, validity, adapt };
}

void Pipeline::connect(
  vtkMeshAlgorithm* filter, vtkAlgorithm* before, vtkMultiProcessController* controller)
{
  filter->SetController(controller);
  filter->SetInputConnection(0, before->GetOutputPort());
  if (filter->GetNumberOfInputPorts() > 1)
  {
    filter->SetInputConnection(1, cad->GetOutputPort());
  }
}

} // namespace cadtest
