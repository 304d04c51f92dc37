// Splitting cells at the midpoints of marked edges.
#pragma once

#include <cadrefine/mesh/EdgeTable.h>
#include <cadrefine/mesh/SimplexMesh.h>
#include <cadrefine/refinement/LongestEdgeMarking.h>

#include <array>
#include <vector>

namespace cadrefine
{

/// Children of cells, by the dimension of the cells: those of cell c are first[c] up to first[c +
/// 1].
using ChildRanges = std::array<std::vector<Index>, 4>;

/// A split mesh. Its first points are those of the mesh that was split, the new ones follow.
struct SplitMesh
{
  SimplexMesh mesh;
  /// Ends of the edge that each new vertex halves, smaller id first, in the order of the new
  /// points.
  std::vector<std::array<Index, 2>> parentEdges;
  ChildRanges firstChildren; ///< Of the cells that were split, among the cells of `mesh`.
};

/// New vertices at the midpoints of the marked edges.
struct Midpoints
{
  std::vector<Index> ofEdge;                     ///< New vertex of each edge, or -1.
  std::vector<std::array<Index, 2>> parentEdges; ///< See SplitMesh.
  std::vector<Index> edges;                      ///< Edge of each new vertex.
};

Midpoints makeMidpoints(const SimplexMesh& mesh, const EdgeTable& table, const EdgeMarks& marks);

/// How many cells splitMarked and splitUniformly make of each. Throw Error where one rank cannot
/// hold them (PieceLimit.h).
ChildRanges countMarkedChildren(
  const SimplexMesh& mesh, const EdgeTable& table, const EdgeMarks& marks);
ChildRanges countUniformChildren(const SimplexMesh& mesh);

/// Recursive bisection of each cell at the longest of its marked edges; `midpoints` are those of
/// `marks`. Children have the parent's orientation and, since they are parts of it cut straight,
/// its validity. `ids` are the global ids of the new vertices.
SplitMesh splitMarked(const SimplexMesh& mesh, const EdgeTable& table, const EdgeMarks& marks,
  const Midpoints& midpoints, const std::vector<GlobalId>& ids);

/// Regular splitting; every edge must have a midpoint. Triangles give 4, tetrahedra 8: one at each
/// corner and four round the shortest diagonal of the octahedron between (ties by global id).
/// J. Bey, "Tetrahedral grid refinement", Computing 55, 1995.
SplitMesh splitUniformly(const SimplexMesh& mesh, const EdgeTable& table,
  const Midpoints& midpoints, const std::vector<GlobalId>& ids);

} // namespace cadrefine
