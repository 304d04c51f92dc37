// Derivatives of rational Bernstein forms, without the overestimation of interval quotients.
// Private to geom/nurbs.
#pragma once

#include <cadrefine/nurbs/BernsteinForm.h>

#include <vector>

namespace cadrefine
{

/// A scalar tensor product polynomial in Bernstein form over the unit square.
struct Form
{
  Degrees degrees;
  std::vector<double> c;
};

/// The same polynomial with degree 0 in the directions in which it is constant.
Form withoutConstantDirections(const Form& form);

/// top / weight^power. The weight is common to many and kept elsewhere.
struct Quotient
{
  Form top;
  int power = 1;
};

/// Derivative along s or t, exact: its numerator is worked out in full, so that what cancels does.
/// O(size of the numerator times size of the weight).
Quotient derivative(const Quotient& quotient, const Form& weight, bool alongS);

/// Range that encloses the values of a quotient.
Interval rangeOf(const Quotient& quotient, const Form& weight);

/// Range that encloses the derivative, by interval arithmetic from `range`, that of the quotient:
/// much cheaper than rangeOf(derivative(...)), and as sharp where the weight is constant.
Interval slopeRange(const Quotient& quotient, Interval range, const Form& weight, bool alongS);

} // namespace cadrefine
