// Polynomials in Bezier form on segments, triangles and tetrahedra.
#pragma once

#include <array>

namespace cadrefine
{

/// The multi-indices of the Bernstein polynomials of a degree on a simplex, as ascending tuples of
/// corners, in lexicographic order.
template<int Corners, int Degree>
struct BernsteinSimplex
{
  static constexpr int corners = Corners;
  static constexpr int degree = Degree;

  using Tuple = std::array<int, Degree>;

  static constexpr int count()
  {
    int result = 1;
    for (int k = 1; k <= Degree; ++k)
    {
      result = result * (Corners - 1 + k) / k;
    }
    return result;
  }

  using Coefficients = std::array<double, count()>;

  static constexpr std::array<Tuple, count()> listTuples()
  {
    std::array<Tuple, count()> result{};
    Tuple tuple{};
    for (int t = 0; t < count(); ++t)
    {
      result[t] = tuple;
      int k = Degree - 1;
      while (k > 0 && tuple[k] == Corners - 1)
      {
        --k;
      }
      const int next = tuple[k] + 1;
      for (; k < Degree; ++k)
      {
        tuple[k] = next;
      }
    }
    return result;
  }

  static constexpr std::array<Tuple, count()> tuples = listTuples();

  static constexpr int powerOf(const Tuple& tuple, int corner)
  {
    int power = 0;
    for (const int index : tuple)
    {
      power += index == corner;
    }
    return power;
  }

  /// Whether the coefficient is the polynomial's value at a corner.
  static constexpr bool isAtCorner(int place)
  {
    return tuples[place].front() == tuples[place].back();
  }

  static constexpr int placeOf(const Tuple& tuple) { return placeAfter(tuple, 0, 0); }

  /// In how many orders the tuple can be written.
  static constexpr int permutations(const Tuple& tuple)
  {
    int result = 1;
    int rest = Degree;
    for (int corner = 0; corner < Corners; ++corner)
    {
      for (int k = 1; k <= powerOf(tuple, corner); ++k)
      {
        result = result * rest-- / k;
      }
    }
    return result;
  }

  /// Place of the tuple with the same powers but one less of `from` and one more of `to`.
  static constexpr int placeAfter(const Tuple& tuple, int from, int to)
  {
    for (int t = 0; t < count(); ++t)
    {
      bool same = true;
      for (int corner = 0; corner < Corners; ++corner)
      {
        same = same && powerOf(tuples[t], corner) ==
                         powerOf(tuple, corner) - (corner == from) + (corner == to);
      }
      if (same)
      {
        return t;
      }
    }
    return -1;
  }

  /// One mean of de Casteljau's algorithm: coefficient `target` takes the mean of itself and of
  /// `other`.
  struct Mean
  {
    int target;
    int other;
  };

  static constexpr int meansCount()
  {
    int result = 0;
    for (const Tuple& tuple : tuples)
    {
      result += powerOf(tuple, Corners - 1);
    }
    return result;
  }

  using Means = std::array<Mean, meansCount()>;

  /// The means for the half in which the middle of edge (kept, lost) takes the place of `lost`, in
  /// their order: in pass r all powers of `lost` of at least r, the highest first.
  static constexpr Means listMeans(int kept, int lost)
  {
    Means result{};
    int next = 0;
    for (int pass = 1; pass <= Degree; ++pass)
    {
      for (int power = Degree; power >= pass; --power)
      {
        for (int t = 0; t < count(); ++t)
        {
          if (powerOf(tuples[t], lost) == power)
          {
            result[next++] = { t, placeAfter(tuples[t], lost, kept) };
          }
        }
      }
    }
    return result;
  }

  static constexpr auto listAllMeans()
  {
    std::array<std::array<Means, Corners>, Corners> result{};
    for (int kept = 0; kept < Corners; ++kept)
    {
      for (int lost = 0; lost < Corners; ++lost)
      {
        if (kept != lost)
        {
          result[kept][lost] = listMeans(kept, lost);
        }
      }
    }
    return result;
  }

  /// The coefficients of the same polynomial on the half in which the middle of edge (kept, lost)
  /// takes the place of `lost`. A coefficient takes part in at most `Degree` means in a row.
  static Coefficients half(Coefficients coefficients, int kept, int lost)
  {
    static constexpr auto means = listAllMeans();
    for (const Mean& mean : means[kept][lost])
    {
      coefficients[mean.target] = 0.5 * coefficients[mean.target] + 0.5 * coefficients[mean.other];
    }
    return coefficients;
  }
};

} // namespace cadrefine
