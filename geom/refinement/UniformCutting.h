// How a cell of each shape is cut uniformly.
#pragma once

#include <cadrefine/mesh/Mesh.h>

#include <array>
#include <optional>

namespace cadrefine
{

/// Each split function appends the children of a cell with corners v, given the new vertices m on
/// its edges and q in its quadrilaterals, all in the order of its shape.

/// Splits a triangle into one at each corner, and one in the middle.
void splitTriangleUniformly(
  const std::array<Index, 3>& v, const std::array<Index, 3>& m, Cells<3>& children);

/// Splits a quadrilateral into one at each corner, which meet in the vertex in the middle.
void splitQuadrilateralUniformly(
  const std::array<Index, 4>& v, const std::array<Index, 4>& m, Index middle, Cells<4>& children);

/// Splits a tetrahedron into one at each corner, and four round the shortest diagonal of the
/// octahedron between, by the points of `mesh` (ties by its ids). J. Bey, "Tetrahedral grid
/// refinement", Computing 55, 1995.
void splitTetrahedronUniformly(const Mesh& mesh, const std::array<Index, 4>& v,
  const std::array<Index, 6>& m, Cells<4>& children);

/// The two pyramids at the quadrilateral between the middles of the edges to the apex are parted
/// where the one below, upside down, would not be valid, as over a base that is far from flat, and
/// its halves are. Returns the diagonal to part them along, if possible the shorter one (ties as
/// above), by the corner of the base at which it begins, 0 or 1; none where they are not parted.
std::optional<int> partingDiagonal(const Mesh& mesh, const std::array<Index, 5>& v);
constexpr int childrenOfPyramid = 10;
constexpr int childrenOfPartedPyramid = 12;

/// Splits a pyramid, with a new vertex `base` in its base: a pyramid at each corner, one over the
/// base upside down, and four tetrahedra on the edges of the base; the pyramids at the apex and
/// below it as two tetrahedra each where they are parted.
void splitPyramidUniformly(const Mesh& mesh, const std::array<Index, 5>& v,
  const std::array<Index, 8>& m, Index base, Cells<5>& pyramids, Cells<4>& tetrahedra);

/// Splits a wedge into four over each half of its height.
void splitWedgeUniformly(const std::array<Index, 6>& v, const std::array<Index, 9>& m,
  const std::array<Index, 3>& q, Cells<6>& children);

/// Splits a hexahedron into one at each corner, which meet in the vertex in the middle.
void splitHexahedronUniformly(const std::array<Index, 8>& v, const std::array<Index, 12>& m,
  const std::array<Index, 6>& q, Index middle, Cells<8>& children);

} // namespace cadrefine
