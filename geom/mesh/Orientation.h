// Which way simplices turn: exactly, whatever the rounding of their coordinates.
#pragma once

#include <cadrefine/base/Vector3.h>

#include <array>

namespace cadrefine
{

/// The sign (-1, 0, 1) of a tetrahedron's volume: 1 where vertex d lies on the side to which the
/// normal of (a, b, c) points (VTK's order), 0 where all lie in one plane.
///
/// All answers here are those of exact arithmetic on the coordinates as they are, by CGAL's
/// filtered predicates (H. Brönnimann, C. Burnikel, S. Pion, "Interval arithmetic yields efficient
/// dynamic filters for computational geometry", Discrete Appl. Math. 109, 2001): floating point
/// decides where an error bound lets it (about 20 ns), intervals and rational numbers otherwise (up
/// to some microseconds). Coordinates that are not finite give 0.
int orientation(const Point3& a, const Point3& b, const Point3& c, const Point3& d);

/// Whether orientation is positive. It is asked only where rounding errors could change the sign:
/// some 5 ns, for coordinates whose squares are finite.
bool isPositive(const Point3& a, const Point3& b, const Point3& c, const Point3& d);

/// The signs of the three components of a triangle's normal: all 0 where the points lie on a line.
std::array<int, 3> normalSigns(const Point3& a, const Point3& b, const Point3& c);

/// The sign (-1, 0, 1) of a triangle, seen from the end of `reference`: 1 where it turns
/// counter-clockwise, 0 where it has no area. Exact where the triangle lies in a coordinate plane.
/// Elsewhere only whether it has an area is exact, and whether its normal points to the side of
/// `reference` is decided in floating point, as "turned over" has no exact meaning in space.
int turnOf(const Point3& a, const Point3& b, const Point3& c, const Vector3& reference);

} // namespace cadrefine
