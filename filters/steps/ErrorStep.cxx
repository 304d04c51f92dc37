#include "ErrorStep.h"

#include "Agreement.h"
#include "ArrayTransfer.h"
#include "DistributedError.h"
#include "MeshSummary.h"

#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPointSet.h>

#include <algorithm>

namespace cadrefine
{
namespace
{

/// Adds a cell array with a value of each cell of the mesh's own dimension, the last ones.
template<class ValueOf>
void addCellArray(vtkPointSet* output, const char* name, const std::vector<CellError>& cells,
  const ValueOf& valueOf)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  array->SetNumberOfValues(output->GetNumberOfCells());
  array->FillValue(0);
  const auto first = output->GetNumberOfCells() - static_cast<vtkIdType>(cells.size());
  std::transform(cells.begin(), cells.end(), array->GetPointer(first), valueOf);
  output->GetCellData()->AddArray(array);
}

void addErrors(vtkPointSet* output, const MeshError& error)
{
  const auto add = [&](const char* name, const auto& valueOf)
  { addCellArray(output, name, error.ofCells, valueOf); };
  add(arrays::error, [](const CellError& cell) { return cell.measure; });
  add(arrays::errorDistance, [](const CellError& cell) { return cell.largest.distance; });
  add(arrays::chordError, [](const CellError& cell) { return cell.largest.chord; });
  add(arrays::normalAngle, [](const CellError& cell) { return cell.largest.angle; });
  output->GetCellData()->SetActiveScalars(arrays::error);
  setFieldValue(output, "GlobalGeometricError", error.global);
  setFieldValue(output, "GeometricErrorDimension", std::int64_t(error.dimension));
  setFieldValue(output, "MaximumGeometricDistance", error.largest.distance);
  setFieldValue(output, "MaximumChordError", error.largest.chord);
  setFieldValue(output, "MaximumNormalAngle", error.largest.angle);
}

} // namespace

StepResult measureMesh(const StepContext& context, vtkPointSet* input, int recursionDepth)
{
  context.exchange.progress().say(0, "reading the mesh");
  DistributedMesh mesh = makeDistributedMesh(context.exchange, input, CellOrder::FirstOrSecond);
  Classification classification;
  attempt(context.exchange,
    [&] { classification = readClassification(input, mesh.converted.pointOf, context.model); });
  const Progress::Part part(context.exchange.progress(), 0.2, 1);
  const MeshError error =
    measureError(context.exchange, mesh, context.model, classification, recursionDepth);

  recordBalance(context.statistics, "facets", error.balance);

  StepResult result;
  result.mesh = makePointSet(input, mesh.mesh(), mesh.converted.midNodes);
  result.route.convert(input, mesh.converted);
  copyArrays(input, mesh.converted, result.mesh);
  addErrors(result.mesh, error);
  return result;
}

} // namespace cadrefine
