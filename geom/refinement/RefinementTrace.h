// How the cells and vertices of a refined mesh come from those before.
#pragma once

#include <cadrefine/base/WeightedRows.h>
#include <cadrefine/refinement/Split.h>

#include <array>
#include <cstdint>
#include <vector>

namespace cadrefine
{

/// What refinement made of a mesh, beside the mesh: how to carry arrays over.
struct RefinementTrace
{
  std::vector<std::array<Index, 2>> parentEdges; ///< See SplitMesh.
  ChildRanges firstChildren;
  std::int64_t projectedPoints = 0; ///< Over all ranks.
  /// 1 for vertices on the boundary, of a mesh that is classified.
  std::vector<unsigned char> onBoundary = {};
  /// Of vertices whose values are neither what they were nor the means of the ends of their edges.
  WeightedRows ofVertices = {};
  /// Of cells that do not inherit, for values and for densities, by the places of the cells before
  /// and after, those of each dimension after those of lower ones.
  WeightedRows ofCells = {};
  WeightedRows ofDensities = {};
};

} // namespace cadrefine
