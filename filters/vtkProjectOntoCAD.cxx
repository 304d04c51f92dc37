#include "vtkProjectOntoCAD.h"

#include "ProjectionStep.h"

#include <vtkObjectFactory.h>
#include <vtkPointSet.h>

vtkStandardNewMacro(vtkProjectOntoCAD);

vtkProjectOntoCAD::vtkProjectOntoCAD() : vtkSimplexMeshAlgorithm(true) {}

vtkProjectOntoCAD::~vtkProjectOntoCAD() = default;

cadrefine::StepResult vtkProjectOntoCAD::Execute(
  cadrefine::RankExchange& exchange, vtkPointSet* input, const cadrefine::CADModel* model)
{
  return cadrefine::projectMesh(this->MakeContext(exchange, *model), input,
    cadrefine::makeProjectionOptions(
      this->UseRegion ? this->Region : nullptr, this->MaximumDistance));
}

void vtkProjectOntoCAD::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "UseRegion: " << this->UseRegion << "\n";
  os << indent << "Region:";
  for (const double bound : this->Region)
  {
    os << " " << bound;
  }
  os << "\n" << indent << "MaximumDistance: " << this->MaximumDistance << "\n";
}
