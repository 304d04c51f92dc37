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
  FieldMapping mapping;                 ///< From the input to the mesh.
  vtkSmartPointer<vtkTable> table = {}; ///< For a filter that has one.
  std::string fitReport = {};           ///< Of a projection (see describeFit).
};

} // namespace cadrefine
