#include <cadrefine/nurbs/DistanceMinimizer.h>

#include <algorithm>
#include <cmath>

namespace cadrefine
{
namespace
{

/// When minimizeDistance accepts a step, and when it stops. All are ratios.
struct Tolerances
{
  /// Metric of a parameter to that of both, at least: less is found where a side of the patch has
  /// shrunk to a point, so that one parameter moves nothing.
  static constexpr double leastMetric = 1e-14;
  /// Eigenvalue of the Hessian to the metric, at least (it is 1 near the patch): far above
  /// rounding.
  static constexpr double leastEigenvalue = 1e-9;
  /// Eigenvalue to the metric of a Hessian that was made definite: its steps are at most a thousand
  /// times as long as those of steepest descent.
  static constexpr double shiftedEigenvalue = 1e-3;
  /// Squared length of a step to that of `scale`: it changes no digit.
  static constexpr double noStep = 1e-32;
  /// Squared length of the last step to that of `scale`: by quadratic convergence what is left
  /// after it does not matter, 1e-14 of the scale.
  static constexpr double lastStep = 1e-14;
  /// Part of half the squared distance that is rounding, of points on the patch (some ten
  /// operations with coordinates as large as those of q) and of the square: so much it may seem to
  /// grow.
  static constexpr double rounding = 1e-14;
  /// Fall of half the squared distance to that of its tangent, at least (L. Armijo 1966).
  static constexpr double leastFall = 1e-4;
  /// How often a step is halved: if 2e-9 of it is too far, only rounding hides the fall.
  static constexpr int maximumHalvings = 29;
};

/// Minimiser of a x^2 / 2 + b x over [low, high], a > 0.
double minimizeOverInterval(double a, double b, double low, double high)
{
  return std::clamp(-b / a, low, high);
}

/// Half the squared distance at one point with gradient and Hessian, and the metric J^T J.
struct DistanceModel
{
  double half = 0;
  QuadraticModel quadratic;
  double lengthS = 0; // |dS/ds|^2
  double lengthT = 0;
  double lengthST = 0;
};

/// A point of the patch.
struct Iterate
{
  double s;
  double t;
  DistanceModel model;
};

DistanceModel distanceModel(const PatchView& patch, const Point3& q, double s, double t)
{
  const PatchDerivatives d = evaluateLocalDerivatives(patch, s, t);
  const Vector3 r = d.value - q;
  DistanceModel m;
  m.half = 0.5 * squaredNorm(r);
  m.lengthS = squaredNorm(d.u);
  m.quadratic.gradientS = dot(r, d.u);
  m.quadratic.ss = m.lengthS + dot(r, d.uu);
  if (patch.isCurve())
  {
    // The second parameter has no effect; of the same magnitude, for any size of the model.
    m.lengthT = m.quadratic.tt = m.lengthS > 0 ? m.lengthS : 1.0;
    return m;
  }
  m.lengthT = squaredNorm(d.v);
  m.lengthST = dot(d.u, d.v);
  m.quadratic.gradientT = dot(r, d.v);
  m.quadratic.st = m.lengthST + dot(r, d.uv);
  m.quadratic.tt = m.lengthT + dot(r, d.vv);
  return m;
}

/// Adds a multiple of the metric's diagonal to an indefinite Hessian until it is positive definite
/// (Levenberg). Returns whether it had to.
bool makePositiveDefinite(DistanceModel& m)
{
  QuadraticModel& h = m.quadratic;
  const double floor =
    Tolerances::leastMetric * (m.lengthS + m.lengthT) + 1e-150; // its square is not 0
  const double metricS = std::max(m.lengthS, floor);
  const double metricT = std::max(m.lengthT, floor);
  const double aboveS = h.ss - Tolerances::leastEigenvalue * metricS;
  const double aboveT = h.tt - Tolerances::leastEigenvalue * metricT;
  if (aboveS > 0 && aboveT > 0 && aboveS * aboveT > h.st * h.st)
  {
    return false;
  }
  const double ss = h.ss / metricS;
  const double tt = h.tt / metricT;
  const double st = h.st / std::sqrt(metricS * metricT);
  const double least = 0.5 * (ss + tt) - std::sqrt(0.25 * (ss - tt) * (ss - tt) + st * st);
  const double shift = std::max(Tolerances::shiftedEigenvalue, std::abs(least)) - least;
  h.ss += shift * metricS;
  h.tt += shift * metricT;
  return true;
}

/// Least value over the box of the tangent plane to half the squared distance: a lower bound of
/// that where it is convex, also after rounding.
double tangentBound(const Iterate& here, const ParameterRectangle& box)
{
  const auto& [s, t, m] = here;
  const double gradientS = m.quadratic.gradientS;
  const double gradientT = m.quadratic.gradientT;
  const double fallS = gradientS * ((gradientS > 0 ? box.s0 : box.s1) - s);
  const double fallT = gradientT * ((gradientT > 0 ? box.t0 : box.t1) - t);
  constexpr double rounding = 32 * std::numeric_limits<double>::epsilon();
  return m.half + fallS + fallT - rounding * (m.half - fallS - fallT);
}

double squaredLength(const DistanceModel& m, const Point2& step)
{
  return m.lengthS * step[0] * step[0] + 2.0 * m.lengthST * step[0] * step[1] +
         m.lengthT * step[1] * step[1];
}

Point2 pointAlong(
  const Iterate& here, const Point2& move, double part, const ParameterRectangle& box)
{
  return { std::clamp(here.s + part * move[0], box.s0, box.s1),
    std::clamp(here.t + part * move[1], box.t0, box.t1) };
}

/// Goes the step, or the first of its half, quarter and so on after which the distance has fallen
/// enough. Returns whether it has.
bool goAlong(const Point2& move, double slope, const PatchView& patch, const Point3& q,
  const ParameterRectangle& box, double rounding, Iterate& here)
{
  double part = 1.0;
  for (int halving = 0; halving <= Tolerances::maximumHalvings; ++halving, part *= 0.5)
  {
    const auto [s, t] = pointAlong(here, move, part, box);
    const DistanceModel there = distanceModel(patch, q, s, t);
    if (there.half <= here.model.half + Tolerances::leastFall * part * slope + rounding)
    {
      here = { s, t, there };
      return true;
    }
  }
  return false;
}

} // namespace

Point2 minimizeOverBox(const QuadraticModel& m, const ParameterRectangle& box)
{
  const double determinant = m.ss * m.tt - m.st * m.st;
  const double s = (m.st * m.gradientT - m.tt * m.gradientS) / determinant;
  const double t = (m.st * m.gradientS - m.ss * m.gradientT) / determinant;
  if (s >= box.s0 && s <= box.s1 && t >= box.t0 && t <= box.t1)
  {
    return { s, t };
  }
  Point2 best{};
  double least = 0.0;
  const auto tryStep = [&](double x, double y)
  {
    const double value =
      m.gradientS * x + m.gradientT * y + 0.5 * (m.ss * x * x + m.tt * y * y) + m.st * x * y;
    if (value < least)
    {
      least = value;
      best = { x, y };
    }
  };
  for (const double x : { box.s0, box.s1 })
  {
    tryStep(x, minimizeOverInterval(m.tt, m.gradientT + m.st * x, box.t0, box.t1));
  }
  for (const double y : { box.t0, box.t1 })
  {
    tryStep(minimizeOverInterval(m.ss, m.gradientS + m.st * y, box.s0, box.s1), y);
  }
  return best;
}

DistanceMinimizer minimizeDistance(const PatchView& patch, const Point3& q,
  const ParameterRectangle& box, double startS, double startT, double scale, double squaredLimit)
{
  constexpr int maximumSteps = 50;
  const double coordinate = norm(q);
  Iterate here = { startS, startT, distanceModel(patch, q, startS, startT) };
  for (int step = 0; step < maximumSteps; ++step)
  {
    if (2.0 * tangentBound(here, box) > squaredLimit)
    {
      return { here.s, here.t, std::numeric_limits<double>::infinity() };
    }
    const bool modified = makePositiveDefinite(here.model);
    const auto& [s, t, m] = here;
    const Point2 move =
      minimizeOverBox(m.quadratic, { box.s0 - s, box.s1 - s, box.t0 - t, box.t1 - t });
    const double slope = m.quadratic.gradientS * move[0] + m.quadratic.gradientT * move[1];
    const double length = squaredLength(m, move);
    if (!(slope < 0.0) || length <= Tolerances::noStep * scale * scale)
    {
      break;
    }
    const double rounding = Tolerances::rounding * (m.half + std::sqrt(m.half) * coordinate);
    if (!modified && length <= Tolerances::lastStep * scale * scale)
    {
      const Point2 last = pointAlong(here, move, 1.0, box);
      const double left = squaredNorm(evaluateLocal(patch, last[0], last[1]) - q);
      return 0.5 * left <= m.half + rounding ? DistanceMinimizer{ last[0], last[1], left }
                                             : DistanceMinimizer{ s, t, 2.0 * m.half };
    }
    if (!goAlong(move, slope, patch, q, box, rounding, here))
    {
      break;
    }
  }
  return { here.s, here.t, 2.0 * here.model.half };
}

} // namespace cadrefine
