// Edges at which the boundary of a mesh meets itself.
#pragma once

#include <cadrefine/operations/EditableMesh.h>
#include <cadrefine/operations/Operations.h>
#include <cadrefine/operations/SurfaceRule.h>

namespace cadrefine
{

/// Opens a mesh of tetrahedra where it is pinched: at an edge across a bore that is narrower than
/// the cells, four facets meet, and the cells round it are in two groups, on one side of the bore
/// and on the other, which hold together. Each group gets a middle of its own, which is wanted on
/// the CAD on the group's side. Edges on a CAD edge stay, as bodies may touch there; so do those
/// for which a side has no place. Cells stay valid where the vertices are. The result depends on
/// the order of vertices and cells alone. Work: a look at each edge of a facet; up to five
/// projections for each group.
OperationResult openPinchedEdges(EditableMesh& mesh, const SurfaceRule& rule);

} // namespace cadrefine
