#include <cadrefine/quadratic/CurvedCells.h>

#include <cadrefine/mesh/Orientation.h>
#include <cadrefine/quadratic/BernsteinSimplex.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace cadrefine
{
namespace
{

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double errorOfCoefficients = 12 * epsilon;
/// Rounding errors below this may be larger than they seem, by underflow.
constexpr double smallestRounding = std::numeric_limits<double>::min() / epsilon;
constexpr int maximumPieces = 256;

/// Local numbers of the mid nodes between corners; of a corner and itself the corner.
constexpr int nodeBetween[4][4] = { { 0, 4, 5, 6 }, { 4, 1, 7, 8 }, { 5, 7, 2, 9 },
  { 6, 8, 9, 3 } };
constexpr int triangleNodeBetween[3][3] = { { 0, 3, 5 }, { 3, 1, 4 }, { 5, 4, 2 } };

/// The derivative along one barycentric coordinate: linear, a coefficient for each corner.
template<std::size_t Corners>
struct Derivative
{
  std::array<Vector3, Corners> coefficients;
  double size = 0; ///< 1-norm of what the coefficients were added up from, the largest.
};

template<std::size_t Corners, class Nodes>
Derivative<Corners> derivativeAlong(
  std::size_t k, const Nodes& nodes, const int (&between)[Corners][Corners])
{
  Derivative<Corners> result;
  const Vector3 edge = nodes[k] - nodes[0];
  for (std::size_t i = 0; i < Corners; ++i)
  {
    const Vector3 across = nodes[between[i][k]] - nodes[between[i][0]];
    result.coefficients[i] = 4.0 * across - edge;
    double size = 0;
    for (int c = 0; c < 3; ++c)
    {
      size += 4 * std::abs(across[c]) + std::abs(edge[c]);
    }
    result.size = std::max(result.size, size);
  }
  return result;
}

double determinant(const Vector3& a, const Vector3& b, const Vector3& c)
{
  return dot(a, cross(b, c));
}

/// Whether a polynomial is positive on a simplex, with rounding errors.
template<int Corners, int Degree>
class PositivityTest
{
public:
  using Basis = BernsteinSimplex<Corners, Degree>;
  using Coefficients = typename Basis::Coefficients;

  explicit PositivityTest(const BezierForm<Basis::count()>& form)
  {
    // Corners of the parameters, so that all edges are equally long.
    std::array<std::array<double, Corners>, Corners> corners{};
    for (int k = 0; k < Corners; ++k)
    {
      corners[k][k] = 1;
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
  struct Piece
  {
    Coefficients coefficients;
    std::array<std::array<double, Corners>, Corners> corners;
    double rounding;
  };

  static bool isPositiveAtCorners(const Piece& piece)
  {
    for (int t = 0; t < Basis::count(); ++t)
    {
      const auto& tuple = Basis::tuples[t];
      if (tuple.front() == tuple.back() && !(piece.coefficients[t] > piece.rounding))
      {
        return false;
      }
    }
    return true;
  }

  static double squaredLength(const Piece& piece, int a, int b)
  {
    double sum = 0;
    for (int k = 0; k < Corners; ++k)
    {
      const double difference = piece.corners[a][k] - piece.corners[b][k];
      sum += difference * difference;
    }
    return sum;
  }

  static std::array<int, 2> longestEdge(const Piece& piece)
  {
    std::array<int, 2> longest{ 0, 1 };
    for (int a = 0; a < Corners; ++a)
    {
      for (int b = a + 1; b < Corners; ++b)
      {
        if (squaredLength(piece, a, b) > squaredLength(piece, longest[0], longest[1]))
        {
          longest = { a, b };
        }
      }
    }
    return longest;
  }

  /// A coefficient takes part in `Degree` means, which round by half of epsilon of the result.
  void halve(const Piece& piece)
  {
    const auto [a, b] = longestEdge(piece);
    for (const auto& [kept, lost] : { std::array<int, 2>{ a, b }, std::array<int, 2>{ b, a } })
    {
      Piece half{ Basis::half(piece.coefficients, kept, lost), piece.corners,
        piece.rounding + Degree * epsilon * largest_ };
      for (int k = 0; k < Corners; ++k)
      {
        half.corners[lost][k] = 0.5 * (piece.corners[a][k] + piece.corners[b][k]);
      }
      pieces_.push_back(half);
    }
  }

  std::vector<Piece> pieces_;
  double largest_ = 0;
};

template<int Corners, int Degree, std::size_t Count>
bool isPositive(const BezierForm<Count>& form)
{
  const auto isCertain = [&](double coefficient) { return coefficient > form.rounding; };
  if (!(form.rounding > smallestRounding && form.rounding <= std::numeric_limits<double>::max()))
  {
    return false;
  }
  return std::all_of(form.coefficients.begin(), form.coefficients.end(), isCertain) ||
         PositivityTest<Corners, Degree>(form).run();
}

template<std::size_t Corners, std::size_t Edges>
std::array<Point3, Corners + Edges> addMiddles(
  const std::array<Point3, Corners>& corners, const int (&edges)[Edges][2])
{
  std::array<Point3, Corners + Edges> result;
  std::copy(corners.begin(), corners.end(), result.begin());
  std::transform(std::begin(edges), std::end(edges), result.begin() + Corners,
    [&](const int(&edge)[2]) { return 0.5 * (corners[edge[0]] + corners[edge[1]]); });
  return result;
}

template<std::size_t Corners, class Nodes>
std::array<Point3, Corners> cornersOf(const Nodes& nodes)
{
  std::array<Point3, Corners> corners;
  std::copy_n(nodes.begin(), Corners, corners.begin());
  return corners;
}

} // namespace

BezierForm<20> jacobianOf(const CurvedTetrahedron& nodes)
{
  using Basis = BernsteinSimplex<4, 3>;
  const auto a = derivativeAlong(1, nodes, nodeBetween);
  const auto b = derivativeAlong(2, nodes, nodeBetween);
  const auto c = derivativeAlong(3, nodes, nodeBetween);
  BezierForm<20> result;
  for (int t = 0; t < Basis::count(); ++t)
  {
    auto tuple = Basis::tuples[t];
    double sum = 0;
    int permutations = 0;
    do
    {
      sum +=
        determinant(a.coefficients[tuple[0]], b.coefficients[tuple[1]], c.coefficients[tuple[2]]);
      ++permutations;
    } while (std::next_permutation(tuple.begin(), tuple.end()));
    result.coefficients[t] = sum / permutations;
  }
  result.rounding = errorOfCoefficients * a.size * b.size * c.size;
  return result;
}

BezierForm<6> jacobianOf(const CurvedTriangle& nodes, const Vector3& side)
{
  using Basis = BernsteinSimplex<3, 2>;
  const auto a = derivativeAlong(1, nodes, triangleNodeBetween);
  const auto b = derivativeAlong(2, nodes, triangleNodeBetween);
  BezierForm<6> result;
  for (int t = 0; t < Basis::count(); ++t)
  {
    const auto [i, j] = Basis::tuples[t];
    result.coefficients[t] = 0.5 * (determinant(side, a.coefficients[i], b.coefficients[j]) +
                                     determinant(side, a.coefficients[j], b.coefficients[i]));
  }
  result.rounding = errorOfCoefficients * a.size * b.size *
                    (std::abs(side[0]) + std::abs(side[1]) + std::abs(side[2]));
  return result;
}

bool isValid(const CurvedTetrahedron& nodes)
{
  const auto corners = cornersOf<4>(nodes);
  if (nodes == straightCell(corners))
  {
    return orientation(corners[0], corners[1], corners[2], corners[3]) > 0;
  }
  return isPositive<4, 3>(jacobianOf(nodes));
}

bool isValid(const CurvedTriangle& nodes, const Vector3& side)
{
  const auto corners = cornersOf<3>(nodes);
  if (nodes == straightCell(corners))
  {
    return turnOf(corners[0], corners[1], corners[2], side) > 0;
  }
  return isPositive<3, 2>(jacobianOf(nodes, normalized(side)));
}

CurvedTetrahedron straightCell(const std::array<Point3, 4>& corners)
{
  return addMiddles(corners, tetrahedronEdges);
}

CurvedTriangle straightCell(const std::array<Point3, 3>& corners)
{
  return addMiddles(corners, triangleEdges);
}

Point3 pointAt(const CurvedTriangle& nodes, const std::array<double, 3>& where)
{
  Point3 result{};
  for (int k = 0; k < 3; ++k)
  {
    const int next = (k + 1) % 3;
    result =
      result + where[k] * (2 * where[k] - 1) * nodes[k] + 4 * where[k] * where[next] * nodes[3 + k];
  }
  return result;
}

} // namespace cadrefine
