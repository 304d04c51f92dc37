// Vertices taken out of a mesh by edge collapses.
#pragma once

#include <cadrefine/operations/EditableMesh.h>
#include <cadrefine/operations/Operations.h>
#include <cadrefine/operations/SurfaceRule.h>

#include <optional>
#include <vector>

namespace cadrefine
{

/// Limits that coarsening keeps to.
struct CoarseningLimits
{
  /// Least mean ratio of a new cell, or that of the cells that it comes from, if worse.
  double minimumQuality = 0.1;
  /// Largest distance from the CAD of the centroids of new facets and the middles of their edges;
  /// that of the facets they replace, if larger.
  double distance = 0;
  /// How much the sum of the geometric errors of facets on the CAD may grow, for each such facet
  /// that is there at first; infinite: the error is not looked at.
  double errorPerFacet = 0;
  /// How many cells are to go for each vertex that is to go. Once so many have gone, no more
  /// vertices go; until then, others may go in place of those that cannot. Empty: every vertex goes
  /// that can.
  std::optional<double> cellsPerVertex = {};
};

/// What is to become of a vertex.
enum class VertexFate : unsigned char
{
  Stays,
  MayGo, ///< It may go in place of a neighbour that is to go but cannot.
  Goes
};

/// Collapses the vertices that are to go (`fates`, one for each vertex) into neighbours that are
/// not; where some are left, improves badly shaped cells (see improveCells) and tries these again:
/// now a neighbour that may go can go into them instead, or elsewhere as long as too few vertices
/// have gone. Those inside the mesh come first, then those on facets and on CAD edges, in the order
/// of their numbers; each takes the way that adds least to the geometric error, or else leaves the
/// best worst cell, if all cells are valid and the limits are kept. What finds no way is tried
/// again when its surroundings have changed. A vertex on a CAD edge goes along that, one on a CAD
/// face along the surface. The result depends on the order of vertices and cells alone. `fates`
/// tells afterwards what is still to go.
///
/// Where the error is limited, vertices first go at their share of it, the same for each, then at
/// three times that, then at all that is left: so what would take much does not come before what
/// takes little.
///
/// Work: for each vertex, and each neighbour that it may go to, its cells; for vertices on the CAD
/// the projections of SurfaceRule for each such neighbour; and that of improveCells.
OperationResult coarsenCells(EditableMesh& mesh, const SurfaceRule& rule,
  std::vector<VertexFate>& fates, const CoarseningLimits& limits);

} // namespace cadrefine
