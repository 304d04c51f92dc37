#include "vtkCADGeometricError.h"

#include "ErrorStep.h"

#include <vtkObjectFactory.h>
#include <vtkPointSet.h>

vtkStandardNewMacro(vtkCADGeometricError);

vtkCADGeometricError::vtkCADGeometricError() : vtkSimplexMeshAlgorithm(true) {}

vtkCADGeometricError::~vtkCADGeometricError() = default;

cadrefine::StepResult vtkCADGeometricError::Execute(
  cadrefine::RankExchange& exchange, vtkPointSet* input, const cadrefine::CADModel* model)
{
  return cadrefine::measureMesh(this->MakeContext(exchange, *model), input, this->RecursionDepth);
}

void vtkCADGeometricError::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "RecursionDepth: " << this->RecursionDepth << "\n";
}
