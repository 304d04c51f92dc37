#include <cadrefine/nurbs/BernsteinForm.h>

#include <cadrefine/nurbs/BernsteinBasis.h>

#include <algorithm>
#include <array>

namespace cadrefine
{
namespace
{

/// Control point relative to the query, scaled by its binomials, so that the product of two forms
/// is a convolution.
struct ScaledPoint
{
  double x, y, z, w;
};

using ScaledPoints = std::array<ScaledPoint, (maximumDegree + 1) * (maximumDegree + 1)>;

void scalePoints(const PatchView& patch, const Point3& q, ScaledPoints& scaled)
{
  const auto& binomialU = binomials[patch.degreeU];
  const auto& binomialV = binomials[patch.degreeV];
  int k = 0;
  for (int i = 0; i <= patch.degreeU; ++i)
  {
    for (int j = 0; j <= patch.degreeV; ++j, ++k)
    {
      const ControlPoint& p = patch.points[k];
      const double factor = binomialU[i] * binomialV[j];
      scaled[k] = { factor * (p[0] - q[0] * p[3]), factor * (p[1] - q[1] * p[3]),
        factor * (p[2] - q[2] * p[3]), factor * p[3] };
    }
  }
}

/// Adds the products of row `a` with row `b`, times `factor`, to one row of the results.
void convolveRows(const ScaledPoint* a, const ScaledPoint* b, int degree, double factor,
  double* numerator, double* denominator)
{
  for (int j = 0; j <= degree; ++j)
  {
    const ScaledPoint p = { factor * a[j].x, factor * a[j].y, factor * a[j].z, factor * a[j].w };
    for (int l = 0; l <= degree; ++l)
    {
      numerator[j + l] += p.x * b[l].x + p.y * b[l].y + p.z * b[l].z;
      denominator[j + l] += p.w * b[l].w;
    }
  }
}

} // namespace

void squaredDistanceForm(
  const PatchView& patch, const Point3& q, double* numerator, double* denominator)
{
  const Degrees degrees = { 2 * patch.degreeU, 2 * patch.degreeV };
  const int columns = patch.degreeV + 1;
  const int resultColumns = degrees.t + 1;
  ScaledPoints scaled;
  scalePoints(patch, q, scaled);
  std::fill(numerator, numerator + degrees.count(), 0.0);
  std::fill(denominator, denominator + degrees.count(), 0.0);
  for (int i = 0; i <= patch.degreeU; ++i)
  {
    for (int k = i; k <= patch.degreeU; ++k)
    {
      const int row = (i + k) * resultColumns;
      convolveRows(&scaled[i * columns], &scaled[k * columns], patch.degreeV, k > i ? 2.0 : 1.0,
        numerator + row, denominator + row);
    }
  }
  for (int i = 0; i <= degrees.s; ++i)
  {
    for (int j = 0; j <= degrees.t; ++j)
    {
      const double factor = binomials[degrees.s][i] * binomials[degrees.t][j];
      numerator[i * resultColumns + j] /= factor;
      denominator[i * resultColumns + j] /= factor;
    }
  }
}

void splitForm(Degrees degrees, bool acrossS, double* c, double* lower)
{
  const int columns = degrees.t + 1;
  const int degree = acrossS ? degrees.s : degrees.t;
  const int others = acrossS ? columns : degrees.s + 1;
  const int step = acrossS ? columns : 1;      // from one coefficient to the next along the cut
  const int otherStep = acrossS ? 1 : columns; // from one line of coefficients to the next
  for (int line = 0; line < others; ++line)
  {
    double* a = c + line * otherStep;
    double* b = lower + line * otherStep;
    for (int r = 0; r < degree; ++r)
    {
      b[r * step] = a[0];
      for (int i = 0; i < degree - r; ++i)
      {
        a[i * step] = 0.5 * (a[i * step] + a[(i + 1) * step]);
      }
    }
    b[degree * step] = a[0];
  }
}

Interval derivativeRange(Degrees degrees, const double* c, int orderS, int orderT)
{
  if (orderS > degrees.s || orderT > degrees.t)
  {
    return {};
  }
  const int columns = degrees.t + 1;
  const double factor = (orderS > 0 ? degrees.s : 1.0) * (orderS > 1 ? degrees.s - 1.0 : 1.0) *
                        (orderT > 0 ? degrees.t : 1.0) * (orderT > 1 ? degrees.t - 1.0 : 1.0);
  // The difference stencil: value(0) - value(a) - value(b) + value(a + b).
  const int a = orderS > 0 ? columns : 1;
  const int b = orderT > 0 ? 1 : columns;
  const bool second = orderS + orderT == 2;
  const bool first = orderS + orderT == 1;
  Interval range = Interval::empty();
  for (int i = 0; i <= degrees.s - orderS; ++i)
  {
    for (int j = 0; j <= degrees.t - orderT; ++j)
    {
      const double* p = c + i * columns + j;
      range.include(second ? p[0] - p[a] - p[b] + p[a + b] : first ? p[a] - p[0] : p[0]);
    }
  }
  return factor * range;
}

MiddleValue middleValue(Degrees degrees, const double* c)
{
  std::array<double, 2 * maximumDegree + 1> rowValue;
  std::array<double, 2 * maximumDegree + 1> rowSlope;
  const int columns = degrees.t + 1;
  const auto& binomialT = binomials[degrees.t];
  const auto& binomialS = binomials[degrees.s];
  const double scaleT = std::ldexp(1.0, -degrees.t);
  const double scaleS = std::ldexp(1.0, -degrees.s);
  for (int i = 0; i <= degrees.s; ++i)
  {
    double value = 0;
    double slope = 0;
    for (int j = 0; j <= degrees.t; ++j)
    {
      // At the middle the derivative of the j-th Bernstein polynomial is 2 (2 j - n) times it.
      const double term = binomialT[j] * c[i * columns + j];
      value += term;
      slope += 2.0 * (2 * j - degrees.t) * term;
    }
    rowValue[i] = scaleT * value;
    rowSlope[i] = scaleT * slope;
  }
  MiddleValue middle;
  for (int i = 0; i <= degrees.s; ++i)
  {
    const double factor = scaleS * binomialS[i];
    middle.value += factor * rowValue[i];
    middle.s += factor * 2.0 * (2 * i - degrees.s) * rowValue[i];
    middle.t += factor * rowSlope[i];
  }
  return middle;
}

} // namespace cadrefine
