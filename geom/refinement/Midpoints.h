// The new vertices of a mesh that is refined.
#pragma once

#include <cadrefine/base/WeightedRows.h>
#include <cadrefine/mesh/EdgeTable.h>
#include <cadrefine/mesh/Mesh.h>
#include <cadrefine/mesh/QuadTable.h>
#include <cadrefine/refinement/LongestEdgeMarking.h>

#include <algorithm>
#include <array>
#include <vector>

namespace cadrefine
{

/// New vertices: at the midpoints of the marked edges, then in quadrilaterals all of whose edges
/// are marked, then in hexahedra all of whose edges are, then in the middle of the corners of cells
/// that are cut round one (see CellCutting); that of a pyramid is on the way from the mean of the
/// base's corners to the apex, where it sees all of the base.
struct Midpoints
{
  Index firstVertex = 0;
  std::vector<Index> ofEdge; ///< New vertex of each edge, or -1.
  /// As in SplitMesh; for a new vertex in the middle of corners, the first corner and the last.
  std::vector<std::array<Index, 2>> parentEdges;
  std::vector<Index> edges;        ///< Edge of each new vertex on an edge.
  std::vector<Index> quads;        ///< Quadrilateral of each new vertex in a quadrilateral.
  std::vector<Index> hexahedra;    ///< Hexahedron of each new vertex in a hexahedron cut in eight.
  std::vector<Index> cells;        ///< Cell of volume of each new vertex in the middle of corners.
  std::vector<Index> ofQuad;       ///< New vertex of each quadrilateral, or -1.
  std::vector<Index> ofHexahedron; ///< New vertex of each hexahedron cut in eight, or -1.

  /// The number of the vertex that the next parent edge makes.
  Index nextVertex() const { return firstVertex + static_cast<Index>(parentEdges.size()); }
};

/// The new vertices of some edges, or of some quadrilaterals.
template<std::size_t Count>
std::array<Index, Count> midpointsOf(
  const std::array<Index, Count>& items, const std::vector<Index>& midpointOf)
{
  std::array<Index, Count> result;
  std::transform(
    items.begin(), items.end(), result.begin(), [&](Index item) { return midpointOf[item]; });
  return result;
}

/// The quadrilaterals all of whose edges are marked, ascending.
std::vector<Index> quadsCutInFour(const QuadTable& quads, const EdgeMarks& marks);

/// Makes the new vertices on edges alone. Throws Error where one rank cannot hold them
/// (PieceLimit.h).
Midpoints makeMidpoints(const Mesh& mesh, const EdgeTable& table, const EdgeMarks& marks);

/// Makes all new vertices; one in a quadrilateral is halfway between the middles of the first and
/// the third of its edges in the table, one in a hexahedron halfway between that in the face with
/// the smallest number and the opposite one. `uniform`: for splitUniformly, which needs none in the
/// middle of corners. Throws Error where one rank cannot hold them.
Midpoints makeMidpoints(const Mesh& mesh, const EdgeTable& table, const QuadTable& quads,
  const EdgeMarks& marks, bool uniform);

/// The new vertices in the middle of corners, as weighted sums of these.
WeightedRows rowsInMiddle(const Mesh& mesh, const Midpoints& midpoints);

/// Appends the points of the new vertices to those of the mesh.
void appendNewPoints(const Mesh& mesh, const Midpoints& midpoints, std::vector<Point3>& points);

} // namespace cadrefine
