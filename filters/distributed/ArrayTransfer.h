// Carrying a mesh's own arrays over to the mesh made from it.
#pragma once

#include "DistributedRefinement.h"
#include "PointSetConversion.h"

class vtkPointSet;

namespace cadrefine
{

/// Copies the point, cell and field arrays of `input` to `output`, which was made from it by
/// convert and makePointSet; ghost arrays are left out. Sets the global ids, under the names that
/// `input` has for them.
void copyArrays(vtkPointSet* input, const ConvertedMesh& mesh, vtkPointSet* output);

/// Fills the arrays of `fine` from those of `coarse`, which it was refined from: cell arrays are
/// inherited, point arrays interpolated to the middle of the edge. Arrays of whole numbers or other
/// types keep a value that both ends have, and otherwise take that of the end with the smaller
/// global id (tags must not be averaged). Sets the global ids.
void refineArrays(
  vtkPointSet* coarse, const ConvertedMesh& mesh, const RefinementTrace& trace, vtkPointSet* fine);

} // namespace cadrefine
