// Better cells by local operations.
#pragma once

#include <cadrefine/operations/EditableMesh.h>
#include <cadrefine/operations/ImprovementRule.h>
#include <cadrefine/operations/Operations.h>
#include <cadrefine/operations/SurfaceRule.h>

namespace cadrefine
{

/// Improves cells below a floor, the worst first. For each cell it does the operation that leaves
/// the best worst cell, first of the removals of its edges and faces and the moves of its vertices
/// inside the mesh (for triangles also along the CAD); if none of these gains (see QualityCost; the
/// worst cell must not get worse), of the collapses of its edges; for a cell below `minimum` then
/// of the splits of its edges and the moves of its vertices along the CAD, and last of splits with
/// swaps (see swapRoundMiddle; for triangles, all splits have these). With the vertices where they
/// are, cells stay valid, and none gets worse than both `minimum` and the cells that it comes from.
/// The boundary changes only as `rule` accepts; null: it does not change. It ends when nothing is
/// gained, or after ten passes over the cells that changed. The result depends on the order of
/// vertices and cells alone.
///
/// Work: some 20 microseconds a cell that is tried, and the projections of SurfaceRule for
/// operations on the boundary. (L. Freitag, C. Ollivier-Gooch, 1997.)
OperationResult improveCells(
  EditableMesh& mesh, const SurfaceRule* rule, const ImprovementLimits& limits);

} // namespace cadrefine
