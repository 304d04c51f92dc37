// Polynomials in Bezier form on squares, cubes and prisms.
#pragma once

#include <cadrefine/base/Vector3.h>
#include <cadrefine/quadratic/BernsteinSimplex.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <tuple>
#include <utility>
#include <vector>

namespace cadrefine
{

/// Products of the Bernstein polynomials of a BernsteinSimplex for each factor of the domain, those
/// of the last factor in a row.
template<class... Factors>
struct BernsteinProduct
{
  static constexpr std::size_t factors = sizeof...(Factors);
  static constexpr std::array<int, factors> counts{ Factors::count()... };
  static constexpr std::array<int, factors> corners{ Factors::corners... };
  static constexpr std::array<int, factors> degrees{ Factors::degree... };

  static constexpr int count() { return (Factors::count() * ...); }

  using Coefficients = std::array<double, count()>;

  /// How far apart the places of one row along a factor are.
  static constexpr int stride(std::size_t factor)
  {
    int result = 1;
    for (std::size_t f = factor + 1; f < factors; ++f)
    {
      result *= counts[f];
    }
    return result;
  }

  /// Whether the coefficient is the polynomial's value at a corner of the domain.
  static constexpr bool isAtCorner(int place)
  {
    bool result = true;
    std::size_t f = 0;
    ((result = result && Factors::isAtCorner(place / stride(f) % counts[f]), ++f), ...);
    return result;
  }

  /// The coefficients of the same polynomial on the half of the domain in which the middle of edge
  /// (kept, lost) of a factor takes the place of `lost`.
  static Coefficients half(const Coefficients& coefficients, std::size_t factor, int kept, int lost)
  {
    Coefficients result;
    std::size_t f = 0;
    ((f++ == factor ? halveAlong<Factors>(coefficients, f - 1, kept, lost, result) : void()), ...);
    return result;
  }

private:
  template<class Factor>
  static void halveAlong(
    const Coefficients& coefficients, std::size_t factor, int kept, int lost, Coefficients& result)
  {
    const int step = stride(factor);
    for (int first = 0; first < count(); ++first)
    {
      if (first / step % Factor::count() != 0)
      {
        continue;
      }
      typename Factor::Coefficients row;
      for (int k = 0; k < Factor::count(); ++k)
      {
        row[k] = coefficients[first + k * step];
      }
      row = Factor::half(row, kept, lost);
      for (int k = 0; k < Factor::count(); ++k)
      {
        result[first + k * step] = row[k];
      }
    }
  }
};

/// A product of two Bernstein polynomials is `weight` times one of higher degree.
struct BernsteinTerm
{
  int first;
  int second;
  int product;
  double weight;
};

template<int Corners, int M, int N>
std::vector<BernsteinTerm> listTerms(BernsteinSimplex<Corners, M>, BernsteinSimplex<Corners, N>)
{
  using First = BernsteinSimplex<Corners, M>;
  using Second = BernsteinSimplex<Corners, N>;
  using Product = BernsteinSimplex<Corners, M + N>;
  std::vector<BernsteinTerm> terms;
  for (int a = 0; a < First::count(); ++a)
  {
    for (int b = 0; b < Second::count(); ++b)
    {
      typename Product::Tuple tuple{};
      std::merge(First::tuples[a].begin(), First::tuples[a].end(), Second::tuples[b].begin(),
        Second::tuples[b].end(), tuple.begin());
      const double ways =
        First::permutations(First::tuples[a]) * Second::permutations(Second::tuples[b]);
      terms.push_back({ a, b, Product::placeOf(tuple), ways / Product::permutations(tuple) });
    }
  }
  return terms;
}

template<class... A, class... B>
std::vector<BernsteinTerm> listTerms(BernsteinProduct<A...>, BernsteinProduct<B...>)
{
  std::vector<BernsteinTerm> terms{ { 0, 0, 0, 1 } };
  const auto multiply = [&](auto a, auto b)
  {
    using First = decltype(a);
    using Second = decltype(b);
    using Product = BernsteinSimplex<First::corners, First::degree + Second::degree>;
    std::vector<BernsteinTerm> longer;
    for (const BernsteinTerm& before : terms)
    {
      for (const BernsteinTerm& term : listTerms(a, b))
      {
        longer.push_back({ before.first * First::count() + term.first,
          before.second * Second::count() + term.second,
          before.product * Product::count() + term.product, before.weight * term.weight });
      }
    }
    terms = std::move(longer);
  };
  (multiply(A{}, B{}), ...);
  return terms;
}

template<class... A, class... B>
auto productOf(BernsteinProduct<A...>, BernsteinProduct<B...>)
{
  return BernsteinProduct<BernsteinSimplex<A::corners, A::degree + B::degree>...>{};
}

/// A polynomial whose coefficients are numbers or vectors.
template<class Basis, class Value>
struct BezierPolynomial
{
  std::array<Value, Basis::count()> coefficients{};
};

/// The polynomial of the products combine(a, b) of the values of two. A coefficient is the mean, by
/// weights of sum 1, of at most as many products as the smaller of the two has coefficients.
template<class A, class B, class U, class V, class Combine>
auto multiply(
  const BezierPolynomial<A, U>& a, const BezierPolynomial<B, V>& b, const Combine& combine)
{
  static const std::vector<BernsteinTerm> terms = listTerms(A{}, B{});
  using Value = decltype(combine(a.coefficients[0], b.coefficients[0]));
  BezierPolynomial<decltype(productOf(A{}, B{})), Value> result;
  for (const auto& [first, second, product, weight] : terms)
  {
    Value& sum = result.coefficients[product];
    sum = sum + weight * combine(a.coefficients[first], b.coefficients[second]);
  }
  return result;
}

template<std::size_t Factor, class... F, std::size_t... I>
auto ofDegreeLess(BernsteinProduct<F...>, std::index_sequence<I...>)
{
  return BernsteinProduct<BernsteinSimplex<F::corners, F::degree - (I == Factor)>...>{};
}

/// The derivative along the edge from corner 0 to corner k of a factor.
template<std::size_t Factor, class... F, class Value>
auto derivative(const BezierPolynomial<BernsteinProduct<F...>, Value>& polynomial, int k)
{
  using From = BernsteinProduct<F...>;
  using To = decltype(ofDegreeLess<Factor>(From{}, std::index_sequence_for<F...>{}));
  using Higher = std::tuple_element_t<Factor, std::tuple<F...>>;
  using Lower = BernsteinSimplex<Higher::corners, Higher::degree - 1>;
  constexpr int step = From::stride(Factor);
  BezierPolynomial<To, Value> result;
  for (int t = 0; t < To::count(); ++t)
  {
    const auto& tuple = Lower::tuples[t / step % Lower::count()];
    const auto at = [&](int corner)
    {
      typename Higher::Tuple longer{};
      std::merge(tuple.begin(), tuple.end(), &corner, &corner + 1, longer.begin());
      const int outer = t / (step * Lower::count());
      return (outer * Higher::count() + Higher::placeOf(longer)) * step + t % step;
    };
    result.coefficients[t] =
      Higher::degree * (polynomial.coefficients[at(k)] - polynomial.coefficients[at(0)]);
  }
  return result;
}

} // namespace cadrefine
