// Which cell's arrays a new cell inherits.
#pragma once

#include <cadrefine/operations/EditableMesh.h>

#include <array>
#include <vector>

namespace cadrefine
{

/// Of the cells with these numbers in the store, finds the one in which the centroid of a new cell
/// with these corners lies, or of which it lies least outside, and returns that cell's parent. All
/// with the vertices where they are.
Index parentOf(const EditableMesh& mesh, const SimplexStore<4>& cells,
  const std::array<Index, 4>& corners, const std::vector<Index>& numbers);
Index parentOf(const EditableMesh& mesh, const SimplexStore<3>& cells,
  const std::array<Index, 3>& corners, const std::vector<Index>& numbers);

} // namespace cadrefine
