#include "vtkMeshValidity.h"

#include "fields/CADArrays.h"
#include "pipeline/MeshState.h"
#include "pipeline/MeshSummary.h"

#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointSet.h>
#include <vtkSignedCharArray.h>

#include <utility>

vtkStandardNewMacro(vtkMeshValidity);

vtkMeshValidity::vtkMeshValidity() : vtkMeshAlgorithm(false) {}

vtkMeshValidity::~vtkMeshValidity() = default;

cadrefine::PipelineResult vtkMeshValidity::Execute(
  cadrefine::RankExchange& exchange, vtkPointSet* input, const cadrefine::CADModel*)
{
  using namespace cadrefine;
  MeshState state = readMesh(exchange, input, CellOrder::FirstOrSecond);
  exchange.progress().say(0.5, "checking cells");
  const Mesh& mesh = state.mesh.mesh();
  const CellQualities qualities = measureQuality(exchange, state.mesh);
  const auto cells = static_cast<vtkIdType>(mesh.cellCount());

  vtkNew<vtkSignedCharArray> validity;
  validity->SetName(arrays::validity);
  validity->SetNumberOfValues(cells);
  validity->FillValue(1);
  vtkNew<vtkDoubleArray> quality;
  quality->SetName(arrays::quality);
  quality->SetNumberOfValues(cells);
  quality->FillValue(1);
  const vtkIdType first = firstCellOfDimension(mesh, mesh.dimension);
  for (std::size_t c = 0; c < qualities.qualities.size(); ++c)
  {
    validity->SetValue(first + static_cast<vtkIdType>(c), qualities.valid[c]);
    quality->SetValue(first + static_cast<vtkIdType>(c), qualities.qualities[c]);
  }
  state.arrays.ofCells->AddArray(validity);
  state.arrays.ofCells->AddArray(quality);
  const bool isValid = qualities.summary.invalidCells == 0; // over all ranks
  state.arrays.ofCells->SetActiveScalars(isValid ? arrays::quality : arrays::validity);
  summariseMesh(exchange, state.mesh, qualities.summary, state.arrays.ofMesh);
  return resultOf(std::move(state));
}
