// How a cell of each shape is cut uniformly.
#pragma once

#include <cadrefine/mesh/Mesh.h>

#include <array>

namespace cadrefine
{

/// Each appends the children of a cell with corners v, given the new vertices m on its edges and q
/// in its quadrilaterals, all in the order of its shape.

/// One at each corner, and one in the middle.
void splitTriangleUniformly(
  const std::array<Index, 3>& v, const std::array<Index, 3>& m, Cells<3>& children);

/// One at each corner, which meet in the vertex in the middle.
void splitQuadrilateralUniformly(
  const std::array<Index, 4>& v, const std::array<Index, 4>& m, Index middle, Cells<4>& children);

/// One at each corner, and four round the shortest diagonal of the octahedron between, by the
/// points of `mesh` (ties by its ids). J. Bey, "Tetrahedral grid refinement", Computing 55, 1995.
void splitTetrahedronUniformly(const Mesh& mesh, const std::array<Index, 4>& v,
  const std::array<Index, 6>& m, Cells<4>& children);

/// With one vertex in the base: a pyramid at each corner, one over the base upside down, and four
/// tetrahedra on the edges of the base.
void splitPyramidUniformly(const std::array<Index, 5>& v, const std::array<Index, 8>& m, Index base,
  Cells<5>& pyramids, Cells<4>& tetrahedra);

/// Four wedges over each half of the height.
void splitWedgeUniformly(const std::array<Index, 6>& v, const std::array<Index, 9>& m,
  const std::array<Index, 3>& q, Cells<6>& children);

/// One at each corner, which meet in the vertex in the middle.
void splitHexahedronUniformly(const std::array<Index, 8>& v, const std::array<Index, 12>& m,
  const std::array<Index, 6>& q, Index middle, Cells<8>& children);

} // namespace cadrefine
