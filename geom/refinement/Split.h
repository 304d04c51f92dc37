// Splitting cells at the midpoints of marked edges.
#pragma once

#include <cadrefine/base/WeightedRows.h>
#include <cadrefine/mesh/Mesh.h>
#include <cadrefine/refinement/Midpoints.h>

#include <array>
#include <vector>

namespace cadrefine
{

/// Which children each cell has, by the dimension of the cells: with `first` the entry of a
/// dimension, those of cell c are first[c] up to first[c + 1].
using ChildRanges = std::array<std::vector<Index>, 4>;

/// Numbers of children among the cells of their dimension, parent after parent; none: in order.
using ChildNumbers = std::array<std::vector<Index>, 4>;

/// A split mesh. Its first points are those of the mesh that was split, the new ones follow.
struct SplitMesh
{
  Mesh mesh;
  /// Ends of the line that each new vertex halves, smaller id first, in the order of the new
  /// points: of an edge, or of one between such new points before it.
  std::vector<std::array<Index, 2>> parentEdges;
  ChildRanges firstChildren; ///< The children of each cell of the mesh that was split.
  ChildNumbers children; ///< Numbers of the children, where cells have children of several shapes.
  WeightedRows ofVertices; ///< Rows for new vertices in the middle of corners.
};

/// The children that splitMarked and splitUniformly make of each cell, without making them. Throw
/// Error where one rank cannot hold them (PieceLimit.h).
ChildRanges countMarkedChildren(
  const Mesh& mesh, const EdgeTable& table, const QuadTable& quads, const EdgeMarks& marks);
ChildRanges countUniformChildren(const Mesh& mesh);

/// Recursive bisection of each simplex at the longest of its marked edges; `midpoints` are those of
/// `marks`. Children have the parent's orientation and, since they are parts of it cut straight,
/// its validity. Other cells: see CellCutting. `ids` are the global ids of the new vertices.
SplitMesh splitMarked(const Mesh& mesh, const EdgeTable& table, const QuadTable& quads,
  const EdgeMarks& marks, const Midpoints& midpoints, const std::vector<GlobalId>& ids);

/// The valid cells of volume that are not simplices of which splitMarked, or `uniform`,
/// splitUniformly makes some that are not valid, in their numbers among those of the mesh's own
/// dimension. Of most cells both make parts cut straight; but not where a vertex in the middle of a
/// hexahedron or wedge does not see all sides, where a quadrilateral is cut in triangles, and, in
/// uniform splitting, of pyramids whose base is far from plane.
std::vector<Index> cellsCutBadly(const Mesh& mesh, const EdgeTable& table, const QuadTable& quads,
  const EdgeMarks& marks, bool uniform);

/// Regular splitting (see UniformCutting.h); every edge, quadrilateral and hexahedron must have a
/// midpoint. Triangles and quadrilaterals give 4, tetrahedra, wedges and hexahedra 8, pyramids 4
/// tetrahedra and 6 pyramids.
SplitMesh splitUniformly(const Mesh& mesh, const EdgeTable& table, const QuadTable& quads,
  const Midpoints& midpoints, const std::vector<GlobalId>& ids);

} // namespace cadrefine
