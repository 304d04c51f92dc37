#include "mesh/InputCheck.h"

#include <cadrefine/base/Error.h>
#include <cadrefine/base/PieceLimit.h>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <sstream>
#include <string>

namespace cadrefine
{
namespace
{

std::string nameOf(vtkAbstractArray* array)
{
  return array->GetName() ? array->GetName() : "without a name";
}

void checkLengths(vtkDataSetAttributes* attributes, vtkIdType count, const std::string& what)
{
  for (int a = 0; a < attributes->GetNumberOfArrays(); ++a)
  {
    vtkAbstractArray* array = attributes->GetAbstractArray(a);
    if (array->GetNumberOfTuples() != count)
    {
      std::ostringstream reason;
      reason << "the " << what << " array " << nameOf(array) << " has "
             << array->GetNumberOfTuples() << " values for " << count << ' ' << what << 's';
      throw Error(reason.str());
    }
  }
}

void checkGhosts(vtkCellData* cells)
{
  const char* name = vtkDataSetAttributes::GhostArrayName();
  vtkAbstractArray* ghosts = cells->GetAbstractArray(name);
  if (ghosts &&
      (!vtkUnsignedCharArray::SafeDownCast(ghosts) || ghosts->GetNumberOfComponents() != 1))
  {
    throw Error(std::string("the cell array ") + name +
                ", which marks ghost cells, must be of type unsigned char and have one component");
  }
}

void checkCells(vtkCellArray* cells)
{
  if (cells && !cells->IsValid())
  {
    throw Error("the cell offsets of the mesh do not match its connectivity");
  }
}

void checkCells(vtkPointSet* input)
{
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(input))
  {
    checkCells(grid->GetCells());
    const vtkIdType types =
      grid->GetCellTypesArray() ? grid->GetCellTypesArray()->GetNumberOfValues() : 0;
    if (types < grid->GetNumberOfCells())
    {
      throw Error("the mesh has " + std::to_string(types) + " cell types for " +
                  std::to_string(grid->GetNumberOfCells()) + " cells");
    }
  }
  else if (auto* surface = vtkPolyData::SafeDownCast(input))
  {
    for (vtkCellArray* cells :
      { surface->GetVerts(), surface->GetLines(), surface->GetPolys(), surface->GetStrips() })
    {
      checkCells(cells);
    }
  }
}

} // namespace

void checkInput(vtkPointSet* input)
{
  checkCells(input);
  requireAtMost(static_cast<std::size_t>(input->GetNumberOfPoints()), "points");
  requireAtMost(static_cast<std::size_t>(input->GetNumberOfCells()), "cells");
  checkLengths(input->GetPointData(), input->GetNumberOfPoints(), "point");
  if (input->GetNumberOfCells() > 0)
  {
    checkLengths(input->GetCellData(), input->GetNumberOfCells(), "cell");
    checkGhosts(input->GetCellData());
  }
}

} // namespace cadrefine
