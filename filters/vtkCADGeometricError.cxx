#include "vtkCADGeometricError.h"

#include "pipeline/ErrorMeasurement.h"
#include "pipeline/PropertyCheck.h"

#include <vtkObjectFactory.h>
#include <vtkPointSet.h>

#include <utility>

vtkStandardNewMacro(vtkCADGeometricError);

vtkCADGeometricError::vtkCADGeometricError() : vtkMeshAlgorithm(true) {}

vtkCADGeometricError::~vtkCADGeometricError() = default;

cadrefine::PipelineResult vtkCADGeometricError::Execute(
  cadrefine::RankExchange& exchange, vtkPointSet* input, const cadrefine::CADModel* model)
{
  cadrefine::checkProperty("RecursionDepth", this->RecursionDepth, 0, 8);
  const cadrefine::PipelineContext context = this->MakeContext(exchange, *model);
  cadrefine::MeshState state =
    cadrefine::readMesh(exchange, input, cadrefine::CellOrder::FirstOrSecond);
  cadrefine::readClassification(context, input, state);
  cadrefine::measureMesh(context, state, this->RecursionDepth, this->GetFaces());
  return this->MakeResult(context, std::move(state));
}

void vtkCADGeometricError::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "RecursionDepth: " << this->RecursionDepth << "\n";
}
