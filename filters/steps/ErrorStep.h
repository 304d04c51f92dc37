// What CAD Geometric Error does with a data set.
#pragma once

#include "StepContext.h"
#include "StepResult.h"

class vtkPointSet;

namespace cadrefine
{

/// The projected mesh with its error (see measureError) as cell arrays and field data. Collective.
StepResult measureMesh(const StepContext& context, vtkPointSet* input, int recursionDepth);

} // namespace cadrefine
