#include "vtkAdaptToCAD.h"

#include "Adaptation.h"
#include "CADArrays.h"
#include "ProjectionStep.h"

#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointSet.h>
#include <vtkSmartPointer.h>
#include <vtkTable.h>

#include <string>

using cadrefine::MarkingCriterion;

vtkStandardNewMacro(vtkAdaptToCAD);

vtkAdaptToCAD::vtkAdaptToCAD() : vtkRefinementAlgorithm(true)
{
  this->SetNumberOfOutputPorts(2);
}

vtkAdaptToCAD::~vtkAdaptToCAD() = default;

int vtkAdaptToCAD::FillOutputPortInformation(int port, vtkInformation* info)
{
  if (port == 1)
  {
    info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkTable");
    return 1;
  }
  return this->Superclass::FillOutputPortInformation(port, info);
}

int vtkAdaptToCAD::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkPointSet* input = vtkPointSet::GetData(inputs[0]);
  if (!input)
  {
    return 0;
  }
  vtkPointSet* mesh = vtkPointSet::GetData(outputs);
  if (!mesh || !mesh->IsA(input->GetClassName()))
  {
    const auto fresh = vtk::TakeSmartPointer(input->NewInstance());
    outputs->GetInformationObject(0)->Set(vtkDataObject::DATA_OBJECT(), fresh);
  }
  if (!vtkTable::GetData(outputs, 1))
  {
    outputs->GetInformationObject(1)->Set(vtkDataObject::DATA_OBJECT(), vtkNew<vtkTable>());
  }
  return 1;
}

cadrefine::StepResult vtkAdaptToCAD::Execute(
  cadrefine::RankExchange& exchange, vtkPointSet* input, const cadrefine::CADModel* model)
{
  this->AbortExecute = 0; // of an earlier run; SetAbortExecute would modify the filter
  cadrefine::AdaptationOptions options;
  options.projection = cadrefine::makeProjectionOptions(
    this->UseRegion ? this->Region : nullptr, this->MaximumDistance);
  options.recursionDepth = this->RecursionDepth;
  options.refinement = this->MakeOptions();
  options.refinement.maximumCells = this->MaximumCells;
  options.refinement.onlyIfMarked = true;
  options.maximumSteps = this->MaximumSteps;
  options.targetError = this->TargetError;

  return cadrefine::adaptMesh(this->MakeContext(exchange, *model), input, options,
    [this] { return this->GetAbortExecute() != 0; });
}

MarkingCriterion vtkAdaptToCAD::GetOwnCriterion() const
{
  return MakeCriterion(this->ErrorMarking == OFF ? "" : cadrefine::arrays::error,
    this->ErrorMarking, this->ErrorThreshold, this->ErrorFraction);
}

void vtkAdaptToCAD::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "UseRegion: " << this->UseRegion << "\n";
  os << indent << "Region:";
  for (const double bound : this->Region)
  {
    os << " " << bound;
  }
  os << "\n" << indent << "MaximumDistance: " << this->MaximumDistance << "\n";
  os << indent << "RecursionDepth: " << this->RecursionDepth << "\n";
  os << indent << "MaximumSteps: " << this->MaximumSteps << "\n";
  os << indent << "MaximumCells: " << this->MaximumCells << "\n";
  os << indent << "TargetError: " << this->TargetError << "\n";
  os << indent << "ErrorMarking: " << this->ErrorMarking << "\n";
  os << indent << "ErrorThreshold: " << this->ErrorThreshold << "\n";
  os << indent << "ErrorFraction: " << this->ErrorFraction << "\n";
}
