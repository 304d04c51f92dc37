// Volume, area and shape of simplices.
#pragma once

#include <cadrefine/base/Vector3.h>
#include <cadrefine/mesh/Mesh.h>

#include <array>

namespace cadrefine
{

/// Six times the signed volume of a tetrahedron; positive where d lies on the side to which the
/// normal of (a, b, c) points (VTK's order).
double sixfoldVolume(const Point3& a, const Point3& b, const Point3& c, const Point3& d);

/// Twice the area of a triangle times its unit normal.
Vector3 twofoldAreaVector(const Point3& a, const Point3& b, const Point3& c);

/// Twice the area times the unit normal of a facet with 3 or 4 `corners`; of a bilinear one twice
/// the integral of its unit normal.
inline Vector3 twofoldAreaVector(const std::array<Point3, 4>& p, int corners)
{
  return corners == 4 ? cross(p[2] - p[0], p[3] - p[1]) : twofoldAreaVector(p[0], p[1], p[2]);
}

/// The mean of the first `corners` points, of which there are 2 to 4.
inline Point3 centroidOf(const std::array<Point3, 4>& p, int corners)
{
  if (corners == 2)
  {
    return 0.5 * (p[0] + p[1]);
  }
  return corners == 4 ? 0.25 * (p[0] + p[1] + p[2] + p[3]) : (1.0 / 3.0) * (p[0] + p[1] + p[2]);
}

/// Sum of the squared lengths of a tetrahedron's six edges.
inline double squaredEdgeLengths(const Point3& a, const Point3& b, const Point3& c, const Point3& d)
{
  return squaredNorm(b - a) + squaredNorm(c - a) + squaredNorm(d - a) + squaredNorm(c - b) +
         squaredNorm(d - b) + squaredNorm(d - c);
}

/// Sum of the squared lengths of a triangle's three edges.
inline double squaredEdgeLengths(const Point3& a, const Point3& b, const Point3& c)
{
  return squaredNorm(b - a) + squaredNorm(c - b) + squaredNorm(a - c);
}

/// Mean ratio of a tetrahedron, signed: 12 (3 V)^(2/3) / sum of squared edge lengths; 1 for the
/// equilateral tetrahedron, 0 for a flat one, negative for an inverted one. (A. Liu, B. Joe,
/// "Relationship between tetrahedron shape measures", BIT 34, 1994, eq. 2.4.)
double meanRatio(const Point3& a, const Point3& b, const Point3& c, const Point3& d);

/// Mean ratio of a triangle: 4 sqrt(3) A / sum of squared edge lengths, never negative.
double meanRatio(const Point3& a, const Point3& b, const Point3& c);

/// The largest mean ratio of any tetrahedron that has this triangle as a face: that with its apex
/// over the centroid, at a height whose square is 2/9 of the sum of the squared edges.
double largestMeanRatioOver(const Point3& a, const Point3& b, const Point3& c);

} // namespace cadrefine
