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
  /// Two vertices that each new one lies between, as in SplitMesh.
  std::vector<std::array<Index, 2>> parentEdges;
  ChildRanges firstChildren;
  ChildNumbers children = {};
  std::int64_t projectedPoints = 0; ///< New vertices placed on the CAD, over all ranks.
  /// For a classified mesh: 1 for each vertex on the boundary.
  std::vector<unsigned char> onBoundary = {};
  /// Rows for vertices whose values are neither what they were nor the means of the ends of their
  /// edges.
  WeightedRows ofVertices = {};
  /// Rows for cells that do not inherit their parent's values (`ofCells`) and densities, by the
  /// places of the cells before and after, those of each dimension after those of lower ones.
  WeightedRows ofCells = {};
  WeightedRows ofDensities = {};

  /// Calls visit(parent, child) for all children of cells of one dimension, parent after parent.
  template<class Visit>
  void visitChildren(int dimension, const Visit& visit) const
  {
    const auto& firsts = firstChildren[dimension];
    const auto& numbers = children[dimension];
    for (std::size_t c = 0; c + 1 < firsts.size(); ++c)
    {
      for (Index k = firsts[c]; k < firsts[c + 1]; ++k)
      {
        visit(static_cast<Index>(c), numbers.empty() ? k : numbers[k]);
      }
    }
  }
};

} // namespace cadrefine
