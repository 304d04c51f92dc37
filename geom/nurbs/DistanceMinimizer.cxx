#include <cadrefine/nurbs/DistanceMinimizer.h>

#include <algorithm>
#include <cmath>

namespace cadrefine
{
namespace
{

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
  const double floor = 1e-14 * (m.lengthS + m.lengthT) + 1e-150; // its square is not 0
  const double metricS = std::max(m.lengthS, floor);
  const double metricT = std::max(m.lengthT, floor);
  constexpr double smallest = 1e-9; // of an eigenvalue, relative to the metric
  const double aboveS = h.ss - smallest * metricS;
  const double aboveT = h.tt - smallest * metricT;
  if (aboveS > 0 && aboveT > 0 && aboveS * aboveT > h.st * h.st)
  {
    return false;
  }
  const double ss = h.ss / metricS;
  const double tt = h.tt / metricT;
  const double st = h.st / std::sqrt(metricS * metricT);
  const double least = 0.5 * (ss + tt) - std::sqrt(0.25 * (ss - tt) * (ss - tt) + st * st);
  const double shift = std::max(1e-3, std::abs(least)) - least;
  h.ss += shift * metricS;
  h.tt += shift * metricT;
  return true;
}

/// Least value over the box of the tangent plane to half the squared distance: a lower bound of
/// that where it is convex, also after rounding.
double tangentBound(const DistanceModel& m, const ParameterRectangle& box, double s, double t)
{
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
  double s = startS;
  double t = startT;
  const double coordinate = norm(q);
  DistanceModel here = distanceModel(patch, q, s, t);
  for (int step = 0; step < maximumSteps; ++step)
  {
    if (2.0 * tangentBound(here, box, s, t) > squaredLimit)
    {
      return { s, t, std::numeric_limits<double>::infinity() };
    }
    const bool modified = makePositiveDefinite(here);
    const ParameterRectangle reach = { box.s0 - s, box.s1 - s, box.t0 - t, box.t1 - t };
    const Point2 move = minimizeOverBox(here.quadratic, reach);
    const double slope = here.quadratic.gradientS * move[0] + here.quadratic.gradientT * move[1];
    const double length = squaredLength(here, move);
    if (!(slope < 0.0) || length <= 1e-32 * scale * scale)
    {
      break;
    }
    const auto moved = [&](double part) -> Point2
    {
      return { std::clamp(s + part * move[0], box.s0, box.s1),
        std::clamp(t + part * move[1], box.t0, box.t1) };
    };
    // What of half the squared distance is rounding, of points on the patch (some ten operations
    // with coordinates as large as those of q) and of the square: so much it may seem to grow.
    const double rounding = 1e-14 * (here.half + std::sqrt(here.half) * coordinate);
    if (!modified && length <= 1e-14 * scale * scale)
    {
      // Quadratic convergence: what is left after this step does not matter.
      const Point2 last = moved(1.0);
      const double left = squaredNorm(evaluateLocal(patch, last[0], last[1]) - q);
      return 0.5 * left <= here.half + rounding ? DistanceMinimizer{ last[0], last[1], left }
                                                : DistanceMinimizer{ s, t, 2.0 * here.half };
    }
    bool fell = false;
    for (double part = 1.0; part > 1e-9 && !fell; part *= 0.5)
    {
      const Point2 next = moved(part);
      DistanceModel there = distanceModel(patch, q, next[0], next[1]);
      fell = there.half <= here.half + 1e-4 * part * slope + rounding;
      if (fell)
      {
        s = next[0];
        t = next[1];
        here = there;
      }
    }
    if (!fell)
    {
      break;
    }
  }
  return { s, t, 2.0 * here.half };
}

} // namespace cadrefine
