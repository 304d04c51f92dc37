// Which cell's arrays a new cell inherits.
#pragma once

#include <cadrefine/operations/EditableMesh.h>

#include <array>
#include <vector>

namespace cadrefine
{

/// The parent of that of these cells, given by their numbers in the store, which the centroid of
/// the new one lies in, or least outside of, where the vertices are.
Index parentOf(const EditableMesh& mesh, const SimplexStore<4>& cells,
  const std::array<Index, 4>& corners, const std::vector<Index>& numbers);
Index parentOf(const EditableMesh& mesh, const SimplexStore<3>& cells,
  const std::array<Index, 3>& corners, const std::vector<Index>& numbers);

} // namespace cadrefine
