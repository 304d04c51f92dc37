// Better cells by local operations.
#pragma once

#include <cadrefine/operations/EditableMesh.h>
#include <cadrefine/operations/ImprovementRule.h>
#include <cadrefine/operations/Operations.h>
#include <cadrefine/operations/SurfaceRule.h>

namespace cadrefine
{

/// Operates on cells below a floor, the worst first. Of the removals of their edges and faces and
/// the moves of their vertices inside the mesh, of triangles also along the CAD, it does the one
/// with the best worst cell; where none gains (see QualityCost; the worst cell must not get worse),
/// of the collapses of their edges; of cells below `minimum` then of the splits of these and of
/// moves of vertices along the CAD, and of splits with swaps (see swapRoundMiddle; of triangles all
/// splits are). Cells where vertices are stay valid, and none of them gets worse than `minimum` and
/// those that it comes from. The boundary changes only as `rule` accepts; null: it does not. It
/// ends when nothing is gained, or after ten passes over the cells that changed. The result depends
/// on the order of vertices and cells alone.
///
/// Work: some 20 microseconds a cell that is tried, and the projections of SurfaceRule for
/// operations on the boundary. (L. Freitag, C. Ollivier-Gooch, 1997.)
OperationResult improveCells(
  EditableMesh& mesh, const SurfaceRule* rule, const ImprovementLimits& limits);

} // namespace cadrefine
