// Cells of second order, and whether they are valid, by Bezier bounds of their Jacobian.
#pragma once

#include <cadrefine/base/Vector3.h>
#include <cadrefine/mesh/Mesh.h>
#include <cadrefine/quadratic/BezierForm.h>

#include <algorithm>
#include <array>
#include <iterator>

namespace cadrefine
{

/// Nodes of a cell of second order: its corners, then a mid node for each edge of the shape (for
/// tetrahedra not in VTK's order).
template<class Shape>
using CurvedCell = std::array<Point3, Shape::corners + std::size(Shape::edges)>;

using CurvedTriangle = CurvedCell<shapes::Triangle>;
using CurvedQuadrilateral = CurvedCell<shapes::Quadrilateral>;
using CurvedTetrahedron = CurvedCell<shapes::Tetrahedron>;
using CurvedPyramid = CurvedCell<shapes::Pyramid>;
using CurvedWedge = CurvedCell<shapes::Wedge>;
using CurvedHexahedron = CurvedCell<shapes::Hexahedron>;

/// The Jacobian determinant of x(l) = sum N_i(l) x_i with respect to the barycentric coordinates
/// l_1, l_2, l_3: six times the volume where the cell is straight. Its derivatives are linear in l
/// with coefficients a^k_i = 4 (x_ik - x_i0) - (x_k - x_0), x_ik being the node between corners i
/// and k (x_ii = x_i), and the coefficients of the determinant are the means of det(a^1, a^2, a^3)
/// over the permutations of the index tuple (A. Johnen, J.-F. Remacle, C. Geuzaine, "Geometrical
/// validity of curvilinear finite elements", J. Comput. Phys. 233, 2013). 64 determinants, about
/// 0.2 microseconds.
///
/// Rounding, with u half of the machine epsilon and m = 4 |x_ik - x_i0| + |x_k - x_0|: a^k_i errs
/// by less than 3 u m, so three factors by 9 u, a determinant's arithmetic adds 5 u, and the mean
/// of at most six 6 u, of the permanent of the three m. That is at most the product of their
/// 1-norms, M_1 M_2 M_3 with the largest ones over i: the bound is 12 epsilon M_1 M_2 M_3.
BezierForm<20> jacobianOf(const CurvedTetrahedron& nodes);

/// The Jacobian determinant of a triangle: the component along the unit normal `side` of the
/// product of the two derivatives, twice the area where the cell is straight and has that normal.
BezierForm<6> jacobianOf(const CurvedTriangle& nodes, const Vector3& side);

/// The Jacobian determinants of cells of serendipity shape functions, those of VTK. Their maps are
/// polynomials of degree 2 in each parameter of the square and the cube, and over the prism's
/// triangle and along it, of which the terms of highest degree in two directions at once are
/// missing: so in the middle of a quadrilateral the Bezier point is (2 sum of the edges' - sum of
/// the corners') / 4, in the middle of the hexahedron (sum of the edges' - sum of the corners') /
/// 4. The determinant is of degree 3 in each parameter of the square (16 coefficients), 5 of the
/// cube (216), and 4 over the triangle and 5 along the prism (90). It is with respect to parameters
/// from 0 to 1: the mean of the coefficients is the volume of the hexahedron and the area of the
/// quadrilateral, twice the volume of the wedge. As long as that of a tetrahedron, of the wedge
/// three times, of the hexahedron ten times.
///
/// Rounding: with S the largest 1-norm of a node less the first one, a Bezier point errs by less
/// than 150 u S, a derivative's coefficient by 420 u S; M being the largest 1-norm of those in one
/// direction, the product of three errs by prod (M + 210 epsilon S) - prod M, and its arithmetic
/// adds 30 epsilon prod M.
BezierForm<16> jacobianOf(const CurvedQuadrilateral& nodes, const Vector3& side);
BezierForm<90> jacobianOf(const CurvedWedge& nodes);
BezierForm<216> jacobianOf(const CurvedHexahedron& nodes);

/// Whether the Jacobian determinant is positive on all of the cell, for certain (see isPositive):
/// halving sees to it that a valid cell is not refused because its bounds are loose. About 0.2
/// microseconds without a halving, and 0.1 for each; for a hexahedron ten times that.
///
/// A cell all of whose mid nodes are the middles of its edges, to the last bit, is straight: it is
/// valid by its corners (see CellJacobian.h), of a simplex by its exact orientation. Others whose
/// determinant is lost in the rounding of their coordinates are not valid, nor is one with a
/// coordinate that is not finite or edges outside of 1e-90 to 1e100.
///
/// A pyramid is valid if it is straight and valid: for others there is no one map. VTK's, a
/// hexahedron of second order with one side drawn together to the apex, does not meet the triangles
/// of second order beside it; those that do are rational, and not the same in all programs.
bool isValid(const CurvedTetrahedron& nodes);
bool isValid(const CurvedPyramid& nodes);
bool isValid(const CurvedWedge& nodes);
bool isValid(const CurvedHexahedron& nodes);

/// Whether a triangle or quadrilateral is valid, as seen from the end of `side`: in a plane from
/// the side to which all triangles turn; in space take the normal of the straight triangle. The
/// triangle is then a graph over its own plane: its normal is nowhere 90 degrees off.
bool isValid(const CurvedTriangle& nodes, const Vector3& side);
bool isValid(const CurvedQuadrilateral& nodes, const Vector3& side);

/// The cell with mid nodes in the middles of its edges.
template<class Shape>
CurvedCell<Shape> straightCell(Shape, const std::array<Point3, Shape::corners>& corners)
{
  CurvedCell<Shape> result;
  std::copy(corners.begin(), corners.end(), result.begin());
  std::transform(std::begin(Shape::edges), std::end(Shape::edges), result.begin() + Shape::corners,
    [&](const auto& edge) { return 0.5 * (corners[edge[0]] + corners[edge[1]]); });
  return result;
}

/// The point of the triangle at these barycentric coordinates.
Point3 pointAt(const CurvedTriangle& nodes, const std::array<double, 3>& where);
/// The point of the quadrilateral at parameters from 0 to 1, from corner 0 to 1 and from 0 to 3.
Point3 pointAt(const CurvedQuadrilateral& nodes, const Point2& where);

} // namespace cadrefine
