#include "vtkMeshValidity.h"

#include "ArrayTransfer.h"
#include "MeshSummary.h"
#include "StepResult.h"

#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointSet.h>
#include <vtkSignedCharArray.h>

vtkStandardNewMacro(vtkMeshValidity);

vtkMeshValidity::vtkMeshValidity() : vtkSimplexMeshAlgorithm(false) {}

vtkMeshValidity::~vtkMeshValidity() = default;

cadrefine::StepResult vtkMeshValidity::Execute(
  cadrefine::RankExchange& exchange, vtkPointSet* input, const cadrefine::CADModel*)
{
  using namespace cadrefine;
  exchange.progress().say(0, "reading the mesh");
  const DistributedMesh mesh = makeDistributedMesh(exchange, input, CellOrder::FirstOrSecond);
  exchange.progress().say(0.5, "looking at cells");
  const CellQualities qualities = measureQuality(exchange, mesh);
  StepResult result;
  result.mesh = makePointSet(input, mesh.mesh(), mesh.converted.midNodes);
  result.route.convert(input, mesh.converted);
  vtkPointSet* output = result.mesh;
  copyArrays(input, mesh.converted, output);

  vtkNew<vtkSignedCharArray> validity;
  validity->SetName("CellValidity");
  validity->SetNumberOfValues(output->GetNumberOfCells());
  validity->FillValue(1);
  vtkNew<vtkDoubleArray> quality;
  quality->SetName("CellQuality");
  quality->SetNumberOfValues(output->GetNumberOfCells());
  quality->FillValue(1);
  const vtkIdType first = firstCellOfDimension(mesh.mesh(), mesh.mesh().dimension);
  for (std::size_t c = 0; c < qualities.meanRatios.size(); ++c)
  {
    validity->SetValue(first + static_cast<vtkIdType>(c), qualities.valid[c]);
    quality->SetValue(first + static_cast<vtkIdType>(c), qualities.meanRatios[c]);
  }
  output->GetCellData()->AddArray(validity);
  output->GetCellData()->AddArray(quality);
  const bool isValid = qualities.summary.invalidCells == 0; // over all ranks
  output->GetCellData()->SetActiveScalars(isValid ? "CellQuality" : "CellValidity");
  summariseMesh(exchange, mesh, qualities.summary, output);
  return result;
}
