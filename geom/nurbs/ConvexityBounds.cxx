#include "ConvexityBounds.h"

#include "BernsteinForm.h"
#include "SquareMinimum.h"

#include <cmath>
#include <vector>

namespace cadrefine
{
namespace
{

/// Positive definiteness is asked for with this relative margin, far above rounding.
constexpr double margin = 1.0 + 1e-9;

struct IntervalVector
{
  std::array<Interval, 3> x;
  double largestNorm() const
  {
    return std::sqrt(x[0].magnitude() * x[0].magnitude() + x[1].magnitude() * x[1].magnitude() +
                     x[2].magnitude() * x[2].magnitude());
  }
};

/// Minimum of g x + a x^2 / 2 over [-1/2, 1/2], for any a.
double leastOverHalves(double a, double g)
{
  const double slope = std::abs(g);
  return slope < 0.5 * a ? -0.5 * g * g / a : 0.125 * a - 0.5 * slope;
}

} // namespace

/// Ranges of the control coefficients of the homogeneous derivatives, relative to the middle point.
struct ConvexityBounds::HomogeneousRanges
{
  Interval weight;
  IntervalVector offset; // S - c
  std::array<std::array<Interval, 4>, 5> derivative;

  HomogeneousRanges(const PatchView& patch, const Point3& c)
  {
    const Degrees degrees = { patch.degreeU, patch.degreeV };
    std::array<std::vector<double>, 4> component;
    offset.x.fill(Interval::empty());
    for (int i = 0; i < patch.count(); ++i)
    {
      const ControlPoint& p = patch.points[i];
      for (int k = 0; k < 3; ++k)
      {
        component[k].push_back(p[k] - c[k] * p[3]);
        offset.x[k].include(component[k].back() / p[3]);
      }
      component[3].push_back(p[3]);
    }
    constexpr int orders[5][2] = { { 1, 0 }, { 0, 1 }, { 2, 0 }, { 1, 1 }, { 0, 2 } };
    for (int k = 0; k < 4; ++k)
    {
      for (int order = 0; order < 5; ++order)
      {
        derivative[order][k] =
          derivativeRange(degrees, component[k].data(), orders[order][0], orders[order][1]);
      }
    }
    weight = derivativeRange(degrees, component[3].data(), 0, 0);
  }
};

Interval ConvexityBounds::VectorBounds::dotRange(const Vector3& k) const
{
  const double middleDot = dot(k, middle);
  const double spread =
    std::abs(k[0]) * radius[0] + std::abs(k[1]) * radius[1] + std::abs(k[2]) * radius[2];
  return { middleDot - spread, middleDot + spread };
}

double ConvexityBounds::VectorBounds::largestNorm() const
{
  return norm(middle) + norm(radius);
}

void ConvexityBounds::boundDerivatives(const HomogeneousRanges& r)
{
  enum
  {
    s,
    t,
    ss,
    st,
    tt
  };
  const auto& d = r.derivative;
  IntervalVector first[2];
  VectorBounds* second[3] = { &ss_, &st_, &tt_ };
  for (int k = 0; k < 3; ++k)
  {
    const Interval x = r.offset.x[k];
    const Interval xs = (d[s][k] - x * d[s][3]) / r.weight;
    const Interval xt = (d[t][k] - x * d[t][3]) / r.weight;
    const Interval bounds[3] = { (d[ss][k] - 2.0 * (xs * d[s][3]) - x * d[ss][3]) / r.weight,
      (d[st][k] - xs * d[t][3] - xt * d[s][3] - x * d[st][3]) / r.weight,
      (d[tt][k] - 2.0 * (xt * d[t][3]) - x * d[tt][3]) / r.weight };
    first[0].x[k] = xs;
    first[1].x[k] = xt;
    for (int order = 0; order < 3; ++order)
    {
      second[order]->middle[k] = bounds[order].middle();
      second[order]->radius[k] = bounds[order].radius();
    }
  }
  radius_ = r.offset.largestNorm();
  lengthS_ = first[0].largestNorm();
  lengthT_ = first[1].largestNorm();
}

void ConvexityBounds::boundOwnHessian(const PatchView& patch)
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
  ownSS_ = 0.5 * ((top(2, 0) - 2.0 * (fs * ws) - ratio * bottom(2, 0)) / w);
  ownST_ = 0.5 * ((top(1, 1) - fs * wt - ft * ws - ratio * bottom(1, 1)) / w);
  ownTT_ = 0.5 * ((top(0, 2) - 2.0 * (ft * wt) - ratio * bottom(0, 2)) / w);
  if (patch.isCurve())
  {
    ownTT_ = { 1.0, 1.0 }; // the second parameter has no effect: any convex function of it will do
  }
}

ConvexityBounds::ConvexityBounds(const PatchView& patch)
{
  const PatchDerivatives atMiddle = evaluateLocalDerivatives(patch, 0.5, 0.5);
  middle_ = atMiddle.value;
  tangentS_ = atMiddle.u;
  tangentT_ = atMiddle.v;
  boundDerivatives(HomogeneousRanges(patch, middle_));
  boundOwnHessian(patch);
  const double scaleS = lengthS_ > 0 ? 1.0 / lengthS_ : 0.0;
  const double scaleT = lengthT_ > 0 ? 1.0 / lengthT_ : 0.0;
  const double twist = st_.largestNorm();
  variationS_ = ss_.largestNorm() * scaleS + twist * scaleT;
  variationT_ = tt_.largestNorm() * scaleT + twist * scaleS;
}

ConvexityBounds::Answer ConvexityBounds::ask(const Point3& q) const
{
  const Vector3 k = middle_ - q;
  const Interval rangeSS = ss_.dotRange(k);
  const Interval rangeST = st_.dotRange(k);
  const Interval rangeTT = tt_.dotRange(k);
  const double a = ownSS_.low + rangeSS.low;
  const double d = ownTT_.low + rangeTT.low;
  const double b = (ownST_ + rangeST).magnitude();
  Answer answer;
  answer.convex = a > 0 && d > 0 && a * d > margin * b * b;
  // a x^2 - 2 b |x y| + d y^2 >= (a - b r) x^2 + (d - b / r) y^2 for any r > 0.
  const double gradientS = dot(k, tangentS_);
  const double gradientT = dot(k, tangentT_);
  const double r = answer.convex ? std::sqrt(a / d) : 1.0;
  answer.squaredDistanceBound = squaredNorm(k) + 2.0 * (leastOverHalves(a - b * r, gradientS) +
                                                         leastOverHalves(d - b / r, gradientT));
  if (!answer.convex)
  {
    return answer;
  }
  const QuadraticModel model = { gradientS, gradientT, ownSS_.middle() + rangeSS.middle(),
    ownST_.middle() + rangeST.middle(), ownTT_.middle() + rangeTT.middle() };
  const Point2 step = minimizeOverBox(model, { -0.5, 0.5, -0.5, 0.5 });
  answer.s = 0.5 + step[0];
  answer.t = 0.5 + step[1];
  return answer;
}

} // namespace cadrefine
