#include "vtkRefineWithCAD.h"

#include "RefinementStep.h"

#include <vtkObjectFactory.h>
#include <vtkPointSet.h>

vtkStandardNewMacro(vtkRefineWithCAD);

vtkRefineWithCAD::vtkRefineWithCAD() : vtkRefinementAlgorithm(false) {}

vtkRefineWithCAD::~vtkRefineWithCAD() = default;

cadrefine::StepResult vtkRefineWithCAD::Execute(
  cadrefine::RankExchange& exchange, vtkPointSet* input, const cadrefine::CADModel* model)
{
  cadrefine::RefinementOptions options = this->MakeOptions();
  options.levels = this->Levels;
  options.quadraticCells = this->QuadraticCells;
  return cadrefine::refineMesh(this->MakeContext(exchange, *model), input, options).result;
}

cadrefine::MarkingCriterion vtkRefineWithCAD::GetOwnCriterion() const
{
  return MakeCriterion(this->MarkingArray, this->Marking, this->Threshold, this->Fraction);
}

void vtkRefineWithCAD::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Levels: " << this->Levels << "\n";
  os << indent << "MarkingArray: " << this->MarkingArray << "\n";
  os << indent << "Marking: " << this->Marking << "\n";
  os << indent << "Threshold: " << this->Threshold << "\n";
  os << indent << "Fraction: " << this->Fraction << "\n";
  os << indent << "QuadraticCells: " << this->QuadraticCells << "\n";
}
