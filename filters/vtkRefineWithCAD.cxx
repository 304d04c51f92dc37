#include "vtkRefineWithCAD.h"

#include "fields/CADArrays.h"
#include "pipeline/InputSplit.h"
#include "pipeline/PropertyCheck.h"
#include "pipeline/Refinement.h"

#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkObjectFactory.h>
#include <vtkPointSet.h>

#include <utility>

vtkStandardNewMacro(vtkRefineWithCAD);

vtkRefineWithCAD::vtkRefineWithCAD() : vtkRefinementAlgorithm(false) {}

vtkRefineWithCAD::~vtkRefineWithCAD() = default;

cadrefine::PipelineResult vtkRefineWithCAD::Execute(
  cadrefine::RankExchange& exchange, vtkPointSet* input, const cadrefine::CADModel* model)
{
  cadrefine::checkProperty("Levels", this->Levels, 0, 20);
  cadrefine::RefinementOptions options = this->MakeOptions();
  options.levels = this->Levels;
  options.onlyAtFaces = !this->GetFaces().empty();
  options.quadraticCells = this->QuadraticCells;
  const cadrefine::PipelineContext context = this->MakeContext(exchange, *model);
  cadrefine::MeshState state;
  {
    const cadrefine::RunStatistics::Stopwatch stopwatch(*this->Statistics, "seconds reading cells");
    state = cadrefine::readMesh(exchange, input);
    state.mapping.require(this->FindFieldNeeds());
  }
  if (options.projectNewVertices || this->GetBoundaryCells() ||
      exchange.any(cadrefine::hasClassification(input)))
  {
    cadrefine::readClassification(context, input, state);
  }
  cadrefine::refineMesh(context, state, options);
  cadrefine::removeMeasured(state.arrays.ofCells, state.arrays.ofMesh);
  const cadrefine::RunStatistics::Stopwatch stopwatch(*this->Statistics, "seconds writing cells");
  return this->MakeResult(context, std::move(state));
}

cadrefine::MarkingCriterion vtkRefineWithCAD::GetOwnCriterion() const
{
  cadrefine::checkProperty("Marking", this->Marking, THRESHOLD, BULK);
  cadrefine::checkProperty("Threshold", this->Threshold);
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
