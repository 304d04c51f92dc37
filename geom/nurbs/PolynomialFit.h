// Polynomial pieces that follow a smooth function. Private to geom.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace cadrefine
{

/// Interpolation of functions of one variable in Chebyshev points, by polynomials of degree 7 in
/// Bernstein form, halved until they are near enough.
namespace fit
{

constexpr int degree = 7;

/// The interpolation points in [0, 1]: both ends, and Chebyshev points between them.
const std::array<double, degree + 1>& nodes();

/// Row i gives Bernstein coefficient i from the values at the nodes.
const std::array<std::array<double, degree + 1>, degree + 1>& valuesToCoefficients();

/// The Bernstein polynomials at x.
std::array<double, degree + 1> bernstein(double x);

template<std::size_t dimension>
using Value = std::array<double, dimension>;

/// A polynomial over [from, to].
template<std::size_t dimension>
struct Piece
{
  double from = 0;
  double to = 1;
  std::array<Value<dimension>, degree + 1> coefficients{};

  /// Its value at a fraction of the range.
  Value<dimension> at(double fraction) const
  {
    const auto basis = bernstein(fraction);
    Value<dimension> sum{};
    for (int i = 0; i <= degree; ++i)
    {
      for (std::size_t k = 0; k < dimension; ++k)
      {
        sum[k] += basis[i] * this->coefficients[i][k];
      }
    }
    return sum;
  }
};

/// Interpolates the function over [from, to]. The values at the ends are exactly the function's.
template<std::size_t dimension, typename Function>
Piece<dimension> interpolate(const Function& function, double from, double to)
{
  Piece<dimension> piece{ from, to, {} };
  std::array<Value<dimension>, degree + 1> values;
  for (int j = 0; j <= degree; ++j)
  {
    values[j] = function(j == degree ? to : from + nodes()[j] * (to - from));
    for (int i = 0; i <= degree; ++i)
    {
      for (std::size_t k = 0; k < dimension; ++k)
      {
        piece.coefficients[i][k] += valuesToCoefficients()[i][j] * values[j][k];
      }
    }
  }
  piece.coefficients.front() = values.front();
  piece.coefficients.back() = values.back();
  return piece;
}

/// Adds pieces that follow the function over [from, to] to `tolerance` in each coordinate, as seen
/// at points between the nodes; at most 2^12 of them, the last ones as near as they are.
template<std::size_t dimension, typename Function>
void addPieces(const Function& function, double from, double to, const Value<dimension>& tolerance,
  std::vector<Piece<dimension>>& pieces, int depth = 0)
{
  constexpr int deepest = 12;
  Piece<dimension> piece = interpolate<dimension>(function, from, to);
  bool isNear = true;
  for (const double fraction : { 0.02, 0.13, 0.3, 0.46, 0.61, 0.8, 0.96 })
  {
    const Value<dimension> wanted = function(from + fraction * (to - from));
    const Value<dimension> got = piece.at(fraction);
    for (std::size_t k = 0; k < dimension; ++k)
    {
      isNear = isNear && std::abs(wanted[k] - got[k]) <= tolerance[k];
    }
  }
  if (isNear || depth >= deepest)
  {
    pieces.push_back(piece);
    return;
  }
  const double middle = 0.5 * (from + to);
  addPieces(function, from, middle, tolerance, pieces, depth + 1);
  addPieces(function, middle, to, tolerance, pieces, depth + 1);
}

/// Parameters in [0, 1] where a function crosses one of the levels, each sign change between
/// sampled points once.
template<typename Function>
void addCrossings(
  const Function& function, const std::vector<double>& levels, std::vector<double>& parameters)
{
  constexpr int samples = 16;
  for (const double level : levels)
  {
    const auto above = [&](double x) { return function(x) > level; };
    for (int i = 0; i < samples; ++i)
    {
      double low = static_cast<double>(i) / samples;
      double high = static_cast<double>(i + 1) / samples;
      const bool start = above(low);
      if (start == above(high))
      {
        continue;
      }
      for (int step = 0; step < 50; ++step)
      {
        const double middle = 0.5 * (low + high);
        (above(middle) == start ? low : high) = middle;
      }
      parameters.push_back(high);
    }
  }
}

/// Pieces over [0, 1] of a function that is smooth between `cuts`.
template<std::size_t dimension, typename Function>
std::vector<Piece<dimension>> pieces(
  const Function& function, std::vector<double> cuts, const Value<dimension>& tolerance)
{
  constexpr double shortest = 1e-9;
  cuts.push_back(1);
  std::sort(cuts.begin(), cuts.end());
  std::vector<Piece<dimension>> result;
  double from = 0;
  for (const double to : cuts)
  {
    const double next = 1 - to > shortest ? to : 1;
    if (next - from > shortest)
    {
      addPieces<dimension>(function, from, next, tolerance, result);
      from = next;
    }
  }
  return result;
}

} // namespace fit

} // namespace cadrefine
