#include "vtkCADBoundary.h"

#include "pipeline/BoundaryMesh.h"

#include <vtkObjectFactory.h>
#include <vtkPointSet.h>

#include <utility>

vtkStandardNewMacro(vtkCADBoundary);

vtkCADBoundary::vtkCADBoundary() : vtkMeshAlgorithm(true) {}

vtkCADBoundary::~vtkCADBoundary() = default;

cadrefine::PipelineResult vtkCADBoundary::Execute(
  cadrefine::RankExchange& exchange, vtkPointSet* input, const cadrefine::CADModel* model)
{
  const cadrefine::PipelineContext context = this->MakeContext(exchange, *model);
  cadrefine::MeshState state =
    cadrefine::readMesh(exchange, input, cadrefine::CellOrder::FirstOrSecond);
  cadrefine::readClassification(context, input, state);
  return cadrefine::resultOf(cadrefine::boundaryMesh(context, std::move(state), this->GetFaces()));
}
