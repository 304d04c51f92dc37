// Which edges longest edge bisection cuts.
#pragma once

#include "EdgeTable.h"
#include "SimplexMesh.h"

#include <vector>

namespace cadrefine
{

/// Marks of edges: not 0 where the edge will be cut. (A vector of bytes, so that ranks can exchange
/// entries.)
using EdgeMarks = std::vector<unsigned char>;

/// Longest edge bisection of marked cells until no vertex hangs, as a least fixpoint:
///   1. a marked cell marks its longest edge;
///   2. a cell that has a marked edge marks its longest edge, and so does each of its faces;
///   3. repeat 2 until nothing changes.
/// The rules are monotone and the edges finite, so the fixpoint exists, is unique, and does not
/// depend on the order in which cells are visited or on how they are spread over ranks: over ranks,
/// close locally, exchange the marks of shared edges, and repeat until no rank changes any.
/// Recursive bisection of a cell at the longest of its marked edges (see splitMarked) then gives
/// conforming meshes, since each face is cut in an order that its own edges fix.
///
/// M.-C. Rivara, "Algorithms for refining triangular grids suitable for adaptive and multigrid
/// techniques", Int. J. Numer. Meth. Eng. 20, 1984 (4-triangle partition and its conforming partial
/// versions); A. Plaza, G. F. Carey, "Local refinement of simplicial grids based on the skeleton",
/// Appl. Numer. Math. 32, 2000 (its form in three dimensions).

/// Rule 1 for the cells of the mesh's own dimension; `cellMarks` has one entry for each of them.
void markLongestEdges(const SimplexMesh& mesh, const EdgeTable& table,
  const std::vector<unsigned char>& cellMarks, EdgeMarks& marks);

/// Rules 2 and 3 within this piece. Returns true where an edge was marked. Work: cells times the
/// number of sweeps, at most the length of the longest chain of marks within the piece; of cells
/// without a mark only the marks are looked at.
bool closeMarks(const EdgeTable& table, EdgeMarks& marks);

} // namespace cadrefine
