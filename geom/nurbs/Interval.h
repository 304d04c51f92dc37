// Interval arithmetic, to first order (no directed rounding). Private to geom/nurbs.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace cadrefine
{

struct Interval
{
  double low = 0;
  double high = 0;

  static Interval empty()
  {
    return { std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity() };
  }
  void include(double x)
  {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  double magnitude() const { return std::max(std::abs(low), std::abs(high)); }
  double middle() const { return 0.5 * (low + high); }
  double radius() const { return 0.5 * (high - low); }
};

inline Interval operator+(Interval a, Interval b)
{
  return { a.low + b.low, a.high + b.high };
}

inline Interval operator-(Interval a, Interval b)
{
  return { a.low - b.high, a.high - b.low };
}

inline Interval operator*(double s, Interval a)
{
  return s >= 0 ? Interval{ s * a.low, s * a.high } : Interval{ s * a.high, s * a.low };
}

inline Interval operator*(Interval a, Interval b)
{
  Interval product = Interval::empty();
  product.include(a.low * b.low);
  product.include(a.low * b.high);
  product.include(a.high * b.low);
  product.include(a.high * b.high);
  return product;
}

/// The intersection of two intervals that have a number in common; rounding may have left them a
/// little apart.
inline Interval intersection(Interval a, Interval b)
{
  return { std::min(std::max(a.low, b.low), std::min(a.high, b.high)),
    std::max(std::max(a.low, b.low), std::min(a.high, b.high)) };
}

inline Interval square(Interval a)
{
  const double least = a.low > 0 ? a.low : a.high < 0 ? a.high : 0.0;
  return { least * least, a.magnitude() * a.magnitude() };
}

/// Quotient by an interval of positive numbers.
inline Interval operator/(Interval a, Interval positive)
{
  return a * Interval{ 1.0 / positive.high, 1.0 / positive.low };
}

} // namespace cadrefine
