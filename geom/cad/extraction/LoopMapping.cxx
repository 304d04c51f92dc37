// 1. A piece along a parameter line maps to a straight piece.
// 2. Any other is cut where a map is not smooth, and each part interpolated in Chebyshev points by
//    a polynomial, halved until that is near enough.

#include <cadrefine/cad/extraction/SurfaceConversion.h>

#include <cadrefine/nurbs/PolynomialFit.h>

#include <algorithm>
#include <cmath>

namespace cadrefine
{
namespace
{

constexpr double relativeTolerance = 1e-10;

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
  BezierCurve2 straight = mapped.curve;
  straight.points = { { start[0], start[1], 1 }, { end[0], end[1], 1 } };
  if (isConstant(mapped.curve, 0, mapped.tolerance[0]) ||
      isConstant(mapped.curve, 1, mapped.tolerance[1]))
  {
    return { straight };
  }
  std::vector<double> cuts;
  const auto coordinate = [&](int k)
  { return [&, k](double t) { return evaluate(mapped.curve, t)[k]; }; };
  fit::addCrossings(coordinate(0), mapped.mapU.knots(), cuts);
  fit::addCrossings(coordinate(1), mapped.mapV.knots(), cuts);
  TrimLoop result;
  for (const auto& piece : fit::pieces<2>(mapped, cuts, mapped.tolerance))
  {
    BezierCurve2& curve = result.emplace_back();
    curve.edge = mapped.curve.edge;
    for (const Point2& p : piece.coefficients)
    {
      curve.points.push_back({ p[0], p[1], 1 });
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
