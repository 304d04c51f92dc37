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
  ChildNumbers children = {};
  std::int64_t projectedPoints = 0; ///< Over all ranks.
  /// 1 for vertices on the boundary, of a mesh that is classified.
  std::vector<unsigned char> onBoundary = {};
  /// Of vertices whose values are neither what they were nor the means of the ends of their edges.
  WeightedRows ofVertices = {};
  /// Of cells that do not inherit, for values and for densities, by the places of the cells before
  /// and after, those of each dimension after those of lower ones.
  WeightedRows ofCells = {};
  WeightedRows ofDensities = {};

  /// visit(parent, child) of all children of cells of one dimension, parent after parent.
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
