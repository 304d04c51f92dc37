// What Project onto CAD does with a data set.
#pragma once

#include "ProjectionTask.h"
#include "StepContext.h"
#include "StepResult.h"

class vtkPointSet;

namespace cadrefine
{

/// `region`: xmin xmax ymin ymax zmin zmax, or null: everywhere. Throws Error if it is empty.
ProjectionOptions makeProjectionOptions(const double* region, double maximumDistance);

/// The mesh with its boundary on the CAD (see projectBoundary; points alone: projectPoints), its
/// classification and conflicts as point arrays, counts as field data. Whether cells are to be
/// mended is decided here. Collective.
StepResult projectMesh(const StepContext& context, vtkPointSet* input, ProjectionOptions options);

} // namespace cadrefine
