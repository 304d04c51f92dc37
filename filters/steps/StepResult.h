// What the steps of the filters give.
#pragma once

#include "ArrayRoute.h"

#include <vtkPointSet.h>
#include <vtkSmartPointer.h>
#include <vtkTable.h>

namespace cadrefine
{

struct StepResult
{
  vtkSmartPointer<vtkPointSet> mesh;
  ArrayRoute route;                     ///< From the input to the mesh.
  vtkSmartPointer<vtkTable> table = {}; ///< For a filter that has one.
};

} // namespace cadrefine
