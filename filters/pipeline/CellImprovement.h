// Local operations where cells are badly shaped, or vertices do not reach the CAD.
#pragma once

#include "pipeline/MeshState.h"

#include <cadrefine/operations/SurfaceRule.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace cadrefine
{

struct CellImprovementOptions
{
  double minimumQuality = 0.1;
  /// Whether a point is in the region: cells with a vertex elsewhere stay. Empty: all points are.
  std::function<bool(const Point3&)> inRegion = {};
  std::int64_t largestBlock = 8192; ///< Largest number of cells of a block.
  SurfaceLimits surface = {};       ///< Which changes of the boundary are allowed.
  bool cutsBadCells = true;         ///< Whether bad cells are cut even if no vertex is off the CAD.
  /// 1 for the ends of edges at which the mesh may be pinched; empty: there are none.
  std::vector<unsigned char> pinched = {};
  /// The ids from here on are those of new vertices; none: no vertex is new.
  std::optional<GlobalId> newVertices = {};
};

/// Opens a mesh of tetrahedra where it is pinched (see openPinchedEdges), and improves it by rounds
/// of operations (see operateOnBlocks) on the cells round vertices that are off the CAD and round
/// cells with a mean ratio below a minimum, each followed by another try to move vertices onto the
/// CAD (see moveOntoCAD), as long as a round leaves at least a tenth less. Tetrahedra that are
/// still bad, and those at vertices that are off, are then bisected, and the rounds begin again, as
/// long as that helps. Last, rounds without collapses improve the cells below 0.3 at new vertices.
/// The mesh must be classified; triangles in space whose CAD has no faces stay as they are. Cells,
/// listed triangles and lines are told apart by their tags (see isTag). Collective. Work: that of
/// qualityOf; where something is found, a look at every cell, and in rounds that of redistribute,
/// findBoundary, improveCells of a block and moveOntoCAD.
void improveMesh(
  const PipelineContext& context, MeshState& state, const CellImprovementOptions& options);

} // namespace cadrefine
