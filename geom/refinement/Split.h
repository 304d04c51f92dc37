// Splitting cells at the midpoints of marked edges.
#pragma once

#include <cadrefine/base/WeightedRows.h>
#include <cadrefine/mesh/EdgeTable.h>
#include <cadrefine/mesh/QuadTable.h>
#include <cadrefine/mesh/SimplexMesh.h>
#include <cadrefine/refinement/LongestEdgeMarking.h>

#include <array>
#include <vector>

namespace cadrefine
{

/// Children of cells, by the dimension of the cells: those of cell c are first[c] up to first[c +
/// 1].
using ChildRanges = std::array<std::vector<Index>, 4>;

/// Numbers of children among the cells of their dimension, parent after parent; none: in order.
using ChildNumbers = std::array<std::vector<Index>, 4>;

/// A split mesh. Its first points are those of the mesh that was split, the new ones follow.
struct SplitMesh
{
  SimplexMesh mesh;
  /// Ends of the line that each new vertex halves, smaller id first, in the order of the new
  /// points: of an edge, or of one between such new points before it.
  std::vector<std::array<Index, 2>> parentEdges;
  ChildRanges firstChildren; ///< Of the cells that were split.
  ChildNumbers children;     ///< Where cells have children of several shapes.
  WeightedRows ofVertices;   ///< New vertices in the middle of corners.
};

/// New vertices: at the midpoints of the marked edges, then in quadrilaterals all of whose edges
/// are marked, then in hexahedra all of whose edges are, then in the middle of the corners of cells
/// that are cut round one (see CellCutting); that of a pyramid is 3/8 of the way to its apex.
struct Midpoints
{
  Index firstVertex = 0;
  std::vector<Index> ofEdge; ///< New vertex of each edge, or -1.
  /// See SplitMesh; of those in the middle of corners the first corner and another one.
  std::vector<std::array<Index, 2>> parentEdges;
  std::vector<Index> edges;        ///< Edge of each new vertex on one.
  std::vector<Index> quads;        ///< Quadrilateral of each new vertex in one.
  std::vector<Index> hexahedra;    ///< Of each in one.
  std::vector<Index> cells;        ///< Cell of volume of each new vertex in the middle of corners.
  std::vector<Index> ofQuad;       ///< New vertex of each, or -1.
  std::vector<Index> ofHexahedron; ///< Likewise.

  /// The number of the vertex that the next parent edge makes.
  Index nextVertex() const { return firstVertex + static_cast<Index>(parentEdges.size()); }
};

/// Those on edges alone.
Midpoints makeMidpoints(const SimplexMesh& mesh, const EdgeTable& table, const EdgeMarks& marks);

/// All; a vertex in a quadrilateral is halfway between the middles of the first and the third of
/// its edges in the table, one in a hexahedron halfway between that in the face with the smallest
/// number and the opposite one. `uniform`: for splitUniformly, which needs none in the middle of
/// corners.
Midpoints makeMidpoints(const SimplexMesh& mesh, const EdgeTable& table, const QuadTable& quads,
  const EdgeMarks& marks, bool uniform);

/// How many cells splitMarked and splitUniformly make of each. Throw Error where one rank cannot
/// hold them (PieceLimit.h).
ChildRanges countMarkedChildren(
  const SimplexMesh& mesh, const EdgeTable& table, const QuadTable& quads, const EdgeMarks& marks);
ChildRanges countUniformChildren(const SimplexMesh& mesh);

/// Recursive bisection of each simplex at the longest of its marked edges; `midpoints` are those of
/// `marks`. Children have the parent's orientation and, since they are parts of it cut straight,
/// its validity. Other cells: see CellCutting. `ids` are the global ids of the new vertices.
SplitMesh splitMarked(const SimplexMesh& mesh, const EdgeTable& table, const QuadTable& quads,
  const EdgeMarks& marks, const Midpoints& midpoints, const std::vector<GlobalId>& ids);

/// The valid cells that are not simplices of which splitMarked makes some that are not, in their
/// numbers among those of the mesh's own dimension. (Of most it makes parts cut straight; but not
/// where a vertex in the middle does not see all sides, or a quadrilateral is cut in triangles.)
std::vector<Index> cellsCutBadly(
  const SimplexMesh& mesh, const EdgeTable& table, const QuadTable& quads, const EdgeMarks& marks);
/// The pyramids, numbered likewise, of which splitUniformly does: where the base is far from plane.
std::vector<Index> pyramidsCutBadly(
  const SimplexMesh& mesh, const EdgeTable& table, const QuadTable& quads);

/// Regular splitting; every edge, quadrilateral and hexahedron must have a midpoint. Triangles and
/// quadrilaterals give 4, hexahedra and wedges 8, tetrahedra 8: one at each corner and four round
/// the shortest diagonal of the octahedron between (ties by global id); pyramids 4 tetrahedra
/// on the edges of the base and 6 pyramids.
/// J. Bey, "Tetrahedral grid refinement", Computing 55, 1995.
SplitMesh splitUniformly(const SimplexMesh& mesh, const EdgeTable& table, const QuadTable& quads,
  const Midpoints& midpoints, const std::vector<GlobalId>& ids);

} // namespace cadrefine
