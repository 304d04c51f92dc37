// Bernstein polynomials and binomial coefficients. Private to geom/nurbs.
#pragma once

#include <array>

namespace cadrefine
{

/// Highest degree of a curve or a patch in one direction (Open CASCADE's own limit).
constexpr int maximumDegree = 25;

using BasisValues = std::array<double, maximumDegree + 1>;

/// Bernstein polynomials of one degree at one point, with derivatives.
struct BernsteinBasis
{
  BasisValues value, first, second;
};

/// Raises the `degree` Bernstein polynomials of degree `degree - 1` at s to degree `degree`.
inline void raiseBernstein(int degree, double s, BasisValues& b)
{
  const double r = 1.0 - s;
  double carried = 0.0;
  for (int j = 0; j < degree; ++j)
  {
    const double here = b[j];
    b[j] = carried + r * here;
    carried = s * here;
  }
  b[degree] = carried;
}

/// The degree + 1 Bernstein polynomials of `degree` at s (Piegl & Tiller, The NURBS Book, A1.3).
inline void bernsteinValues(int degree, double s, BasisValues& b)
{
  b[0] = 1.0;
  for (int k = 1; k <= degree; ++k)
  {
    raiseBernstein(k, s, b);
  }
}

/// The Bernstein polynomials of `degree` at s with their first and second derivatives, from the
/// bases of the two degrees below.
inline void bernsteinDerivatives(int degree, double s, BernsteinBasis& basis)
{
  BasisValues& b = basis.value;
  b[0] = 1.0;
  for (int k = 1; k <= degree - 2; ++k)
  {
    raiseBernstein(k, s, b);
  }
  const int n = degree;
  for (int i = 0; i <= n; ++i)
  {
    basis.first[i] = basis.second[i] = 0.0;
  }
  if (n >= 2)
  {
    const double factor = n * (n - 1.0);
    for (int i = 0; i <= n - 2; ++i)
    {
      const double term = factor * b[i];
      basis.second[i] += term;
      basis.second[i + 1] -= 2.0 * term;
      basis.second[i + 2] += term;
    }
    raiseBernstein(n - 1, s, b);
  }
  if (n >= 1)
  {
    for (int i = 0; i <= n - 1; ++i)
    {
      const double term = n * b[i];
      basis.first[i] -= term;
      basis.first[i + 1] += term;
    }
    raiseBernstein(n, s, b);
  }
}

/// Highest degree of a product that is worked with.
constexpr int maximumProductDegree = 2 * maximumDegree;

/// Binomial coefficients up to maximumProductDegree: row n, column k. Exact.
using BinomialTable =
  std::array<std::array<double, maximumProductDegree + 1>, maximumProductDegree + 1>;

constexpr BinomialTable makeBinomialTable()
{
  BinomialTable table{};
  for (int n = 0; n <= maximumProductDegree; ++n)
  {
    table[n][0] = 1.0;
    for (int k = 1; k <= n; ++k)
    {
      table[n][k] = table[n - 1][k - 1] + (k < n ? table[n - 1][k] : 0.0);
    }
  }
  return table;
}

inline constexpr BinomialTable binomials = makeBinomialTable();

} // namespace cadrefine
