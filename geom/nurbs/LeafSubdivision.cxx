#include <cadrefine/nurbs/LeafSubdivision.h>

#include <cadrefine/nurbs/BezierSubdivision.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace cadrefine
{
namespace
{

/// Multiplications, roughly, that one query may spend on subdivision.
constexpr double workLimit = 4e7;
/// Rectangles shorter than this part of the search tolerance are not split that way: the distance
/// varies less over them than matters, and where loops cut them their border is as near.
constexpr double smallestLength = 0.25;

std::vector<double>& threadScratch(int which)
{
  thread_local std::vector<double> scratch[2];
  return scratch[which];
}

/// Minimum of g x + a x^2 / 2 over [-1/2, 1/2], for any a.
double leastOverHalves(double a, double g)
{
  const double slope = std::abs(g);
  return slope < 0.5 * a ? -0.5 * g * g / a : 0.125 * a - 0.5 * slope;
}

/// Bound of a function over the square from its middle value, gradient and second derivatives.
double secondOrderBound(const MiddleValue& middle, double ss, double st, double tt)
{
  const double ratio = ss > 0 && tt > 0 ? std::sqrt(ss / tt) : 1.0;
  return middle.value + leastOverHalves(ss - st * ratio, middle.s) +
         leastOverHalves(tt - st / ratio, middle.t);
}

} // namespace

bool LeafSubdivision::Curvature::isConvex() const
{
  constexpr double margin = 1.0 + 1e-9;
  const double twist = st.magnitude();
  return ss.low > 0 && tt.low > 0 && ss.low * tt.low > margin * twist * twist;
}

LeafSubdivision::LeafSubdivision(LeafQuery& query, const SearchLeaf& leaf)
  : query_(query), leaf_(leaf), forms_(threadScratch(0)), level_(threadScratch(1))
{
  const PatchView& view = query.structure_.patches[leaf.patch].view;
  degrees_ = { 2 * view.degreeU, 2 * view.degreeV };
}

double* LeafSubdivision::numerator(int entry) const
{
  return forms_.data() + static_cast<std::size_t>(2 * entry) * degrees_.count();
}

double* LeafSubdivision::denominator(int entry) const
{
  return numerator(entry) + degrees_.count();
}

bool LeafSubdivision::spend(double work)
{
  query_.work_ += work;
  query_.converged_ = query_.converged_ && query_.work_ <= workLimit;
  return query_.work_ <= workLimit;
}

void LeafSubdivision::solveIn(const ParameterRectangle& box, const Part& start)
{
  query_.solve(leaf_, box, start.rectangle.middleS(), start.rectangle.middleT());
}

/// Range of the ratio of the coefficients, which encloses that of the squared distance.
Interval LeafSubdivision::ratioRange(int entry) const
{
  Interval ratio = Interval::empty();
  const double* top = numerator(entry);
  const double* bottom = denominator(entry);
  for (int i = 0; i < degrees_.count(); ++i)
  {
    ratio.include(top[i] / bottom[i]);
  }
  return ratio;
}

/// Bounds the rounding errors. Coefficients of the first entry carry errors relative to the largest
/// of them, and so do those of its parts, which are averages of them.
void LeafSubdivision::boundRounding()
{
  constexpr double rounding = 8 * std::numeric_limits<double>::epsilon();
  const double* bottom = denominator(0);
  const double largestWeight = *std::max_element(bottom, bottom + degrees_.count());
  ratioRounding_ = rounding * ratioRange(0).high;
  formRounding_ = ratioRounding_ * largestWeight;
}

void LeafSubdivision::fillForms()
{
  const PatchView& view = query_.structure_.patches[leaf_.patch].view;
  const std::vector<ControlPoint> points = restrictPatch(view, leaf_.part());
  level_.resize(degrees_.count());
  forms_.resize(std::max<std::size_t>(forms_.size(), 2 * degrees_.count()));
  squaredDistanceForm(
    { points.data(), view.degreeU, view.degreeV }, query_.q_, numerator(0), denominator(0));
  boundRounding();
}

void LeafSubdivision::run()
{
  const auto isFound = [this] { return query_.candidates_.nearest() <= query_.tolerance_; };
  const double count = degrees_.count();
  if (!isFound())
  {
    if (!spend(count * count))
    {
      return;
    }
    fillForms();
    if (!query_.isWithinLimit(ratioRange(0).low - ratioRounding_))
    {
      return;
    }
  }
  stack_ = { { leaf_.part(), query_.trimOf(leaf_) != nullptr } };
  solveIn(leaf_.part(), stack_.front()); // even then: an entity of a smaller id may be as near
  const double cost = count * (degrees_.s + degrees_.t + 12.0);
  while (!stack_.empty() && !isFound() && spend(cost))
  {
    const int last = static_cast<int>(stack_.size()) - 1;
    if (isDropped(last))
    {
      stack_.pop_back();
    }
    else
    {
      split(last);
    }
  }
}

bool LeafSubdivision::isTrimmedAway(Part& part) const
{
  if (!part.cut)
  {
    return false;
  }
  const SearchPatch& patch = query_.structure_.patches[leaf_.patch];
  const auto low = patch.parametersAt(part.rectangle.s0, part.rectangle.t0);
  const auto high = patch.parametersAt(part.rectangle.s1, part.rectangle.t1);
  const TrimCover cover = query_.trimOf(leaf_)->classify({ low[0], high[0], low[1], high[1] });
  part.cut = cover == TrimCover::cut;
  return cover == TrimCover::out;
}

/// Fills the scratch with the form numerator - level * denominator.
void LeafSubdivision::fillLevel(int entry, double level) const
{
  const double* top = numerator(entry);
  const double* bottom = denominator(entry);
  for (int i = 0; i < degrees_.count(); ++i)
  {
    level_[i] = top[i] - level * bottom[i];
  }
}

LeafSubdivision::Curvature LeafSubdivision::curvature(int entry, double level) const
{
  fillLevel(entry, level);
  Curvature c;
  c.ss = derivativeRange(degrees_, level_.data(), 2, 0);
  c.st = derivativeRange(degrees_, level_.data(), 1, 1);
  c.tt = degrees_.t > 0 ? derivativeRange(degrees_, level_.data(), 0, 2) : Interval{ 1.0, 1.0 };
  return c;
}

/// Whether step 3 drops an entry, for distances with squares from `lowest` to `highest`. The sign
/// of the derivative of the squared distance, where it is m, is that of numerator - m *
/// denominator, which is linear in m.
bool LeafSubdivision::isMonotone(int entry, double lowest, double highest) const
{
  const Part& part = stack_[entry];
  const auto& joined = query_.structure_.patches[leaf_.patch].joined;
  // Across the low side of s, the high one, then t: does anything that is looked at lie beyond?
  const auto isOpen = [&](int side, bool inside) { return inside || (part.cut && !joined[side]); };
  const bool open[4] = { isOpen(0, part.rectangle.s0 > 0), isOpen(1, part.rectangle.s1 < 1),
    isOpen(2, part.rectangle.t0 > 0), isOpen(3, part.rectangle.t1 < 1) };
  bool rises[2] = { true, true };
  bool falls[2] = { true, true };
  for (const double level : { lowest, highest })
  {
    fillLevel(entry, level);
    for (int direction = 0; direction < 2; ++direction)
    {
      const Interval slope = derivativeRange(degrees_, level_.data(), 1 - direction, direction);
      const double rounding = 1e-9 * slope.magnitude();
      rises[direction] = rises[direction] && slope.low > rounding;
      falls[direction] = falls[direction] && slope.high < -rounding;
    }
  }
  return (rises[0] && open[0]) || (falls[0] && open[1]) || (rises[1] && open[2]) ||
         (falls[1] && open[3]);
}

/// Does steps 1 to 3 for the last entry. Returns true where nothing is left to be found in it.
bool LeafSubdivision::isDropped(int entry)
{
  Part& part = stack_[entry];
  if (isTrimmedAway(part))
  {
    return true;
  }
  const Interval ratio = ratioRange(entry);
  const double known = query_.candidates_.nearest();
  const double wanted = known - query_.tolerance_;
  if (wanted <= 0 || ratio.low - ratioRounding_ >= wanted * wanted)
  {
    return true;
  }
  const double level = std::min(wanted * wanted, ratio.high);
  const Curvature c = curvature(entry, level);
  const MiddleValue middle = middleValue(degrees_, level_.data());
  if (level < ratio.high &&
      secondOrderBound(middle, c.ss.low, c.st.magnitude(), c.tt.low) >= formRounding_)
  {
    return true;
  }
  if (c.isConvex() && curvature(entry, std::min(known * known, ratio.high)).isConvex() &&
      curvature(entry, ratio.low).isConvex())
  {
    solveIn(part.rectangle, part);
    return true;
  }
  if (isMonotone(entry, ratio.low, std::min(known * known, ratio.high)))
  {
    return true;
  }
  if (middle.value < 0)
  {
    solveIn(leaf_.cut ? part.rectangle : leaf_.part(), part);
  }
  return !canSplit(part, true) && !canSplit(part, false);
}

bool LeafSubdivision::canSplit(const Part& part, bool acrossS) const
{
  const double shortest = smallestLength * query_.tolerance_;
  const ConvexityBounds& bounds = leaf_.bounds;
  return acrossS ? degrees_.s > 0 &&
                     bounds.lengthS() * part.rectangle.width() > shortest * leaf_.part().width()
                 : degrees_.t > 0 &&
                     bounds.lengthT() * part.rectangle.height() > shortest * leaf_.part().height();
}

/// Whether to split across s: the direction in which the distance bends more is taken; where it
/// hardly bends, that of larger slope.
bool LeafSubdivision::cutsAcrossS(
  const Part& part, const Curvature& c, const MiddleValue& middle) const
{
  if (!canSplit(part, true) || !canSplit(part, false))
  {
    return canSplit(part, true);
  }
  constexpr double nearlyLinear = 0.1;
  const double bendS = c.ss.magnitude();
  const double bendT = c.tt.magnitude();
  const double slopeS = std::abs(middle.s);
  const double slopeT = std::abs(middle.t);
  return std::max(bendS, bendT) < nearlyLinear * std::max(slopeS, slopeT) ? slopeS >= slopeT
                                                                          : bendS >= bendT;
}

void LeafSubdivision::split(int entry)
{
  const double level = query_.candidates_.nearest() - query_.tolerance_;
  const Curvature c = curvature(entry, std::isfinite(level) ? level * level : 0.0);
  const MiddleValue middle = middleValue(degrees_, level_.data());
  const bool acrossS = cutsAcrossS(stack_[entry], c, middle);
  forms_.resize(std::max<std::size_t>(
    forms_.size(), static_cast<std::size_t>(2 * entry + 4) * degrees_.count()));
  splitForm(degrees_, acrossS, numerator(entry), numerator(entry + 1));
  splitForm(degrees_, acrossS, denominator(entry), denominator(entry + 1));
  const Part whole = stack_[entry];
  Part upper = { whole.rectangle.half(acrossS, true), whole.cut };
  Part lower = { whole.rectangle.half(acrossS, false), whole.cut };
  if ((acrossS ? middle.s : middle.t) < 0) // the upper half looks better: it goes on top
  {
    std::swap(upper, lower);
    std::swap_ranges(numerator(entry), numerator(entry + 1), numerator(entry + 1));
  }
  stack_[entry] = upper;
  stack_.push_back(lower);
}

} // namespace cadrefine
