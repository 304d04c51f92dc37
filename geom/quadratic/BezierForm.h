// Polynomials in Bezier form, and whether they are positive.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace cadrefine
{

/// A polynomial on a simplex in Bezier form: sum over the multi-indices of coefficient times
/// Bernstein polynomial. Coefficients are in the order of the ascending index tuples: of degree 2
/// on a triangle 00 01 02 11 12 22, of degree 3 on a tetrahedron 000 001 002 003 011 ... 333. On a
/// square, a cube or a prism (see BernsteinProduct) there is one for each combination of those of
/// the segments and the triangle that these are products of. The polynomial lies between the
/// smallest and the largest of them, and is equal to those with one index at the corners. Its mean
/// is theirs.
template<std::size_t Count>
struct BezierForm
{
  std::array<double, Count> coefficients{};
  double rounding = 0; ///< No coefficient is farther from that of exact arithmetic.
};

/// Whether a polynomial on a product of simplices is positive, with rounding errors. See
/// isPositive.
template<class Basis>
class PositivityTest
{
public:
  using Coefficients = typename Basis::Coefficients;

  explicit PositivityTest(const BezierForm<Basis::count()>& form)
  {
    // Corners of the parameters, so that all edges are equally long.
    Corners corners{};
    for (auto& ofFactor : corners)
    {
      for (int k = 0; k < mostCorners; ++k)
      {
        ofFactor[k][k] = 1;
      }
    }
    largest_ = 0;
    for (const double coefficient : form.coefficients)
    {
      largest_ = std::max(largest_, std::abs(coefficient));
    }
    pieces_.push_back({ form.coefficients, corners, form.rounding });
  }

  bool run()
  {
    for (int count = 1; !pieces_.empty(); ++count)
    {
      const Piece piece = pieces_.back();
      pieces_.pop_back();
      const auto isPositive = [&](double coefficient) { return coefficient > piece.rounding; };
      if (std::all_of(piece.coefficients.begin(), piece.coefficients.end(), isPositive))
      {
        continue;
      }
      if (count == maximumPieces || !isPositiveAtCorners(piece))
      {
        return false;
      }
      halve(piece);
    }
    return true;
  }

private:
  static constexpr double epsilon = std::numeric_limits<double>::epsilon();
  static constexpr int maximumPieces = 256;
  static constexpr int mostCorners = 4;
  /// The corners of a piece in each factor.
  using Corners =
    std::array<std::array<std::array<double, mostCorners>, mostCorners>, Basis::factors>;

  struct Piece
  {
    Coefficients coefficients;
    Corners corners;
    double rounding;
  };

  /// An edge of a piece, in one of the factors.
  struct Edge
  {
    std::size_t factor;
    int a;
    int b;
  };

  static bool isPositiveAtCorners(const Piece& piece)
  {
    for (int t = 0; t < Basis::count(); ++t)
    {
      if (Basis::isAtCorner(t) && !(piece.coefficients[t] > piece.rounding))
      {
        return false;
      }
    }
    return true;
  }

  static double squaredLength(const Piece& piece, const Edge& edge)
  {
    double sum = 0;
    for (int k = 0; k < mostCorners; ++k)
    {
      const auto& corners = piece.corners[edge.factor];
      const double difference = corners[edge.a][k] - corners[edge.b][k];
      sum += difference * difference;
    }
    return sum;
  }

  static Edge longestEdge(const Piece& piece)
  {
    Edge longest{ 0, 0, 1 };
    for (std::size_t factor = 0; factor < Basis::factors; ++factor)
    {
      for (int a = 0; a < Basis::corners[factor]; ++a)
      {
        for (int b = a + 1; b < Basis::corners[factor]; ++b)
        {
          if (squaredLength(piece, { factor, a, b }) > squaredLength(piece, longest))
          {
            longest = { factor, a, b };
          }
        }
      }
    }
    return longest;
  }

  /// Replaces a piece by its halves. A coefficient takes part in as many means as the degree says,
  /// which round by half of epsilon of the result.
  void halve(const Piece& piece)
  {
    const auto [factor, a, b] = longestEdge(piece);
    for (const auto& [kept, lost] : { std::array<int, 2>{ a, b }, std::array<int, 2>{ b, a } })
    {
      Piece half{ Basis::half(piece.coefficients, factor, kept, lost), piece.corners,
        piece.rounding + Basis::degrees[factor] * epsilon * largest_ };
      const auto& corners = piece.corners[factor];
      for (int k = 0; k < mostCorners; ++k)
      {
        half.corners[factor][lost][k] = 0.5 * (corners[a][k] + corners[b][k]);
      }
      pieces_.push_back(half);
    }
  }

  std::vector<Piece> pieces_;
  double largest_ = 0;
};

/// Whether a polynomial on `Basis`, a BernsteinProduct, is positive everywhere, for certain: its
/// smallest coefficient is larger than the rounding errors in it. Where it is not, and no corner
/// tells that it is not positive, the domain is halved at the longest edge of its parameters, with
/// the coefficients of the halves by de Casteljau's algorithm, which converge to the polynomial at
/// second order. False if it takes more than 256 pieces to tell, and where the rounding errors are
/// not finite or within reach of underflow.
template<class Basis>
bool isPositive(const BezierForm<Basis::count()>& form)
{
  // Rounding errors below this may be larger than they seem, by underflow.
  constexpr double smallestRounding =
    std::numeric_limits<double>::min() / std::numeric_limits<double>::epsilon();
  const auto isCertain = [&](double coefficient) { return coefficient > form.rounding; };
  if (!(form.rounding > smallestRounding && form.rounding <= std::numeric_limits<double>::max()))
  {
    return false;
  }
  return std::all_of(form.coefficients.begin(), form.coefficients.end(), isCertain) ||
         PositivityTest<Basis>(form).run();
}

} // namespace cadrefine
