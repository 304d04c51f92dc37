#include "pipeline/ErrorMeasurement.h"

#include "error/DistributedError.h"
#include "fields/CADArrays.h"
#include "pipeline/MeshSummary.h"

#include <cadrefine/base/Error.h>
#include <cadrefine/classification/ClassificationTolerances.h>

#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>

#include <algorithm>

namespace cadrefine
{
namespace
{

/// An error below this part of the cube of the largest chord error is none: a facet that misses the
/// CAD by its chords has a larger volume before it.
constexpr double negligible = 1e-6;

void addErrors(MeshState& state, const MeshError& error)
{
  const auto add = [&](const char* name, const auto& valueOf)
  {
    // Cells of the mesh's own dimension are the last ones.
    const auto count = static_cast<vtkIdType>(state.mesh.mesh().cellCount());
    vtkNew<vtkDoubleArray> array;
    array->SetName(name);
    array->SetNumberOfValues(count);
    array->FillValue(0);
    const auto first = count - static_cast<vtkIdType>(error.ofCells.size());
    std::transform(error.ofCells.begin(), error.ofCells.end(), array->GetPointer(first), valueOf);
    state.arrays.ofCells->AddArray(array);
  };
  add(arrays::error, [](const CellError& cell) { return cell.measure; });
  add(arrays::errorDistance, [](const CellError& cell) { return cell.largest.distance; });
  add(arrays::chordError, [](const CellError& cell) { return cell.largest.chord; });
  add(arrays::normalAngle, [](const CellError& cell) { return cell.largest.angle; });
  state.arrays.ofCells->SetActiveScalars(arrays::error);
  vtkFieldData* ofMesh = state.arrays.ofMesh;
  setFieldValue(ofMesh, arrays::globalError, error.global);
  setFieldValue(ofMesh, arrays::errorDimension, std::int64_t(error.dimension));
  setFieldValue(ofMesh, arrays::largestErrorDistance, error.largest.distance);
  setFieldValue(ofMesh, arrays::largestChordError, error.largest.chord);
  setFieldValue(ofMesh, arrays::largestNormalAngle, error.largest.angle);
}

} // namespace

void measureMesh(const PipelineContext& context, MeshState& state, int recursionDepth,
  const std::vector<std::string>& faces)
{
  if (state.mesh.mesh().dimension == 0)
  {
    throw Error("the mesh has no cells of area or volume; points alone have no geometric error");
  }
  ClassifiedBoundary& boundary = boundaryOf(context, state);
  const Progress::Part part(context.exchange.progress(), 0.2, 1);
  const MeshError error =
    measureError(context.exchange, state.mesh, boundary, *state.classification,
      { recursionDepth, facetsOn(context, state, faces) }, state.cache, state.remembers);
  const double chord = error.largest.chord;
  if (error.dimension == 3 && chord > ClassificationTolerances::tie * context.model.size() &&
      error.global < negligible * chord * chord * chord)
  {
    context.warn("the geometric error is zero but for rounding, though edges of the mesh miss the "
                 "CAD: it is a volume, and plane parts of a surface have none where their border "
                 "is curved; mark cells by ChordTolerance instead");
  }
  recordBalance(context.statistics, "error", error.balance);
  addErrors(state, error);
}

} // namespace cadrefine
