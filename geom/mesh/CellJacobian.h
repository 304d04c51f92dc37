// Hexahedra, wedges, pyramids and quadrilaterals: whether they are valid, their shape and size.
#pragma once

#include <cadrefine/base/Vector3.h>

#include <array>
#include <limits>

namespace cadrefine
{

/// Cells by their corners in VTK's order.
using Hexahedron = std::array<Point3, 8>;
using Wedge = std::array<Point3, 6>;
using Pyramid = std::array<Point3, 5>;
using Quadrilateral = std::array<Point3, 4>;

/// Whether the Jacobian determinant of the cell's map (trilinear for the hexahedron) is positive on
/// all of the cell, for certain. It is a polynomial, and lies between the smallest and the largest
/// of its Bernstein coefficients (A. Johnen, J.-F. Remacle, C. Geuzaine, "Geometrical validity of
/// curvilinear finite elements", J. Comput. Phys. 233, 2013). A coefficient counts as positive if
/// it is larger than the rounding errors in it; those at the corners are volumes of tetrahedra,
/// whose exact sign decides where rounding hides it.
///
/// - Hexahedron: degree 2 in each parameter, 27 coefficients, of which those at corners and edges
///   give the others (A. Johnen, J.-C. Weill, J.-F. Remacle, "Robust and efficient validation of
///   the linear hexahedral element", 2017). Where one is negative that is not at a corner, the cell
///   is halved by de Casteljau's algorithm, so that a valid cell is not refused because its bounds
///   are loose. Before all that: a cell whose opposite edges differ little is near enough to a
///   parallelepiped.
/// - Wedge: linear over the triangle and quadratic from one triangle to the other, so that three
///   quadratics decide, each by its discriminant.
/// - Pyramid: with base Q(r, s) and apex A the map is (1 - t) Q + t A, its determinant (1 - t)^2 g
///   with g bilinear. Four tetrahedra at the base decide, exactly; the apex, where the
///   determinant vanishes, does not count.
///
/// What cannot be decided is not valid: determinants of less than 4e-13 times the product of the
/// longest edges in the three directions (but for those at corners), hexahedra that take more than
/// 256 halvings, edges outside of 1e-300 to 1e300 (of a pyramid 1e-150 to 1e150), coordinates that
/// are not finite. About 0.2 microseconds a hexahedron, 0.05 a wedge, 0.07 a pyramid; a
/// hexahedron that has to be halved takes up to some microseconds more.
///
/// A wedge is positive where corners 3, 4, 5 lie on the side to which the normal of (0, 1, 2)
/// points, as for vtkWedge's own shape functions, Verdict and gmsh. VTK's documentation draws it
/// the other way round, with which vtkWedge's faces point outward and vtkCellSizeFilter's volume is
/// positive. Meshes come in both; exchange the triangles of the others.
bool hasPositiveJacobian(const Hexahedron& corners);
bool hasPositiveJacobian(const Wedge& corners);
bool hasPositiveJacobian(const Pyramid& corners);

/// Whether all four corners turn to the left, seen from the end of `side` (turnOf). The component
/// along `side` of the normal of a bilinear patch is linear in its parameters, so that then no
/// point of it is turned over. Exact in a coordinate plane.
bool isValidQuadrilateral(const Quadrilateral& corners, const Vector3& side);

/// The least scaled Jacobian: at the corners, of the hexahedron also in the middle, the determinant
/// of the unit vectors along the edges, divided by that of the ideal cell (P. Knupp, "Algebraic
/// mesh quality metrics for unstructured initial meshes", Finite Elem. Anal. Des. 39, 2003). 1 for
/// the cube (and bricks), the square (and rectangles), the right prism over an equilateral
/// triangle, and the pyramid of equal edges; less for all others. Positive if and only if the cell
/// is valid: 0 where the values are positive but the cell is not valid between them. For hexahedra,
/// wedges and quadrilaterals it is Verdict's: for the latter what the corners turn about the mean
/// normal, with the sign that it has from the end of `side`. For a pyramid it also has the sines of
/// the triangles' angles at the apex, as a high one has good corners at the base. Squares of edges
/// must be finite.
///
/// For a valid hexahedron a lower bound may be given instead, if that is at least `enough`.
double scaledJacobian(
  const Hexahedron& corners, double enough = std::numeric_limits<double>::infinity());
double scaledJacobian(const Wedge& corners);
double scaledJacobian(const Pyramid& corners);
double scaledJacobian(const Quadrilateral& corners, const Vector3& side);

/// The volume of a cell: the integral of its Jacobian determinant.
double volume(const Hexahedron& corners);
double volume(const Wedge& corners);
double volume(const Pyramid& corners);

/// The area of a quadrilateral; if it is not plane, that of its projection along its mean normal.
double area(const Quadrilateral& corners);

} // namespace cadrefine
