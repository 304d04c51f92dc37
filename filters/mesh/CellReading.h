// Reading the cells of data sets.
#pragma once

#include "mesh/MidNodeReading.h"
#include "mesh/PointSetConversion.h"

#include <cadrefine/base/ParallelFor.h>

class vtkPointSet;

namespace cadrefine
{

/// Sets the mesh's cells and cellOf to those of the data set, with the numbers of the data set's
/// points for vertices; returns the points that they name for mid nodes. Cells that are marked as
/// ghosts or hidden, and empty ones, are left out. No communication. Throws Error for a cell
/// (named) of a type or order that is not taken, that names too few or too many points, or one that
/// is not there.
NodesOfCells readCells(
  vtkPointSet* input, CellOrder order, ConvertedMesh& result, const ParallelFor& parallelFor);

} // namespace cadrefine
