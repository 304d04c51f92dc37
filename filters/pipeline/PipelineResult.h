// What the steps of the filters give.
#pragma once

#include "fields/FieldMapping.h"

#include <vtkPointSet.h>
#include <vtkSmartPointer.h>
#include <vtkTable.h>

#include <string>

namespace cadrefine
{

struct PipelineResult
{
  vtkSmartPointer<vtkPointSet> mesh;
  FieldMapping mapping;                 ///< The way of arrays from the input to the mesh.
  vtkSmartPointer<vtkTable> table = {}; ///< The table of a filter that has one.
  std::string fitReport = {};           ///< Text on the fit after a projection (see describeFit).
};

} // namespace cadrefine
