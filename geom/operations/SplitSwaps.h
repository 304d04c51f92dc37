// Better cells round a vertex that halves an edge.
#pragma once

#include <cadrefine/operations/EditableMesh.h>

namespace cadrefine
{

/// Removes edges opposite to the vertex of a split, which is where it is to be, as long as the
/// worst of the cells at such an edge gets better, the one that gains most first; the cavity of the
/// split becomes that of all together. Between two CAD edges that run beside each other, and round
/// a short edge, halving one edge alone makes worse cells. The mesh is then as it was. Work: the
/// rings of the edges, once for each that is removed.
void swapRoundMiddle(EditableMesh& mesh, Index middle, Cavity& cavity);

} // namespace cadrefine
