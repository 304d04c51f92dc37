#include "vtkProjectOntoCAD.h"

#include "fields/CADArrays.h"
#include "pipeline/Projection.h"

#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>

#include <string>
#include <utility>

vtkStandardNewMacro(vtkProjectOntoCAD);

vtkProjectOntoCAD::vtkProjectOntoCAD() : vtkMeshAlgorithm(true) {}

vtkProjectOntoCAD::~vtkProjectOntoCAD() = default;

cadrefine::PipelineResult vtkProjectOntoCAD::Execute(
  cadrefine::RankExchange& exchange, vtkPointSet* input, const cadrefine::CADModel* model)
{
  cadrefine::ProjectionOptions options = cadrefine::makeProjectionOptions(
    this->UseRegion ? this->Region : nullptr, this->MaximumDistance, this->GetFaces());
  options.minimumQuality = this->FindMinimumQuality();
  const cadrefine::PipelineContext context = this->MakeContext(exchange, *model);
  cadrefine::MeshState state = cadrefine::readMesh(exchange, input);
  state.mapping.require(this->FindFieldNeeds());
  std::string report = cadrefine::projectMesh(context, state, options);
  cadrefine::PipelineResult result = this->MakeResult(context, std::move(state));
  result.mesh->GetPointData()->SetActiveScalars(cadrefine::arrays::entity);
  result.fitReport = std::move(report);
  return result;
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
