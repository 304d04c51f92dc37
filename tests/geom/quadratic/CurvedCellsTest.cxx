// Validity of cells of second order: closed forms, and sampling that must never contradict.

#include "FloatingPointPause.h"

#include <cadrefine/mesh/Quality.h>
#include <cadrefine/quadratic/CurvedCells.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace
{

using namespace cadrefine;

const std::array<Point3, 4> corner{ { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };
const std::array<Point3, 3> flatCorner{ { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } } };
const Vector3 up{ 0, 0, 1 };

/// Shape functions of second order and their derivatives along l_1, l_2, ..., written out.
template<std::size_t Corners, class Nodes, std::size_t Edges>
std::array<Vector3, Corners - 1> derivativesAt(
  const Nodes& nodes, const int (&edges)[Edges][2], const std::array<double, Corners>& l)
{
  std::array<Vector3, Corners> along{};
  for (std::size_t k = 0; k < Corners; ++k)
  {
    along[k] = (4 * l[k] - 1) * nodes[k];
  }
  for (std::size_t e = 0; e < Edges; ++e)
  {
    const auto [a, b] = edges[e];
    along[a] = along[a] + 4 * l[b] * nodes[Corners + e];
    along[b] = along[b] + 4 * l[a] * nodes[Corners + e];
  }
  std::array<Vector3, Corners - 1> result;
  for (std::size_t k = 1; k < Corners; ++k)
  {
    result[k - 1] = along[k] - along[0];
  }
  return result;
}

double jacobianAt(const CurvedTetrahedron& nodes, const std::array<double, 4>& l)
{
  const auto d = derivativesAt<4>(nodes, tetrahedronEdges, l);
  return dot(d[0], cross(d[1], d[2]));
}

double jacobianAt(const CurvedTriangle& nodes, const std::array<double, 3>& l)
{
  const auto d = derivativesAt<3>(nodes, triangleEdges, l);
  return cross(d[0], d[1])[2];
}

double smallestSample(const CurvedTetrahedron& nodes, int n)
{
  double smallest = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= n; ++i)
  {
    for (int j = 0; i + j <= n; ++j)
    {
      for (int k = 0; i + j + k <= n; ++k)
      {
        const double step = 1.0 / n;
        smallest = std::min(
          smallest, jacobianAt(nodes, { (n - i - j - k) * step, i * step, j * step, k * step }));
      }
    }
  }
  return smallest;
}

double smallestSample(const CurvedTriangle& nodes, int n)
{
  double smallest = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= n; ++i)
  {
    for (int j = 0; i + j <= n; ++j)
    {
      const double step = 1.0 / n;
      smallest = std::min(smallest, jacobianAt(nodes, { (n - i - j) * step, i * step, j * step }));
    }
  }
  return smallest;
}

template<class Nodes>
Nodes withRandomMidNodes(Nodes nodes, std::size_t corners, int dimension, std::mt19937& random)
{
  std::uniform_real_distribution<double> amplitude(0, 0.35);
  const double size = amplitude(random);
  std::uniform_real_distribution<double> offset(-size, size);
  for (std::size_t n = corners; n < nodes.size(); ++n)
  {
    for (int k = 0; k < dimension; ++k)
    {
      nodes[n][k] += offset(random);
    }
  }
  return nodes;
}

TEST(CurvedCells, straightOnesHaveAConstantJacobian)
{
  for (const double coefficient :
    jacobianOf(straightCell(shapes::Tetrahedron{}, corner)).coefficients)
  {
    EXPECT_EQ(coefficient, 1);
  }
  for (const double coefficient :
    jacobianOf(straightCell(shapes::Triangle{}, flatCorner), up).coefficients)
  {
    EXPECT_EQ(coefficient, 1);
  }
}

/// x = l1 + 4 s l0 l1, y = l2: the determinant is 1 + 4 s (l0 - l1).
TEST(CurvedCells, aTrianglesCoefficientsAreThoseOfTheClosedForm)
{
  const double s = 0.1;
  CurvedTriangle nodes = straightCell(shapes::Triangle{}, flatCorner);
  nodes[3][0] += s;
  const auto form = jacobianOf(nodes, up);
  // In the order 00 01 02 11 12 22: of a linear function the means of its values at the corners.
  const double atCorner[3] = { 1 + 4 * s, 1 - 4 * s, 1 };
  const int tuples[6][2] = { { 0, 0 }, { 0, 1 }, { 0, 2 }, { 1, 1 }, { 1, 2 }, { 2, 2 } };
  for (int t = 0; t < 6; ++t)
  {
    const double expected = (atCorner[tuples[t][0]] + atCorner[tuples[t][1]]) / 2;
    EXPECT_NEAR(form.coefficients[t], expected, form.rounding) << t;
  }
}

/// x = l1 + 4 s l0 l1, y = l2 + 4 s l0 l2, z = l3 + 4 s l0 l3. With p = 1 + 4 s l0 the derivatives
/// are p I - 4 s (l1, l2, l3) (1, 1, 1)^T, so the determinant is p^2 (p - 4 s (1 - l0)).
TEST(CurvedCells, aTetrahedronsCoefficientsAreThoseOfTheClosedForm)
{
  const double s = 0.05;
  CurvedTetrahedron nodes = straightCell(shapes::Tetrahedron{}, corner);
  nodes[4][0] += s;
  nodes[5][1] += s;
  nodes[6][2] += s;
  const auto form = jacobianOf(nodes);
  // Polar form in l0 (0 or 1 a factor): p p q with p = 1 + 4 s l0, q = 1 - 4 s + 8 s l0.
  const auto p = [&](int at) { return 1 + 4 * s * at; };
  const auto q = [&](int at) { return 1 - 4 * s + 8 * s * at; };
  int t = 0;
  for (int i = 0; i < 4; ++i)
  {
    for (int j = i; j < 4; ++j)
    {
      for (int k = j; k < 4; ++k)
      {
        const int a = i == 0;
        const int b = j == 0;
        const int c = k == 0;
        const double expected = (p(a) * p(b) * q(c) + p(a) * q(b) * p(c) + q(a) * p(b) * p(c)) / 3;
        EXPECT_NEAR(form.coefficients[t++], expected, form.rounding) << i << j << k;
      }
    }
  }
  EXPECT_LT(form.rounding, 1e-11);
}

TEST(CurvedCells, aFoldedMidNodeMakesThemInvalid)
{
  // The corner's Jacobian 1 - 4 s vanishes where the mid node stands at a quarter of the edge.
  for (const auto& [x, valid] : { std::pair{ 0.5, true }, { 0.26, true }, { 0.25, false },
         { 0.24, false }, { 0.74, true }, { 0.75, false } })
  {
    CurvedTriangle triangle = straightCell(shapes::Triangle{}, flatCorner);
    triangle[3][0] = x;
    EXPECT_EQ(isValid(triangle, up), valid) << x;
    EXPECT_FALSE(isValid(triangle, -1.0 * up)) << x;
    CurvedTetrahedron tetrahedron = straightCell(shapes::Tetrahedron{}, corner);
    tetrahedron[4][0] = x;
    EXPECT_EQ(isValid(tetrahedron), valid) << x;
  }
  CurvedTetrahedron pushedIn = straightCell(shapes::Tetrahedron{}, corner);
  pushedIn[9] = { 0.1, 0.1, 0.1 };
  EXPECT_FALSE(isValid(pushedIn));
}

TEST(CurvedCells, straightOnesAreJudgedExactly)
{
  using Triangle = std::array<Point3, 3>;
  const double tiny = std::numeric_limits<double>::denorm_min();
  auto points = corner;
  points[3] = { 0, 0, tiny };
  EXPECT_TRUE(isValid(straightCell(shapes::Tetrahedron{}, points)));
  points[3] = { 0.3, 0.3, 0 };
  EXPECT_FALSE(isValid(straightCell(shapes::Tetrahedron{}, points)));
  const Triangle thin{ { { 0, 0, 0 }, { 1, 0, 0 }, { 0, tiny, 0 } } };
  EXPECT_TRUE(isValid(straightCell(shapes::Triangle{}, thin), up));
  const Triangle flat{ { { 0, 0, 0 }, { 1, 0, 0 }, { 2, 0, 0 } } };
  EXPECT_FALSE(isValid(straightCell(shapes::Triangle{}, flat), up));
}

TEST(CurvedCells, whatIsNotFiniteIsNotValid)
{
  const cadtest::FloatingPointPause pause;
  CurvedTetrahedron nodes = straightCell(shapes::Tetrahedron{}, corner);
  nodes[7][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(isValid(nodes));
  nodes[7][1] = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(isValid(nodes));
}

TEST(CurvedCells, whatIsLostInRoundingIsNotValid)
{
  auto points = corner;
  points[3] = { 0.3, 0.3, 1e-17 };
  CurvedTetrahedron flat = straightCell(shapes::Tetrahedron{}, points);
  flat[7][0] += 0.01;
  EXPECT_FALSE(isValid(flat));
  points[3][2] = 1e-3;
  CurvedTetrahedron thicker = straightCell(shapes::Tetrahedron{}, points);
  thicker[7][0] += 0.01;
  EXPECT_TRUE(isValid(thicker));
}

/// Cells with random mid nodes: never valid where sampling finds a determinant that is not
/// positive, and always where it finds none below a hundredth of the straight cell's.
template<class Nodes, class IsValid>
void expectAgreementWithSampling(
  const Nodes& straight, std::size_t corners, int dimension, const IsValid& isValidCell)
{
  constexpr int rounds = 4000;
  std::mt19937 random(5);
  int valid = 0;
  int invalid = 0;
  for (int round = 0; round < rounds; ++round)
  {
    const auto nodes = withRandomMidNodes(straight, corners, dimension, random);
    const double smallest = smallestSample(nodes, 16);
    const bool accepted = isValidCell(nodes);
    EXPECT_FALSE(accepted && smallest <= 0) << round;
    EXPECT_FALSE(!accepted && smallest > 0.01) << round;
    valid += accepted;
    invalid += smallest <= 0;
  }
  EXPECT_GT(valid, rounds / 10);
  EXPECT_GT(invalid, rounds / 10);
}

TEST(CurvedCells, tetrahedraAreValidWhereSamplingSaysSo)
{
  expectAgreementWithSampling(straightCell(shapes::Tetrahedron{}, corner), 4, 3,
    [](const CurvedTetrahedron& nodes) { return isValid(nodes); });
}

TEST(CurvedCells, trianglesAreValidWhereSamplingSaysSo)
{
  expectAgreementWithSampling(straightCell(shapes::Triangle{}, flatCorner), 3, 2,
    [](const CurvedTriangle& nodes) { return isValid(nodes, up); });
}

/// The computed coefficients against those in long double, of cells at odd places.
TEST(CurvedCells, roundingStaysBelowItsBound)
{
  std::mt19937 random(11);
  std::uniform_real_distribution<double> shift(-100, 100);
  for (int round = 0; round < 2000; ++round)
  {
    const Point3 away{ shift(random), shift(random), shift(random) };
    auto nodes = withRandomMidNodes(straightCell(shapes::Tetrahedron{}, corner), 4, 3, random);
    for (Point3& node : nodes)
    {
      node = node + away;
    }
    const auto form = jacobianOf(nodes);
    long double a[3][3];
    for (int k = 1; k <= 3; ++k)
    {
      for (int c = 0; c < 3; ++c)
      {
        // At corner 0: 4 (x_0k - x_0) - (x_k - x_0).
        a[k - 1][c] = 4 * (static_cast<long double>(nodes[3 + k][c]) - nodes[0][c]) -
                      (static_cast<long double>(nodes[k][c]) - nodes[0][c]);
      }
    }
    const long double exact = a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) -
                              a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
                              a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
    EXPECT_LE(std::abs(static_cast<double>(form.coefficients[0] - exact)), form.rounding);
  }
}

TEST(CurvedCells, pointsOfATriangleAreThoseOfItsShapeFunctions)
{
  std::mt19937 random(3);
  const auto nodes = withRandomMidNodes(straightCell(shapes::Triangle{}, flatCorner), 3, 3, random);
  EXPECT_EQ(pointAt(nodes, { 0, 1, 0 }), nodes[1]);
  EXPECT_EQ(pointAt(nodes, { 0, 0.5, 0.5 }), nodes[4]);
  EXPECT_EQ(pointAt(nodes, { 0.5, 0, 0.5 }), nodes[5]);
  const Point3 straight = pointAt(straightCell(shapes::Triangle{}, flatCorner), { 0.2, 0.3, 0.5 });
  EXPECT_NEAR(straight[0], 0.3, 1e-15);
  EXPECT_NEAR(straight[1], 0.5, 1e-15);
}

} // namespace
