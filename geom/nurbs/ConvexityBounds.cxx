#include <cadrefine/nurbs/ConvexityBounds.h>

#include <cadrefine/nurbs/DistanceMinimizer.h>
#include <cadrefine/nurbs/RationalForm.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace cadrefine
{
namespace
{

/// Positive definiteness is asked for with this relative margin, far above rounding.
constexpr double margin = 1.0 + 1e-9;

double largestNorm(const std::array<Interval, 3>& v)
{
  return norm({ v[0].magnitude(), v[1].magnitude(), v[2].magnitude() });
}

float roundedUp(double x)
{
  const auto near = static_cast<float>(x);
  return near < x ? std::nextafter(near, std::numeric_limits<float>::infinity()) : near;
}

/// Minimum of g x + a x^2 / 2 over [-1/2, 1/2], for any a.
double leastOverHalves(double a, double g)
{
  const double slope = std::abs(g);
  return slope < 0.5 * a ? -0.5 * g * g / a : 0.125 * a - 0.5 * slope;
}

} // namespace

/// Enclosures of the offset from the middle point and of the derivatives, in the patch's frame.
struct ConvexityBounds::Ranges
{
  std::array<Interval, 3> offset, s, t, ss, st, tt;
};

ConvexityBounds::VectorBounds::VectorBounds(const std::array<Interval, 3>& bounds)
{
  // The frame is orthonormal to within 2e-7, so scalar products in it are wrong by up to this part.
  constexpr double frameError = 4e-7;
  const double spread = frameError * cadrefine::largestNorm(bounds);
  for (int k = 0; k < 3; ++k)
  {
    middle[k] = static_cast<float>(bounds[k].middle());
    radius[k] = roundedUp(bounds[k].radius() + std::abs(bounds[k].middle() - middle[k]) + spread);
  }
}

Interval ConvexityBounds::VectorBounds::dotRange(const Vector3& k) const
{
  const double middleDot = k[0] * middle[0] + k[1] * middle[1] + k[2] * middle[2];
  const double spread =
    std::abs(k[0]) * radius[0] + std::abs(k[1]) * radius[1] + std::abs(k[2]) * radius[2];
  return { middleDot - spread, middleDot + spread };
}

double ConvexityBounds::VectorBounds::largestNorm() const
{
  return norm({ middle[0], middle[1], middle[2] }) + norm({ radius[0], radius[1], radius[2] });
}

ConvexityBounds::RoundedInterval ConvexityBounds::rounded(Interval x)
{
  return { -roundedUp(-x.low), roundedUp(x.high) };
}

void ConvexityBounds::chooseFrame(const Vector3& tangentS, const Vector3& tangentT)
{
  const Vector3 along = normalized(squaredNorm(tangentS) > 0 ? tangentS : tangentT);
  const Vector3 normal = normalized(cross(tangentS, tangentT));
  std::array<Vector3, 3> frame = { Vector3{ 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
  if (squaredNorm(normal) > 0)
  {
    frame = { along, cross(normal, along), normal };
  }
  else if (squaredNorm(along) > 0)
  {
    const auto least = std::min_element(
      along.begin(), along.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
    const Vector3 across = normalized(cross(along, frame[least - along.begin()]));
    frame = { along, across, cross(along, across) };
  }
  for (int row = 0; row < 3; ++row)
  {
    std::copy(frame[row].begin(), frame[row].end(), frame_[row].begin());
  }
}

Vector3 ConvexityBounds::toFrame(const Vector3& v) const
{
  const auto along = [&](const std::array<float, 3>& axis)
  { return axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2]; };
  return { along(frame_[0]), along(frame_[1]), along(frame_[2]) };
}

ConvexityBounds::Ranges ConvexityBounds::rangesOf(const PatchView& patch) const
{
  const Degrees degrees = { patch.degreeU, patch.degreeV };
  Form fullWeight{ degrees, {} };
  std::array<Quotient, 3> component;
  component.fill({ { degrees, {} }, 1 });
  Ranges r;
  r.offset.fill(Interval::empty());
  for (int i = 0; i < patch.count(); ++i)
  {
    const ControlPoint& p = patch.points[i];
    const Vector3 offset =
      toFrame({ p[0] - middle_[0] * p[3], p[1] - middle_[1] * p[3], p[2] - middle_[2] * p[3] });
    for (int k = 0; k < 3; ++k)
    {
      component[k].top.c.push_back(offset[k]);
      r.offset[k].include(offset[k] / p[3]);
    }
    fullWeight.c.push_back(p[3]);
  }
  const Form weight = withoutConstantDirections(fullWeight);
  for (int k = 0; k < 3; ++k)
  {
    const Quotient alongS = derivative(component[k], weight, true);
    const Quotient alongT = derivative(component[k], weight, false);
    r.s[k] = rangeOf(alongS, weight);
    r.t[k] = rangeOf(alongT, weight);
    r.ss[k] = slopeRange(alongS, r.s[k], weight, true);
    r.st[k] = intersection(
      slopeRange(alongS, r.s[k], weight, false), slopeRange(alongT, r.t[k], weight, true));
    r.tt[k] = slopeRange(alongT, r.t[k], weight, false);
  }
  return r;
}

/// Encloses the Hessian from the derivatives of the patch: sharp where it is long and narrow, and
/// its weights vary.
ConvexityBounds::Hessian ConvexityBounds::hessianByParts(const Ranges& r)
{
  Hessian h;
  for (int k = 0; k < 3; ++k)
  {
    h.ss = h.ss + square(r.s[k]) + r.offset[k] * r.ss[k];
    h.st = h.st + r.s[k] * r.t[k] + r.offset[k] * r.st[k];
    h.tt = h.tt + square(r.t[k]) + r.offset[k] * r.tt[k];
  }
  return h;
}

/// Encloses the Hessian from the Bernstein form of |S - c|^2: sharp where the parameter lines
/// spread, as at poles.
ConvexityBounds::Hessian ConvexityBounds::hessianByForm(const PatchView& patch) const
{
  const Degrees degrees = { 2 * patch.degreeU, 2 * patch.degreeV };
  std::vector<double> numerator(degrees.count());
  std::vector<double> denominator(degrees.count());
  squaredDistanceForm(patch, middle_, numerator.data(), denominator.data());
  Interval ratio = Interval::empty();
  for (int i = 0; i < degrees.count(); ++i)
  {
    ratio.include(numerator[i] / denominator[i]);
  }
  const auto top = [&](int a, int b) { return derivativeRange(degrees, numerator.data(), a, b); };
  const auto bottom = [&](int a, int b)
  { return derivativeRange(degrees, denominator.data(), a, b); };
  const Interval w = bottom(0, 0);
  const Interval ws = bottom(1, 0);
  const Interval wt = bottom(0, 1);
  const Interval fs = (top(1, 0) - ratio * ws) / w;
  const Interval ft = (top(0, 1) - ratio * wt) / w;
  return { 0.5 * ((top(2, 0) - 2.0 * (fs * ws) - ratio * bottom(2, 0)) / w),
    0.5 * ((top(1, 1) - fs * wt - ft * ws - ratio * bottom(1, 1)) / w),
    0.5 * ((top(0, 2) - 2.0 * (ft * wt) - ratio * bottom(0, 2)) / w) };
}

void ConvexityBounds::boundOwnHessian(const PatchView& patch, const Ranges& ranges)
{
  const Hessian a = hessianByParts(ranges);
  const Hessian b = hessianByForm(patch);
  ownSS_ = rounded(intersection(a.ss, b.ss));
  ownST_ = rounded(intersection(a.st, b.st));
  ownTT_ = rounded(intersection(a.tt, b.tt));
  if (patch.isCurve())
  {
    // The second parameter has no effect: any convex function of it, as small as the rest, will do.
    const double length = cadrefine::largestNorm(ranges.s);
    ownTT_ = rounded({ length * length, length * length });
  }
}

ConvexityBounds::ConvexityBounds(const PatchView& patch)
{
  const PatchDerivatives atMiddle = evaluateLocalDerivatives(patch, 0.5, 0.5);
  middle_ = atMiddle.value;
  chooseFrame(atMiddle.u, atMiddle.v);
  tangentS_ = atMiddle.u;
  tangentT_ = atMiddle.v;
  const Ranges r = rangesOf(patch);
  boundOwnHessian(patch, r);
  ss_ = VectorBounds(r.ss);
  st_ = VectorBounds(r.st);
  tt_ = VectorBounds(r.tt);
  constexpr double frameError = 1e-6;
  radius_ = roundedUp((1.0 + frameError) * largestNorm(r.offset));
  lengthS_ = roundedUp((1.0 + frameError) * largestNorm(r.s));
  lengthT_ = roundedUp((1.0 + frameError) * largestNorm(r.t));
  const double scaleS = lengthS_ > 0 ? 1.0 / lengthS_ : 0.0;
  const double scaleT = lengthT_ > 0 ? 1.0 / lengthT_ : 0.0;
  const double twist = st_.largestNorm();
  variationS_ = static_cast<float>(ss_.largestNorm() * scaleS + twist * scaleT);
  variationT_ = static_cast<float>(tt_.largestNorm() * scaleT + twist * scaleS);
}

ConvexityBounds::Answer ConvexityBounds::ask(const Point3& q) const
{
  const Vector3 k = middle_ - q;
  const Vector3 inFrame = toFrame(k);
  const Interval ownSS = ownSS_;
  const Interval ownTT = ownTT_;
  const Interval rangeSS = ss_.dotRange(inFrame);
  const Interval rangeTT = tt_.dotRange(inFrame);
  const Interval hessianSS = ownSS + rangeSS;
  const Interval hessianST = ownST_ + st_.dotRange(inFrame);
  const Interval hessianTT = ownTT + rangeTT;
  const double a = hessianSS.low;
  const double d = hessianTT.low;
  const double b = hessianST.magnitude();
  Answer answer;
  answer.convex = a > 0 && d > 0 && a * d > margin * b * b;
  // a x^2 - 2 b |x y| + d y^2 >= (a - b r) x^2 + (d - b / r) y^2 for any r > 0.
  const double gradientS = dot(k, tangentS_);
  const double gradientT = dot(k, tangentT_);
  const double r = answer.convex ? std::sqrt(a / d) : 1.0;
  const double twistS = b * r;
  const double twistT = b / r;
  answer.squaredDistanceBound = squaredNorm(k) + 2.0 * (leastOverHalves(a - twistS, gradientS) +
                                                         leastOverHalves(d - twistT, gradientT));
  // What the terms may have lost by rounding: close to the patch they cancel, and a bound that is
  // wrong by 1e-16 of the patch's squared size would hide points 1e-8 of its size away.
  constexpr double rounding = 32 * std::numeric_limits<double>::epsilon();
  const double terms = squaredNorm(k) + std::abs(gradientS) + std::abs(gradientT) +
                       ownSS.magnitude() + ownTT.magnitude() + rangeSS.magnitude() +
                       rangeTT.magnitude() + twistS + twistT;
  answer.squaredDistanceBound -= rounding * terms;
  if (!answer.convex)
  {
    return answer;
  }
  const QuadraticModel model = { gradientS, gradientT, hessianSS.middle(), hessianST.middle(),
    hessianTT.middle() };
  const Point2 step = minimizeOverBox(model, { -0.5, 0.5, -0.5, 0.5 });
  answer.s = 0.5 + step[0];
  answer.t = 0.5 + step[1];
  return answer;
}

} // namespace cadrefine
