#include "pipeline/PropertyCheck.h"

#include "fields/CADArrays.h"

#include <cadrefine/base/Error.h>

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkPointSet.h>

#include <cmath>
#include <sstream>
#include <string>

namespace cadrefine
{
namespace
{

std::string rangeOf(double lowest, double highest)
{
  std::ostringstream text;
  text << "a finite number";
  if (std::isfinite(lowest))
  {
    text << (std::isfinite(highest) ? " from " : " of ") << lowest;
    std::isfinite(highest) ? text << " to " << highest : text << " or more";
  }
  return text.str();
}

/// The names of the cells' arrays of numbers, or "none".
std::string numericArraysOf(vtkCellData* cells)
{
  std::string names;
  for (int a = 0; a < cells->GetNumberOfArrays(); ++a)
  {
    vtkDataArray* array = cells->GetArray(a);
    if (array && array->GetName())
    {
      names += (names.empty() ? "" : ", ") + std::string(array->GetName());
    }
  }
  return names.empty() ? "none" : names;
}

} // namespace

void checkProperty(const char* name, double value, double lowest, double highest)
{
  if (!std::isfinite(value) || value < lowest || value > highest)
  {
    std::ostringstream reason;
    reason << "the property " << name << " is " << value << ", which is not "
           << rangeOf(lowest, highest);
    throw Error(reason.str());
  }
}

void checkCellArrays(vtkPointSet* mesh, const std::vector<std::string>& names)
{
  vtkCellData* cells = mesh->GetCellData();
  for (const std::string& name : names)
  {
    if (mesh->GetNumberOfCells() > 0 && !cells->GetArray(name.c_str()))
    {
      const bool isError =
        isMeasured(name.c_str()) && name != arrays::validity && name != arrays::quality;
      throw Error((isError ? "the mesh has no cell array " + name +
                               "; compute it first with CAD Geometric Error"
                           : "the mesh has no numeric cell array " + name + " to mark cells by") +
                  "; numeric cell arrays in the mesh: " + numericArraysOf(cells));
    }
  }
}

void checkConservedArrays(vtkPointSet* mesh, const std::vector<std::string>& names)
{
  vtkCellData* cells = mesh->GetCellData();
  for (const std::string& name : names)
  {
    vtkDataArray* array = cells->GetArray(name.c_str());
    const int type = array ? array->GetDataType() : VTK_VOID;
    if (mesh->GetNumberOfCells() > 0 && type != VTK_DOUBLE && type != VTK_FLOAT)
    {
      throw Error((array ? "the cell array " + name + " holds integers, not floating-point numbers"
                         : "the mesh has no numeric cell array " + name) +
                  ", so its integral cannot be conserved (ConservedArrays); numeric cell arrays in "
                  "the mesh: " +
                  numericArraysOf(cells));
    }
  }
}

void checkBox(const char* name, const double* bounds)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const double* ends = bounds + 2 * axis;
    checkProperty(name, ends[0]);
    checkProperty(name, ends[1]);
    if (ends[0] > ends[1])
    {
      std::ostringstream reason;
      reason << "the region is empty (" << name << "): its lower bound in "
             << "xyz"[axis] << ", " << ends[0] << ", is above its upper one, " << ends[1];
      throw Error(reason.str());
    }
  }
}

} // namespace cadrefine
