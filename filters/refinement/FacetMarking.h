// Marks that cut the facets of cells.
#pragma once

#include "classification/DistributedBoundary.h"

#include <cadrefine/mesh/EdgeTable.h>
#include <cadrefine/refinement/LongestEdgeMarking.h>

#include <vector>

namespace cadrefine
{

/// Marks edges of the marked cells (one entry in `cellMarks` for each cell of the mesh's own
/// dimension), so that their facets on the CAD are cut well:
///   - the longest edge of each facet on the CAD. Where a cell's longest edge is inside the mesh,
///     bisecting it there leaves its facets, and their geometric error, as they were (S. Strunk,
///     KTH 2013, chapter 5);
///   - between two facets that meet where the CAD is smooth, the edge opposite to where they meet.
///     Otherwise some child would have two such facets again, and become as flat as the CAD is
///     between them; the new vertex is inside the mesh, and can move away from the CAD.
/// A facet between two cells (see findBoundaryFacets) counts for the cell that its error is counted
/// in. Work: linear in the facets.
void markFacets(const ClassifiedBoundary& classified, const Classification& classification,
  const EdgeTable& table, const std::vector<unsigned char>& cellMarks, EdgeMarks& marks);

} // namespace cadrefine
