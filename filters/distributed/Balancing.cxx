#include "Balancing.h"

#include <vtkCellArray.h>
#include <vtkIdList.h>
#include <vtkMultiProcessController.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkRedistributeDataSetFilter.h>
#include <vtkUnstructuredGrid.h>

namespace cadrefine
{
namespace
{

void cellCentre(vtkPointSet* input, vtkIdType cell, vtkIdList* points, double centre[3])
{
  input->GetCellPoints(cell, points);
  std::fill(centre, centre + 3, 0.0);
  for (const vtkIdType point : *points)
  {
    double p[3];
    input->GetPoint(point, p);
    for (int k = 0; k < 3; ++k)
    {
      centre[k] += p[k] / static_cast<double>(points->GetNumberOfIds());
    }
  }
}

/// A vertex at each cell's centre for each unit of its weight.
vtkSmartPointer<vtkPolyData> weightedCentres(vtkPointSet* input, const std::vector<int>& weights)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> vertices;
  vtkNew<vtkIdList> cellPoints;
  for (std::size_t c = 0; c < weights.size(); ++c)
  {
    double centre[3];
    cellCentre(input, static_cast<vtkIdType>(c), cellPoints, centre);
    for (int k = 0; k < weights[c]; ++k)
    {
      const vtkIdType point = points->InsertNextPoint(centre);
      vertices->InsertNextCell(1, &point);
    }
  }
  auto centres = vtkSmartPointer<vtkPolyData>::New();
  centres->SetPoints(points);
  centres->SetVerts(vertices);
  return centres;
}

} // namespace

vtkSmartPointer<vtkPointSet> redistribute(
  vtkMultiProcessController* controller, vtkPointSet* input, const std::vector<int>& weights)
{
  vtkNew<vtkRedistributeDataSetFilter> tree;
  tree->SetController(controller);
  tree->SetInputDataObject(weightedCentres(input, weights));
  tree->SetNumberOfPartitions(controller->GetNumberOfProcesses());
  tree->Update();

  vtkNew<vtkRedistributeDataSetFilter> mover;
  mover->SetController(controller);
  mover->SetInputDataObject(input);
  mover->UseExplicitCutsOn();
  mover->ExpandExplicitCutsOn();
  mover->SetExplicitCuts(tree->GetCuts());
  mover->SetNumberOfPartitions(controller->GetNumberOfProcesses());
  mover->SetBoundaryModeToAssignToOneRegion();
  mover->PreservePartitionsInOutputOff();
  mover->Update();
  return vtkPointSet::SafeDownCast(mover->GetOutputDataObject(0));
}

} // namespace cadrefine
