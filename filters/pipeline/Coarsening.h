// What Coarsen With CAD does with a mesh.
#pragma once

#include "pipeline/MeshState.h"
#include "refinement/Marking.h"

#include <cstdint>
#include <vector>

namespace cadrefine
{

struct CoarseningOptions
{
  int levels = 1;
  /// Cells that any of these marks stay as they are.
  std::vector<MarkingCriterion> criteria;
  double targetError = 0;     ///< The global geometric error stays at most this large; 0: not used.
  double maximumDistance = 0; ///< New facets are no farther from the CAD; 0: not used.
  double minimumQuality = 0.1;      ///< The minimum of improveMesh.
  std::int64_t largestBlock = 8192; ///< Largest number of cells of a block.
};

/// Coarsens a classified mesh, level by level: of the vertices none of whose cells is marked, those
/// of verticesToRemove go, by edge collapses (see coarsenCells) in rounds of blocks that lie
/// elsewhere in each (see operateOnMesh), so far as the limits allow; then cells are improved (see
/// improveMesh). Without a target or a distance new facets are no farther from the CAD than those
/// before, and add nothing to the geometric error. With a target and without criteria a level ends
/// when an eighth of the tetrahedra, or a quarter of the triangles, is left; where it cannot get
/// there, more vertices go than verticesToRemove tells. Collective. Returns the number of vertices
/// that went, over all ranks. Work and messages: those of these, and in each round measureError
/// where there is a target.
std::int64_t coarsenMesh(
  const PipelineContext& context, MeshState& state, const CoarseningOptions& options);

} // namespace cadrefine
