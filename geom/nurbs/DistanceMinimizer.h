// Minimisation over a rectangle of parameters. Private to geom/nurbs.
#pragma once

#include <cadrefine/base/Vector3.h>
#include <cadrefine/nurbs/ParameterRectangle.h>
#include <cadrefine/nurbs/PatchView.h>

#include <limits>

namespace cadrefine
{

/// Quadratic model g.x + x.H x / 2 in two variables.
struct QuadraticModel
{
  double gradientS = 0;
  double gradientT = 0;
  double ss = 1;
  double st = 0;
  double tt = 1;
};

/// Minimiser over the steps in `box`, which contains the zero step. H must be positive definite.
Point2 minimizeOverBox(const QuadraticModel& model, const ParameterRectangle& box);

/// Foot of a perpendicular, or the nearest border point of a rectangle of parameters.
struct DistanceMinimizer
{
  double s = 0;
  double t = 0;
  double squaredDistance = 0;
};

/// Local minimum of |S(s, t) - q|^2 over `box` (local parameters) from the given start, by Newton
/// steps that solve the quadratic model over the box exactly, halved until the distance falls.
/// Global where the distance is convex over the box. Converges quadratically; ends after
/// 50 steps at worst, and then with the best point seen. `scale` is a length over which the patch
/// is smooth: it decides when a further step no longer matters.
/// Where the distance is convex over the box, gives up once nothing can be within the square root
/// of `squaredLimit`, with an infinite distance.
DistanceMinimizer minimizeDistance(const PatchView& patch, const Point3& q,
  const ParameterRectangle& box, double startS, double startT, double scale,
  double squaredLimit = std::numeric_limits<double>::infinity());

} // namespace cadrefine
