// Moving a vertex inside a mesh to where its worst cell is better.
#pragma once

#include <cadrefine/operations/EditableMesh.h>

namespace cadrefine
{

/// Moves a vertex that is not on the CAD by a few steps of Newton's method (see ShapeEnergy), each
/// halved until the worst of these cells, which are all that are to be at it, gets better and none
/// becomes invalid. Returns the quality of the worst; -2 where one is invalid from the start.
double relocate(EditableMesh& mesh, Index vertex, const Simplices<4>& cells);

} // namespace cadrefine
