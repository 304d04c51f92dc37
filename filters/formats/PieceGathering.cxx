#include "formats/PieceGathering.h"

#include <cadrefine/base/Error.h>

#include <vtkAppendFilter.h>
#include <vtkDataObject.h>
#include <vtkMultiProcessController.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <vector>

namespace cadrefine
{
namespace
{

vtkSmartPointer<vtkPointSet> withoutGhosts(vtkPointSet* piece)
{
  auto result = vtk::TakeSmartPointer(piece->NewInstance());
  result->ShallowCopy(piece);
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(result))
  {
    grid->RemoveGhostCells();
  }
  else if (auto* surface = vtkPolyData::SafeDownCast(result))
  {
    surface->RemoveGhostCells();
  }
  return result;
}

/// The pieces with cells.
std::vector<vtkPointSet*> filled(const std::vector<vtkSmartPointer<vtkDataObject>>& pieces)
{
  std::vector<vtkPointSet*> result;
  for (const auto& piece : pieces)
  {
    auto* points = vtkPointSet::SafeDownCast(piece);
    if (points && points->GetNumberOfCells() > 0)
    {
      result.push_back(points);
    }
  }
  return result;
}

vtkSmartPointer<vtkUnstructuredGrid> joined(const std::vector<vtkPointSet*>& pieces)
{
  auto result = vtkSmartPointer<vtkUnstructuredGrid>::New();
  if (pieces.empty())
  {
    return result;
  }
  vtkNew<vtkAppendFilter> append;
  append->SetMergePoints(pieces.size() > 1 && !pieces.front()->GetPointData()->GetGlobalIds());
  for (vtkPointSet* piece : pieces)
  {
    append->AddInputData(piece);
  }
  append->Update();
  result->ShallowCopy(append->GetOutput());
  // The same on all ranks that have cells: names of groups among them.
  result->SetFieldData(pieces.front()->GetFieldData());
  return result;
}

} // namespace

vtkSmartPointer<vtkUnstructuredGrid> gatherPieces(
  vtkMultiProcessController* controller, vtkPointSet* piece)
{
  std::vector<vtkSmartPointer<vtkDataObject>> pieces{ withoutGhosts(piece) };
  if (controller && controller->GetNumberOfProcesses() > 1)
  {
    std::vector<vtkSmartPointer<vtkDataObject>> all;
    if (!controller->Gather(pieces.front(), all, 0))
    {
      throw Error("the pieces of the mesh could not be gathered");
    }
    pieces = all;
  }
  const bool here = !controller || controller->GetLocalProcessId() == 0;
  return here ? joined(filled(pieces)) : nullptr;
}

} // namespace cadrefine
