// Scalar tensor product polynomials in Bernstein form over the unit square, and what bounds them.
// Private to geom/nurbs.
#pragma once

#include <cadrefine/nurbs/Interval.h>
#include <cadrefine/nurbs/PatchView.h>

#include <vector>

namespace cadrefine
{

/// Degrees of a tensor product; coefficient (i, j) is `c[i * (t + 1) + j]`.
struct Degrees
{
  int s = 0;
  int t = 0;
  int count() const { return (s + 1) * (t + 1); }
};

/// Writes the coefficients of |N - q w|^2 to `numerator` and of w^2 to `denominator`, both of
/// twice the patch's degrees, where the patch is N / w. O(degreeU^2 degreeV^2). (Johnson & Cohen,
/// "Distance extrema for spline models using tangent cones", Graphics Interface 2005.)
void squaredDistanceForm(
  const PatchView& patch, const Point3& q, double* numerator, double* denominator);

/// Splits at the middle across s or t (de Casteljau): `c` becomes the upper half, `lower` the
/// other.
void splitForm(Degrees degrees, bool acrossS, double* c, double* lower);

/// Range of the Bernstein coefficients of a derivative, which encloses that of the derivative.
/// orderS + orderT <= 2.
Interval derivativeRange(Degrees degrees, const double* c, int orderS, int orderT);

/// Value and gradient at the middle of the square.
struct MiddleValue
{
  double value = 0;
  double s = 0;
  double t = 0;
};
MiddleValue middleValue(Degrees degrees, const double* c);

} // namespace cadrefine
