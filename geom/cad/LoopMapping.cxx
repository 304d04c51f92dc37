// 1. A piece along a parameter line maps to a straight piece.
// 2. Any other is cut where a map is not smooth, and each part interpolated in Chebyshev points by
//    a polynomial, halved until that is near enough.

#include "SurfaceConversion.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace cadrefine
{
namespace
{

constexpr int degree = 7;
constexpr double relativeTolerance = 1e-10;
constexpr int maximumDepth = 12;

using Nodes = std::array<double, degree + 1>;
using Matrix = std::array<Nodes, degree + 1>;

/// Both ends, and Chebyshev points between them.
Nodes interpolationNodes()
{
  Nodes nodes{};
  for (int i = 0; i <= degree; ++i)
  {
    nodes[i] = 0.5 - 0.5 * std::cos(M_PI * i / degree);
  }
  nodes[degree] = 1;
  return nodes;
}

std::array<double, degree + 1> bernstein(double t)
{
  std::array<double, degree + 1> b{ 1 };
  for (int n = 1; n <= degree; ++n)
  {
    for (int i = n; i >= 0; --i)
    {
      b[i] = (i > 0 ? t * b[i - 1] : 0) + (i < n ? (1 - t) * b[i] : 0);
    }
  }
  return b;
}

/// Inverse of the matrix of the Bernstein polynomials at the nodes (Gauss-Jordan with pivots).
Matrix valuesToControlPoints()
{
  const Nodes nodes = interpolationNodes();
  Matrix a{};
  Matrix inverse{};
  for (int i = 0; i <= degree; ++i)
  {
    a[i] = bernstein(nodes[i]);
    inverse[i][i] = 1;
  }
  for (int k = 0; k <= degree; ++k)
  {
    int pivot = k;
    for (int i = k + 1; i <= degree; ++i)
    {
      pivot = std::abs(a[i][k]) > std::abs(a[pivot][k]) ? i : pivot;
    }
    std::swap(a[k], a[pivot]);
    std::swap(inverse[k], inverse[pivot]);
    for (int i = 0; i <= degree; ++i)
    {
      const double factor = i == k ? 1 - 1 / a[k][k] : a[i][k] / a[k][k];
      for (int j = 0; j <= degree; ++j)
      {
        a[i][j] -= factor * a[k][j];
        inverse[i][j] -= factor * inverse[k][j];
      }
    }
  }
  return inverse;
}

Point2 evaluate(const BezierCurve2& curve, double t)
{
  std::vector<ControlPoint2> c = curve.points;
  for (std::size_t n = c.size() - 1; n > 0; --n)
  {
    for (std::size_t i = 0; i < n; ++i)
    {
      for (int k = 0; k < 3; ++k)
      {
        c[i][k] = (1 - t) * c[i][k] + t * c[i + 1][k];
      }
    }
  }
  return { c[0][0] / c[0][2], c[0][1] / c[0][2] };
}

struct MappedCurve
{
  const BezierCurve2& curve;
  const ParameterMap& mapU;
  const ParameterMap& mapV;
  Point2 tolerance;

  Point2 operator()(double t) const
  {
    const Point2 p = evaluate(this->curve, t);
    return { this->mapU(p[0]), this->mapV(p[1]) };
  }
};

BezierCurve2 interpolate(const MappedCurve& mapped, double t0, double t1)
{
  static const Nodes nodes = interpolationNodes();
  static const Matrix toControlPoints = valuesToControlPoints();
  BezierCurve2 result;
  result.points.assign(degree + 1, { 0, 0, 1 });
  for (int j = 0; j <= degree; ++j)
  {
    const Point2 p = mapped(j == degree ? t1 : t0 + nodes[j] * (t1 - t0));
    for (int i = 0; i <= degree; ++i)
    {
      result.points[i][0] += toControlPoints[i][j] * p[0];
      result.points[i][1] += toControlPoints[i][j] * p[1];
    }
  }
  const Point2 start = mapped(t0);
  const Point2 end = mapped(t1);
  result.points.front() = { start[0], start[1], 1 };
  result.points.back() = { end[0], end[1], 1 };
  return result;
}

bool isNear(const MappedCurve& mapped, const BezierCurve2& fit, double t0, double t1)
{
  for (const double local : { 0.02, 0.13, 0.3, 0.46, 0.61, 0.8, 0.96 })
  {
    const Point2 p = mapped(t0 + local * (t1 - t0));
    const Point2 q = evaluate(fit, local);
    if (std::abs(p[0] - q[0]) > mapped.tolerance[0] || std::abs(p[1] - q[1]) > mapped.tolerance[1])
    {
      return false;
    }
  }
  return true;
}

void fitPart(const MappedCurve& mapped, double t0, double t1, int depth, TrimLoop& result)
{
  BezierCurve2 fit = interpolate(mapped, t0, t1);
  if (depth >= maximumDepth || isNear(mapped, fit, t0, t1))
  {
    result.push_back(std::move(fit));
    return;
  }
  const double middle = 0.5 * (t0 + t1);
  fitPart(mapped, t0, middle, depth + 1, result);
  fitPart(mapped, middle, t1, depth + 1, result);
}

/// Adds the parameters where coordinate `k` of the curve crosses a knot, each sign change between
/// sampled points once.
void addCrossings(const BezierCurve2& curve, int k, const std::vector<double>& knots,
  std::vector<double>& parameters)
{
  constexpr int samples = 16;
  for (const double knot : knots)
  {
    const auto above = [&](double t) { return evaluate(curve, t)[k] > knot; };
    for (int i = 0; i < samples; ++i)
    {
      double low = static_cast<double>(i) / samples;
      double high = static_cast<double>(i + 1) / samples;
      const bool start = above(low);
      if (start == above(high))
      {
        continue;
      }
      for (int step = 0; step < 50; ++step)
      {
        const double middle = 0.5 * (low + high);
        (above(middle) == start ? low : high) = middle;
      }
      parameters.push_back(high);
    }
  }
}

bool isConstant(const BezierCurve2& curve, int k, double tolerance)
{
  const auto value = [k](const ControlPoint2& c) { return c[k] / c[2]; };
  const double first = value(curve.points.front());
  return std::all_of(curve.points.begin(), curve.points.end(),
    [&](const ControlPoint2& c) { return std::abs(value(c) - first) <= tolerance; });
}

TrimLoop mapCurve(const MappedCurve& mapped)
{
  const Point2 start = mapped(0);
  const Point2 end = mapped(1);
  const BezierCurve2 straight{ { { start[0], start[1], 1 }, { end[0], end[1], 1 } } };
  if (isConstant(mapped.curve, 0, mapped.tolerance[0]) ||
      isConstant(mapped.curve, 1, mapped.tolerance[1]))
  {
    return { straight };
  }
  std::vector<double> cuts{ 0, 1 };
  addCrossings(mapped.curve, 0, mapped.mapU.knots(), cuts);
  addCrossings(mapped.curve, 1, mapped.mapV.knots(), cuts);
  std::sort(cuts.begin(), cuts.end());
  TrimLoop result;
  double from = 0;
  for (const double to : cuts)
  {
    if (to - from > 1e-9 || to == 1)
    {
      const double next = 1 - to > 1e-9 ? to : 1;
      if (next > from)
      {
        fitPart(mapped, from, next, 0, result);
      }
      from = next;
    }
  }
  return result;
}

} // namespace

std::vector<TrimLoop> mapLoops(
  const std::vector<TrimLoop>& loops, const ParameterMap& mapU, const ParameterMap& mapV)
{
  if (mapU.isIdentity() && mapV.isIdentity())
  {
    return loops;
  }
  const ParameterBox box = hullOf(loops);
  const Point2 tolerance{ relativeTolerance * (box.u1 - box.u0),
    relativeTolerance * (box.v1 - box.v0) };
  std::vector<TrimLoop> result;
  for (const TrimLoop& loop : loops)
  {
    TrimLoop mapped;
    for (const BezierCurve2& curve : loop)
    {
      const TrimLoop pieces = mapCurve({ curve, mapU, mapV, tolerance });
      mapped.insert(mapped.end(), pieces.begin(), pieces.end());
    }
    result.push_back(std::move(mapped));
  }
  return result;
}

} // namespace cadrefine
