#include "vtkCoarsenWithCAD.h"

#include "fields/CADArrays.h"
#include "pipeline/Coarsening.h"
#include "pipeline/InputSplit.h"
#include "pipeline/PropertyCheck.h"

#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkObjectFactory.h>
#include <vtkPointSet.h>

#include <optional>
#include <utility>
#include <vector>

vtkStandardNewMacro(vtkCoarsenWithCAD);

vtkCoarsenWithCAD::vtkCoarsenWithCAD() : vtkMeshAlgorithm(true) {}

vtkCoarsenWithCAD::~vtkCoarsenWithCAD() = default;

std::vector<std::string> vtkCoarsenWithCAD::GetCellArraysRead() const
{
  const bool isNone = this->MarkingArray.empty() || this->MarkingArray == "None";
  return isNone ? std::vector<std::string>{} : std::vector<std::string>{ this->MarkingArray };
}

cadrefine::PipelineResult vtkCoarsenWithCAD::Execute(
  cadrefine::RankExchange& exchange, vtkPointSet* input, const cadrefine::CADModel* model)
{
  using cadrefine::MarkingCriterion;
  cadrefine::checkProperty("Threshold", this->Threshold);
  cadrefine::checkProperty("TargetError", this->TargetError, 0);
  cadrefine::checkProperty("MaximumDistance", this->MaximumDistance, 0);
  cadrefine::checkProperty("Levels", this->Levels, 0, 20);
  const std::optional<double> minimumQuality = this->FindMinimumQuality();
  const cadrefine::PipelineContext context = this->MakeContext(exchange, *model);
  cadrefine::MeshState state = cadrefine::readMesh(exchange, input);
  state.mapping.require(this->FindFieldNeeds());
  cadrefine::readClassification(context, input, state);
  const cadrefine::Mesh& mesh = state.mesh.mesh();
  const auto isEmpty = [](const auto& cells) { return cells.empty(); };
  if (exchange.any(mesh.hasNonSimplices()) &&
      !exchange.any(!cadrefine::visitOwnSimplices(mesh, isEmpty)))
  {
    throw cadrefine::Error(
      "only triangles and tetrahedra can be coarsened, and the mesh has none; convert its cells "
      "with the filter Triangulate or Tetrahedralize");
  }

  cadrefine::CoarseningOptions options;
  for (const std::string& array : this->GetCellArraysRead())
  {
    options.criteria.push_back({ array, MarkingCriterion::Strategy::AtLeast, this->Threshold });
  }
  options.targetError = this->TargetError;
  options.maximumDistance = this->MaximumDistance;
  options.levels = minimumQuality ? this->Levels : 0;
  options.minimumQuality = minimumQuality.value_or(0);
  if (!minimumQuality)
  {
    context.warn("nothing is coarsened, because Operations is set to Cut only; set it to All");
  }
  cadrefine::coarsenMesh(context, state, options);
  cadrefine::removeMeasured(state.arrays.ofCells, state.arrays.ofMesh);
  return this->MakeResult(context, std::move(state));
}

void vtkCoarsenWithCAD::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "MarkingArray: " << this->MarkingArray << "\n";
  os << indent << "Threshold: " << this->Threshold << "\n";
  os << indent << "TargetError: " << this->TargetError << "\n";
  os << indent << "MaximumDistance: " << this->MaximumDistance << "\n";
  os << indent << "Levels: " << this->Levels << "\n";
}
