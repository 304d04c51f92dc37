#include <cadrefine/quadratic/CurvedCells.h>

#include <cadrefine/mesh/CellJacobian.h>
#include <cadrefine/mesh/Orientation.h>
#include <cadrefine/quadratic/BernsteinProduct.h>
#include <cadrefine/quadratic/SerendipityMap.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace cadrefine
{
namespace
{

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double errorOfCoefficients = 12 * epsilon;

/// Local numbers of the mid nodes between corners; for a corner and itself, the corner.
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

template<class Shape>
std::array<Point3, Shape::corners> cornersOf(Shape, const CurvedCell<Shape>& nodes)
{
  std::array<Point3, Shape::corners> corners;
  std::copy_n(nodes.begin(), Shape::corners, corners.begin());
  return corners;
}

template<class Shape>
bool isValidStraight(Shape, const std::array<Point3, Shape::corners>& corners, const Vector3& side)
{
  if constexpr (isSimplex(Shape{}) && Shape::dimension == 3)
  {
    return orientation(corners[0], corners[1], corners[2], corners[3]) > 0;
  }
  else if constexpr (isSimplex(Shape{}))
  {
    return turnOf(corners[0], corners[1], corners[2], side) > 0;
  }
  else if constexpr (Shape::dimension == 2)
  {
    return isValidQuadrilateral(corners, side);
  }
  else
  {
    return hasPositiveJacobian(corners);
  }
}

/// Whether a cell is valid: by its corners if it is straight, or else by isPositive().
template<class Shape, class IsPositive>
bool isValidCell(
  Shape shape, const CurvedCell<Shape>& nodes, const Vector3& side, const IsPositive& isPositive)
{
  const auto corners = cornersOf(shape, nodes);
  return nodes == straightCell(shape, corners) ? isValidStraight(shape, corners, side)
                                               : isPositive();
}

double oneNorm(const Vector3& vector)
{
  return std::abs(vector[0]) + std::abs(vector[1]) + std::abs(vector[2]);
}

template<class Vectors>
double largestNorm(const Vectors& vectors)
{
  return std::accumulate(vectors.begin(), vectors.end(), 0.0,
    [](double largest, const Vector3& vector) { return std::max(largest, oneNorm(vector)); });
}

/// By how much a product of three factors can err, given what each is at most and how much it errs.
double errorOfProduct(const std::array<double, 3>& most, const std::array<double, 3>& error)
{
  const auto [a, b, c] = most;
  const auto [d, e, f] = error;
  return d * b * c + a * e * c + a * b * f + d * e * c + d * b * f + a * e * f + d * e * f +
         30 * epsilon * a * b * c;
}

template<class Basis>
BezierForm<Basis::count()> formOf(
  const BezierPolynomial<Basis, double>& polynomial, double rounding)
{
  return { polynomial.coefficients, rounding };
}

template<class Nodes>
double errorOfDerivatives(const Nodes& nodes)
{
  double size = 0;
  for (const Point3& node : nodes)
  {
    size = std::max(size, oneNorm(node - nodes[0]));
  }
  return 210 * epsilon * size;
}

template<class A, class B>
auto crossProduct(const BezierPolynomial<A, Vector3>& a, const BezierPolynomial<B, Vector3>& b)
{
  return multiply(a, b, [](const Vector3& x, const Vector3& y) { return cross(x, y); });
}

template<class A, class B, class C>
auto determinantOf(const BezierPolynomial<A, Vector3>& a, const BezierPolynomial<B, Vector3>& b,
  const BezierPolynomial<C, Vector3>& c, double error)
{
  const auto product =
    multiply(crossProduct(a, b), c, [](const Vector3& x, const Vector3& y) { return dot(x, y); });
  return formOf(product, errorOfProduct({ largestNorm(a.coefficients), largestNorm(b.coefficients),
                                          largestNorm(c.coefficients) },
                           { error, error, error }));
}

template<class Shape>
using JacobianBasis = typename SerendipityMap<Shape>::Jacobian;

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

BezierForm<16> jacobianOf(const CurvedQuadrilateral& nodes, const Vector3& side)
{
  const auto points = bezierPointsOf(shapes::Quadrilateral{}, nodes);
  const auto a = derivative<0>(points, 1);
  const auto b = derivative<1>(points, 1);
  const double error = errorOfDerivatives(nodes);
  const auto normals = crossProduct(a, b);
  BezierPolynomial<JacobianBasis<shapes::Quadrilateral>, double> alongSide;
  std::transform(normals.coefficients.begin(), normals.coefficients.end(),
    alongSide.coefficients.begin(), [&](const Vector3& normal) { return dot(side, normal); });
  return formOf(alongSide,
    errorOfProduct({ largestNorm(a.coefficients), largestNorm(b.coefficients), oneNorm(side) },
      { error, error, 0 }));
}

BezierForm<90> jacobianOf(const CurvedWedge& nodes)
{
  const auto points = bezierPointsOf(shapes::Wedge{}, nodes);
  return determinantOf(derivative<0>(points, 1), derivative<0>(points, 2), derivative<1>(points, 1),
    errorOfDerivatives(nodes));
}

BezierForm<216> jacobianOf(const CurvedHexahedron& nodes)
{
  const auto points = bezierPointsOf(shapes::Hexahedron{}, nodes);
  return determinantOf(derivative<0>(points, 1), derivative<1>(points, 1), derivative<2>(points, 1),
    errorOfDerivatives(nodes));
}

bool isValid(const CurvedTetrahedron& nodes)
{
  return isValidCell(shapes::Tetrahedron{}, nodes, {},
    [&] { return isPositive<BernsteinProduct<BernsteinSimplex<4, 3>>>(jacobianOf(nodes)); });
}

bool isValid(const CurvedPyramid& nodes)
{
  return isValidCell(shapes::Pyramid{}, nodes, {}, [] { return false; });
}

bool isValid(const CurvedWedge& nodes)
{
  return isValidCell(shapes::Wedge{}, nodes, {},
    [&] { return isPositive<JacobianBasis<shapes::Wedge>>(jacobianOf(nodes)); });
}

bool isValid(const CurvedHexahedron& nodes)
{
  return isValidCell(shapes::Hexahedron{}, nodes, {},
    [&] { return isPositive<JacobianBasis<shapes::Hexahedron>>(jacobianOf(nodes)); });
}

bool isValid(const CurvedTriangle& nodes, const Vector3& side)
{
  return isValidCell(shapes::Triangle{}, nodes, side,
    [&]
    { return isPositive<BernsteinProduct<OnTriangle<2>>>(jacobianOf(nodes, normalized(side))); });
}

bool isValid(const CurvedQuadrilateral& nodes, const Vector3& side)
{
  return isValidCell(shapes::Quadrilateral{}, nodes, side,
    [&] {
      return isPositive<JacobianBasis<shapes::Quadrilateral>>(jacobianOf(nodes, normalized(side)));
    });
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

Point3 pointAt(const CurvedQuadrilateral& nodes, const Point2& where)
{
  Point3 result{};
  const auto [u, v] = where;
  const double atU[2] = { 1 - u, u };
  const double atV[2] = { 1 - v, v };
  for (int k = 0; k < 4; ++k)
  {
    const int i = k == 1 || k == 2;
    const int j = k > 1;
    const double corner = atU[i] * atV[j];
    const double edge = 4 * (k % 2 == 0 ? u * (1 - u) * atV[j] : v * (1 - v) * atU[i]);
    result = result + corner * (2 * (atU[i] + atV[j]) - 3) * nodes[k] + edge * nodes[4 + k];
  }
  return result;
}

} // namespace cadrefine
