#include <cadrefine/nurbs/RationalForm.h>

#include <cadrefine/nurbs/BernsteinBasis.h>

#include <algorithm>

namespace cadrefine
{
namespace
{

Form derivative(const Form& form, bool alongS)
{
  const int degree = alongS ? form.degrees.s : form.degrees.t;
  if (degree == 0)
  {
    return { { 0, 0 }, { 0.0 } };
  }
  const Degrees degrees = { form.degrees.s - (alongS ? 1 : 0), form.degrees.t - (alongS ? 0 : 1) };
  const int columns = form.degrees.t + 1;
  const int next = alongS ? columns : 1;
  Form result{ degrees, {} };
  result.c.reserve(degrees.count());
  for (int i = 0; i <= degrees.s; ++i)
  {
    for (int j = 0; j <= degrees.t; ++j)
    {
      const double* p = form.c.data() + i * columns + j;
      result.c.push_back(degree * (p[next] - p[0]));
    }
  }
  return result;
}

/// The coefficients of a form times their binomials, so that products are convolutions.
std::vector<double> scaled(const Form& form)
{
  std::vector<double> c = form.c;
  auto* p = c.data();
  for (int i = 0; i <= form.degrees.s; ++i)
  {
    for (int j = 0; j <= form.degrees.t; ++j)
    {
      *p++ *= binomials[form.degrees.s][i] * binomials[form.degrees.t][j];
    }
  }
  return c;
}

/// Adds factor * a * b to `sum`, of the degrees of the product, all scaled by binomials.
void addProduct(double factor, const Form& a, const Form& b, Degrees degrees, double* sum)
{
  const std::vector<double> scaledA = scaled(a);
  const std::vector<double> scaledB = scaled(b);
  const double* x = scaledA.data();
  for (int i = 0; i <= a.degrees.s; ++i)
  {
    for (int j = 0; j <= a.degrees.t; ++j, ++x)
    {
      const double* y = scaledB.data();
      for (int k = 0; k <= b.degrees.s; ++k)
      {
        double* row = sum + (i + k) * (degrees.t + 1) + j;
        for (int l = 0; l <= b.degrees.t; ++l)
        {
          row[l] += factor * *x * *y++;
        }
      }
    }
  }
}

Interval rangeOf(const Form& form)
{
  Interval range = Interval::empty();
  for (const double c : form.c)
  {
    range.include(c);
  }
  return range;
}

} // namespace

Form withoutConstantDirections(const Form& form)
{
  const int columns = form.degrees.t + 1;
  const auto at = [&](int i, int j) { return form.c[i * columns + j]; };
  bool constantS = true;
  bool constantT = true;
  for (int i = 0; i <= form.degrees.s; ++i)
  {
    for (int j = 0; j <= form.degrees.t; ++j)
    {
      constantS = constantS && at(i, j) == at(0, j);
      constantT = constantT && at(i, j) == at(i, 0);
    }
  }
  Form reduced{ { constantS ? 0 : form.degrees.s, constantT ? 0 : form.degrees.t }, {} };
  for (int i = 0; i <= reduced.degrees.s; ++i)
  {
    for (int j = 0; j <= reduced.degrees.t; ++j)
    {
      reduced.c.push_back(at(i, j));
    }
  }
  return reduced;
}

Quotient derivative(const Quotient& quotient, const Form& weight, bool alongS)
{
  const Form topSlope = derivative(quotient.top, alongS);
  if ((alongS ? weight.degrees.s : weight.degrees.t) == 0)
  {
    return { topSlope, quotient.power };
  }
  // (top / w^m)' = (top' w - m top w') / w^(m + 1)
  const Form weightSlope = derivative(weight, alongS);
  const Degrees degrees = { quotient.top.degrees.s + weightSlope.degrees.s,
    quotient.top.degrees.t + weightSlope.degrees.t };
  Form top{ degrees, std::vector<double>(degrees.count(), 0.0) };
  if ((alongS ? quotient.top.degrees.s : quotient.top.degrees.t) > 0)
  {
    addProduct(1.0, topSlope, weight, degrees, top.c.data());
  }
  addProduct(-quotient.power, quotient.top, weightSlope, degrees, top.c.data());
  auto* p = top.c.data();
  for (int i = 0; i <= degrees.s; ++i)
  {
    for (int j = 0; j <= degrees.t; ++j)
    {
      *p++ /= binomials[degrees.s][i] * binomials[degrees.t][j];
    }
  }
  return { std::move(top), quotient.power + 1 };
}

Interval rangeOf(const Quotient& quotient, const Form& weight)
{
  const Interval one = rangeOf(weight);
  Interval denominator = one;
  for (int i = 1; i < quotient.power; ++i)
  {
    denominator = { denominator.low * one.low, denominator.high * one.high };
  }
  return rangeOf(quotient.top) / denominator;
}

Interval slopeRange(const Quotient& quotient, Interval range, const Form& weight, bool alongS)
{
  const Interval direct = rangeOf({ derivative(quotient.top, alongS), quotient.power }, weight);
  if ((alongS ? weight.degrees.s : weight.degrees.t) == 0)
  {
    return direct;
  }
  // (top / w^m)' = top' / w^m - m (w' / w) (top / w^m)
  const Interval weightSlope = rangeOf({ derivative(weight, alongS), 1 }, weight);
  return direct - static_cast<double>(quotient.power) * (weightSlope * range);
}

} // namespace cadrefine
