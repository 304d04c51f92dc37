// What Refine with CAD does with a data set.
#pragma once

#include "Marking.h"
#include "StepContext.h"
#include "StepResult.h"

#include <cstdint>
#include <vector>

class vtkPointSet;

namespace cadrefine
{

struct RefinementOptions
{
  bool uniform = false;                   ///< Cut all edges; else the longest of marked cells.
  int levels = 1;                         ///< 0: the mesh as it is, for quadraticCells.
  std::vector<MarkingCriterion> criteria; ///< None: all cells are marked.
  /// Bisect further until the facets on the CAD of each marked cell are cut.
  bool cutFacets = false;
  bool projectNewVertices = true;
  bool balance = true;
  /// Put out cells of second order (see placeMidNodes); not for vtkPolyData, which has none.
  bool quadraticCells = false;
  bool onlyIfMarked = false; ///< Make no mesh where no cell is marked in the first level.
  /// The first level is not made where it would have more cells of the mesh's own dimension; 0: no
  /// limit.
  std::int64_t maximumCells = 0;
};

struct RefinementOutcome
{
  StepResult result;            ///< No mesh where the first level was not made.
  std::int64_t markedCells = 0; ///< In the last level, over all ranks.
  bool limited = false;         ///< The first level would have had too many cells.
};

/// Refines a mesh (see refine and refineOntoCAD). Collective.
RefinementOutcome refineMesh(
  const StepContext& context, vtkPointSet* input, const RefinementOptions& options);

} // namespace cadrefine
