// Better cells round a vertex that halves an edge.
#pragma once

#include <cadrefine/operations/EditableMesh.h>

namespace cadrefine
{

/// After a split: removes edges opposite to the new vertex, which is already where it is to stay,
/// as long as this improves the worst cell at such an edge; first the one whose worst new cell is
/// best. `cavity` becomes that of the split and the removals together; the mesh itself is left as
/// it was. Halving one edge alone makes bad cells between two CAD edges that run beside each other,
/// and around a short edge. Work: the rings of the edges, once for each that is removed.
void swapRoundMiddle(EditableMesh& mesh, Index middle, Cavity& cavity);

} // namespace cadrefine
