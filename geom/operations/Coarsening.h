// Vertices taken out of a mesh by edge collapses.
#pragma once

#include <cadrefine/operations/EditableMesh.h>
#include <cadrefine/operations/Operations.h>
#include <cadrefine/operations/SurfaceRule.h>

#include <vector>

namespace cadrefine
{

/// What coarsening keeps to.
struct CoarseningLimits
{
  double minimumQuality = 0.1; ///< Mean ratio; no cell gets below this and those it comes from.
  /// Of the middles of edges and centroids of new facets from the CAD. Less than those before have
  /// does no harm.
  double distance = 0;
  /// What the sum of the geometric errors of facets on the CAD may gain for each facet that is
  /// there at first; infinite: not looked at.
  double errorPerFacet = 0;
};

/// Collapses the vertices with flag 1 (`goes`, one for each vertex) into neighbours with flag 0;
/// then improves badly shaped cells (see improveCells), and tries those that are left again. Those
/// inside the mesh first, then those on facets and on CAD edges, in the order of their numbers;
/// each into the neighbour that leaves the best worst cell, if all cells are valid and the limits
/// are kept. What finds no neighbour is tried again when its surroundings have changed. A vertex on
/// a CAD edge goes along that, one on a CAD face along the surface. The result depends on the order
/// of vertices and cells alone.
///
/// Work: for each vertex, and each neighbour that it may go to, its cells; for vertices on the CAD
/// the projections of SurfaceRule; and that of improveCells.
OperationResult coarsenCells(EditableMesh& mesh, const SurfaceRule& rule,
  const std::vector<unsigned char>& goes, const CoarseningLimits& limits);

} // namespace cadrefine
