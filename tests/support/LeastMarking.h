// Which edges longest edge bisection has to cut, by brute force.
#pragma once

#include <cadrefine/mesh/Mesh.h>

#include <array>
#include <set>
#include <vector>

namespace cadtest
{

/// Global ids of an edge's ends, the smaller first.
using IdPair = std::array<cadrefine::GlobalId, 2>;

/// Corners of the tetrahedra and of the triangles, in this order.
std::vector<std::vector<cadrefine::Index>> cellsOf(const cadrefine::Mesh& mesh);

/// The least set of edges with the longest edge of each marked cell, and with the longest edge of
/// each cell and triangle that has an edge in the set.
std::set<IdPair> leastMarking(
  const cadrefine::Mesh& mesh, const std::vector<unsigned char>& cellMarks);

/// The same of a mesh of all shapes: the least fixpoint of the rules in LongestEdgeMarking.h.
std::set<IdPair> leastMixedMarking(
  const cadrefine::Mesh& mesh, const std::vector<unsigned char>& cellMarks, bool keepLayers);

} // namespace cadtest
