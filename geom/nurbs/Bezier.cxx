#include <cadrefine/nurbs/Bezier.h>

#include <cadrefine/nurbs/BernsteinBasis.h>
#include <cadrefine/nurbs/PatchView.h>

namespace cadrefine
{
namespace
{

/// Where `x` lies in [x0, x1], as a fraction; exactly 0 and 1 at the ends.
double fraction(double x, double x0, double x1)
{
  return x1 > x0 ? (x - x0) / (x1 - x0) : 0.0;
}

double inverseWidth(double x0, double x1)
{
  return x1 > x0 ? 1.0 / (x1 - x0) : 0.0;
}

} // namespace

Point2 evaluate(const BezierCurve2& curve, double t)
{
  const int degree = static_cast<int>(curve.points.size()) - 1;
  BasisValues basis;
  bernsteinValues(degree, t, basis);
  ControlPoint2 sum{};
  for (int i = 0; i <= degree; ++i)
  {
    for (int k = 0; k < 3; ++k)
    {
      sum[k] += basis[i] * curve.points[i][k];
    }
  }
  return { sum[0] / sum[2], sum[1] / sum[2] };
}

Point3 evaluate(const BezierCurve& curve, double t)
{
  return evaluateLocal(viewOf(curve), fraction(t, curve.t0, curve.t1), 0.0);
}

CurveDerivatives evaluateDerivatives(const BezierCurve& curve, double t)
{
  const PatchDerivatives d =
    evaluateLocalDerivatives(viewOf(curve), fraction(t, curve.t0, curve.t1), 0.0);
  const double scale = inverseWidth(curve.t0, curve.t1);
  return { d.value, scale * d.u, scale * scale * d.uu };
}

Point3 evaluate(const BezierPatch& patch, double u, double v)
{
  return evaluateLocal(
    viewOf(patch), fraction(u, patch.u0, patch.u1), fraction(v, patch.v0, patch.v1));
}

PatchDerivatives evaluateDerivatives(const BezierPatch& patch, double u, double v)
{
  PatchDerivatives d = evaluateLocalDerivatives(
    viewOf(patch), fraction(u, patch.u0, patch.u1), fraction(v, patch.v0, patch.v1));
  const double scaleU = inverseWidth(patch.u0, patch.u1);
  const double scaleV = inverseWidth(patch.v0, patch.v1);
  d.u = scaleU * d.u;
  d.v = scaleV * d.v;
  d.uu = scaleU * scaleU * d.uu;
  d.uv = scaleU * scaleV * d.uv;
  d.vv = scaleV * scaleV * d.vv;
  return d;
}

} // namespace cadrefine
