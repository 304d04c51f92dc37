#include "vtkAdaptToCAD.h"

#include "fields/CADArrays.h"
#include "pipeline/Adaptation.h"
#include "pipeline/InputSplit.h"
#include "pipeline/PipelineContext.h"
#include "pipeline/Projection.h"
#include "pipeline/PropertyCheck.h"

#include <cadrefine/base/Error.h>

#include <vtkCellData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointSet.h>
#include <vtkSmartPointer.h>
#include <vtkTable.h>

#include <string>
#include <vector>

using cadrefine::checkProperty;
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

cadrefine::PipelineResult vtkAdaptToCAD::Execute(
  cadrefine::RankExchange& exchange, vtkPointSet* input, const cadrefine::CADModel* model)
{
  this->AbortExecute = 0; // of an earlier run; SetAbortExecute would modify the filter
  checkProperty("RecursionDepth", this->RecursionDepth, 0, 8);
  checkProperty("UniformSteps", this->UniformSteps, 0);
  checkProperty("MaximumSteps", this->MaximumSteps, 0);
  checkProperty("MaximumCells", static_cast<double>(this->MaximumCells), 0);
  checkProperty("TargetError", this->TargetError, 0);
  cadrefine::AdaptationOptions options;
  options.startProjected = this->StartProjected;
  options.projection = cadrefine::makeProjectionOptions(
    this->UseRegion ? this->Region : nullptr, this->MaximumDistance, this->GetFaces());
  options.projection.minimumQuality = this->FindMinimumQuality();
  options.recursionDepth = this->RecursionDepth;
  options.refinement = this->MakeOptions();
  options.refinement.maximumCells = this->MaximumCells;
  options.refinement.onlyIfMarked = true;
  options.uniformSteps = this->UniformSteps;
  options.maximumSteps = this->MaximumSteps;
  options.targetError = this->TargetError;
  options.coarseningFraction = this->FindCoarseningFraction();
  options.quadraticCells = this->QuadraticCells;
  options.boundaryCells = this->GetBoundaryCells();
  options.fieldNeeds = this->FindFieldNeeds();
  const cadrefine::PipelineContext context = this->MakeContext(exchange, *model);

  this->StepStatistics = "{}";
  cadrefine::AdaptationObserver observer;
  observer.isInterrupted = [this] { return this->GetAbortExecute() != 0; };
  if (exchange.any(this->HasObserver(StepEvent) != 0))
  {
    observer.onStep = [&](const cadrefine::AdaptationStep& step)
    {
      this->StepStatistics = step.statistics;
      this->ShowStep(exchange, step.mesh, step.mapping, step.selection, step.table, step.fitReport);
      this->InvokeEvent(StepEvent);
    };
  }
  return cadrefine::adaptMesh(context, input, options, observer);
}

double vtkAdaptToCAD::FindCoarseningFraction() const
{
  checkProperty("CoarseningFraction", this->CoarseningFraction, 0, 1);
  if (this->CoarseningFraction > 0 && !this->FindMinimumQuality())
  {
    throw cadrefine::Error("coarsening (CoarseningFraction) removes vertices, which Operations "
                           "rules out when it is set to Cut only: set Operations to All, or "
                           "CoarseningFraction to 0");
  }
  return this->CoarseningFraction;
}

MarkingCriterion vtkAdaptToCAD::GetOwnCriterion() const
{
  checkProperty("ErrorMarking", this->ErrorMarking, THRESHOLD, AUTOMATIC);
  checkProperty("ErrorThreshold", this->ErrorThreshold, 0);
  const int byDefault = this->ErrorThreshold > 0 ? THRESHOLD : BULK;
  const int strategy = this->ErrorMarking == AUTOMATIC ? byDefault : this->ErrorMarking;
  return MakeCriterion(strategy == OFF ? "" : cadrefine::arrays::error, strategy,
    this->ErrorThreshold, this->ErrorFraction);
}

std::vector<std::string> vtkAdaptToCAD::GetCellArraysRead() const
{
  const std::string indicator = this->GetIndicator().array;
  const bool isUsed = !indicator.empty() && !this->MakeOptions().uniform;
  return isUsed ? std::vector{ indicator } : std::vector<std::string>{};
}

void vtkAdaptToCAD::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "StartProjected: " << this->StartProjected << "\n";
  os << indent << "UseRegion: " << this->UseRegion << "\n";
  os << indent << "Region:";
  for (const double bound : this->Region)
  {
    os << " " << bound;
  }
  os << "\n" << indent << "MaximumDistance: " << this->MaximumDistance << "\n";
  os << indent << "RecursionDepth: " << this->RecursionDepth << "\n";
  os << indent << "UniformSteps: " << this->UniformSteps << "\n";
  os << indent << "MaximumSteps: " << this->MaximumSteps << "\n";
  os << indent << "MaximumCells: " << this->MaximumCells << "\n";
  os << indent << "TargetError: " << this->TargetError << "\n";
  os << indent << "CoarseningFraction: " << this->CoarseningFraction << "\n";
  os << indent << "QuadraticCells: " << this->QuadraticCells << "\n";
  os << indent << "ErrorMarking: " << this->ErrorMarking << "\n";
  os << indent << "ErrorThreshold: " << this->ErrorThreshold << "\n";
  os << indent << "ErrorFraction: " << this->ErrorFraction << "\n";
}
