#include "vtkCADGeometricError.h"

#include "Agreement.h"
#include "ArrayTransfer.h"
#include "DistributedError.h"
#include "MeshSummary.h"

#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointSet.h>

#include <algorithm>

namespace
{

/// Adds a cell array with values for the cells of the mesh's own dimension, the last ones.
void addCellArray(vtkPointSet* output, const char* name, const std::vector<double>& values)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  array->SetNumberOfValues(output->GetNumberOfCells());
  array->FillValue(0);
  const auto first = output->GetNumberOfCells() - static_cast<vtkIdType>(values.size());
  std::copy(values.begin(), values.end(), array->GetPointer(first));
  output->GetCellData()->AddArray(array);
}

} // namespace

vtkStandardNewMacro(vtkCADGeometricError);

vtkCADGeometricError::vtkCADGeometricError() : vtkSimplexMeshAlgorithm(true) {}

vtkCADGeometricError::~vtkCADGeometricError() = default;

void vtkCADGeometricError::Execute(cadrefine::RankExchange& exchange, vtkPointSet* input,
  const cadrefine::CADModel* model, vtkPointSet* output)
{
  using namespace cadrefine;
  DistributedMesh mesh = makeDistributedMesh(exchange, input);
  Classification classification;
  attempt(
    exchange, [&] { classification = readClassification(input, mesh.converted.pointOf, *model); });
  const MeshError error =
    measureError(exchange, mesh, *model, classification, this->RecursionDepth);

  recordBalance(*this->Statistics, "facets", error.balance);

  output->ShallowCopy(makePointSet(input, mesh.mesh()));
  copyArrays(input, mesh.converted, output);
  addCellArray(output, arrays::error, error.ofCells);
  addCellArray(output, arrays::errorDistance, error.distanceOfCells);
  setFieldValue(output, "GlobalGeometricError", error.global);
  setFieldValue(output, "GeometricErrorDimension", std::int64_t(error.dimension));
  setFieldValue(output, "MaximumGeometricDistance", error.maximumDistance);
}

void vtkCADGeometricError::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "RecursionDepth: " << this->RecursionDepth << "\n";
}
