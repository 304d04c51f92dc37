// What Adapt to CAD does with a data set.
#pragma once

#include "ProjectionTask.h"
#include "RefinementStep.h"
#include "StepContext.h"
#include "StepResult.h"

#include <functional>

class vtkPointSet;

namespace cadrefine
{

struct AdaptationOptions
{
  ProjectionOptions projection;
  int recursionDepth = 1; ///< Of the error.
  /// One level a step; `maximumCells` is that of the whole adaptation.
  RefinementOptions refinement;
  int maximumSteps = 0;
  double targetError = 0; ///< Global; 0: none.
};

/// Projects the mesh; then measures the error, marks and refines, until the error, the steps or the
/// cells reach their limit, no cell is marked, or the user interrupts. Collective. Memory: that of
/// a step, and of the mesh before it. `isInterrupted`, whether the user wants no further steps, is
/// asked on every rank between steps; one that does is enough.
///
/// The mesh is that of the last whole step, with its error. The table has a row a step, the first
/// for the mesh after projection, on rank 0: Step, MarkedCells (cells that were marked to make it),
/// and the field data of the mesh by their names. Its field data StopReason says why there was no
/// further step. The other ranks have the columns alone.
StepResult adaptMesh(const StepContext& context, vtkPointSet* input,
  const AdaptationOptions& options, const std::function<bool()>& isInterrupted);

} // namespace cadrefine
