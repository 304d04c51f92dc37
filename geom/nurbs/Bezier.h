// Rational Bezier curves and patches in plain arrays: what every NURBS entity is split into.
#pragma once

#include <cadrefine/base/Vector3.h>

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace cadrefine
{

/// Homogeneous control point (w x, w y, w z, w), w > 0.
using ControlPoint = std::array<double, 4>;

/// Homogeneous control point of a curve in a face's parameter plane: (w u, w v, w), w > 0.
using ControlPoint2 = std::array<double, 3>;

/// Rational Bezier curve of degree `points.size() - 1` over the parameter interval [t0, t1].
struct BezierCurve
{
  double t0 = 0;
  double t1 = 1;
  std::vector<ControlPoint> points;
};

/// Rational Bezier curve in a face's (u, v) plane: one piece of a trim loop. Its own parameter runs
/// over [0, 1], and has no meaning outside it.
struct BezierCurve2
{
  std::vector<ControlPoint2> points;
  std::int32_t edge = -1; ///< The CAD edge that it belongs to; -1: none.
  /// How far it lies off that edge (see trimSupport); infinite: not measured.
  double deviation = std::numeric_limits<double>::infinity();
};

/// Rational Bezier patch over [u0, u1] x [v0, v1]; control point (i, j), i along u and j along v,
/// is `points[i * (degreeV + 1) + j]`.
struct BezierPatch
{
  int degreeU = 1;
  int degreeV = 1;
  double u0 = 0;
  double u1 = 1;
  double v0 = 0;
  double v1 = 1;
  std::vector<ControlPoint> points;
};

/// Value and derivatives with respect to the curve's own parameter t in [t0, t1].
struct CurveDerivatives
{
  Point3 value;
  Vector3 t, tt;
};

/// Value and derivatives with respect to the patch's own parameters (u, v).
struct PatchDerivatives
{
  Point3 value;
  Vector3 u, v, uu, uv, vv;
};

Point2 evaluate(const BezierCurve2& curve, double t);
Point3 evaluate(const BezierCurve& curve, double t);
CurveDerivatives evaluateDerivatives(const BezierCurve& curve, double t);
Point3 evaluate(const BezierPatch& patch, double u, double v);
PatchDerivatives evaluateDerivatives(const BezierPatch& patch, double u, double v);

} // namespace cadrefine
