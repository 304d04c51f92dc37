// Validity of hexahedra, wedges and quadrilaterals of second order: against sampling with shape
// functions of its own, which must never contradict, and closed forms.

#include "FloatingPointPause.h"
#include "SampledCurvedCells.h"

#include <cadrefine/mesh/CellJacobian.h>
#include <cadrefine/quadratic/CurvedCells.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <random>
#include <vector>

namespace
{

using namespace cadtest;

const Vector3 up{ 0, 0, 1 };

bool isValidAsSeen(const CurvedQuadrilateral& nodes)
{
  return isValid(nodes, up);
}

template<class Nodes>
bool isValidAsSeen(const Nodes& nodes)
{
  return isValid(nodes);
}

auto formOf(const CurvedQuadrilateral& nodes)
{
  return jacobianOf(nodes, up);
}

template<class Nodes>
auto formOf(const Nodes& nodes)
{
  return jacobianOf(nodes);
}

std::array<Point3, 8> cornersOfUnit(shapes::Hexahedron)
{
  return { { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 },
    { 1, 1, 1 }, { 0, 1, 1 } } };
}

std::array<Point3, 6> cornersOfUnit(shapes::Wedge)
{
  return { { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 }, { 0, 1, 1 } } };
}

std::array<Point3, 4> cornersOfUnit(shapes::Quadrilateral)
{
  return { { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } } };
}

template<class Shape>
class Serendipity : public testing::Test
{
protected:
  using Nodes = CurvedCell<Shape>;
  Shape shape;
  std::mt19937 random{ 5 };

  static Nodes unit() { return straightCell(Shape{}, cornersOfUnit(Shape{})); }

  /// Corners are moved by up to a tenth, mid nodes by more.
  Nodes makeRandom(double most)
  {
    std::uniform_real_distribution<double> amplitude(0, most);
    const double size = amplitude(random);
    std::uniform_real_distribution<double> offset(-size, size);
    std::uniform_real_distribution<double> ofCorner(-0.1, 0.1);
    auto corners = cornersOfUnit(shape);
    const auto move = [&](Point3& point, auto& by)
    {
      for (int k = 0; k < Shape::dimension; ++k)
      {
        point[k] += by(random);
      }
    };
    for (Point3& corner : corners)
    {
      move(corner, ofCorner);
    }
    Nodes nodes = straightCell(shape, corners);
    for (std::size_t n = Shape::corners; n < nodes.size(); ++n)
    {
      move(nodes[n], offset);
    }
    return nodes;
  }
};

using Shapes = testing::Types<shapes::Quadrilateral, shapes::Wedge, shapes::Hexahedron>;
TYPED_TEST_SUITE(Serendipity, Shapes, );

TYPED_TEST(Serendipity, straightBricksHaveAConstantJacobian)
{
  const auto form = formOf(this->unit());
  for (const double coefficient : form.coefficients)
  {
    EXPECT_NEAR(coefficient, 1, form.rounding);
  }
  EXPECT_LT(form.rounding, 1e-11);
  EXPECT_TRUE(isValidAsSeen(this->unit()));
}

/// The shape functions are 1 at their own node and 0 at the others.
TYPED_TEST(Serendipity, shapeFunctionsOfTheOracleInterpolate)
{
  const auto unit = this->unit();
  const auto nodes = this->makeRandom(0.3);
  for (std::size_t n = 0; n < nodes.size(); ++n)
  {
    EXPECT_LT(distance(mapAt(nodes, unit[n]), nodes[n]), 1e-14) << n;
  }
}

/// The Bernstein polynomials of a degree at u.
std::vector<double> onSegment(int degree, double u)
{
  std::vector<double> values;
  double binomial = 1;
  for (int i = 0; i <= degree; ++i)
  {
    values.push_back(binomial * std::pow(u, i) * std::pow(1 - u, degree - i));
    binomial = binomial * (degree - i) / (i + 1);
  }
  return values;
}

/// Those of degree 4 on the triangle: each of the 81 ordered products of barycentric coordinates
/// belongs to the polynomial of its ascending tuple.
std::vector<double> onTriangle(double u, double v)
{
  const double l[3] = { 1 - u - v, u, v };
  std::map<std::array<int, 4>, double> values;
  for (int n = 0; n < 81; ++n)
  {
    std::array<int, 4> tuple{ n % 3, n / 3 % 3, n / 9 % 3, n / 27 };
    const double product = l[tuple[0]] * l[tuple[1]] * l[tuple[2]] * l[tuple[3]];
    std::sort(tuple.begin(), tuple.end());
    values[tuple] += product;
  }
  std::vector<double> result;
  result.reserve(values.size());
  for (const auto& [tuple, value] : values)
  {
    result.push_back(value);
  }
  return result;
}

std::vector<double> productOf(const std::vector<double>& a, const std::vector<double>& b)
{
  std::vector<double> result;
  for (const double x : a)
  {
    for (const double y : b)
    {
      result.push_back(x * y);
    }
  }
  return result;
}

std::vector<double> basisAt(shapes::Quadrilateral, const Parameters& where)
{
  return productOf(onSegment(3, where[0]), onSegment(3, where[1]));
}

std::vector<double> basisAt(shapes::Hexahedron, const Parameters& where)
{
  return productOf(
    productOf(onSegment(5, where[0]), onSegment(5, where[1])), onSegment(5, where[2]));
}

std::vector<double> basisAt(shapes::Wedge, const Parameters& where)
{
  return productOf(onTriangle(where[0], where[1]), onSegment(5, where[2]));
}

TYPED_TEST(Serendipity, coefficientsAreThoseOfTheDeterminant)
{
  for (int round = 0; round < 5; ++round)
  {
    const auto nodes = this->makeRandom(0.3);
    const auto form = formOf(nodes);
    forEachPlace(this->shape, 4,
      [&](const Parameters& where)
      {
        const auto basis = basisAt(this->shape, where);
        ASSERT_EQ(basis.size(), form.coefficients.size());
        EXPECT_NEAR(std::inner_product(basis.begin(), basis.end(), form.coefficients.begin(), 0.0),
          jacobianAt(nodes, where), 1e-13);
      });
  }
}

/// Never valid where sampling finds a determinant that is not positive, and always where it finds
/// none below a fiftieth of the unit cell's.
TYPED_TEST(Serendipity, areValidWhereSamplingSaysSo)
{
  constexpr int rounds = TypeParam::dimension == 3 ? 1000 : 4000;
  int valid = 0;
  int invalid = 0;
  for (int round = 0; round < rounds; ++round)
  {
    const auto nodes = this->makeRandom(0.3);
    const double smallest = smallestSample(this->shape, nodes, 12);
    const bool accepted = isValidAsSeen(nodes);
    EXPECT_FALSE(accepted && smallest <= 0) << round;
    EXPECT_FALSE(!accepted && smallest > 0.02) << round << ": " << smallest;
    valid += accepted;
    invalid += smallest <= 0;
  }
  EXPECT_GT(valid, rounds / 10);
  EXPECT_GT(invalid, rounds / 10);
}

/// The derivative along an edge of length 1 vanishes at its end where the node stands at a quarter.
TYPED_TEST(Serendipity, aFoldedMidNodeMakesThemInvalid)
{
  for (const auto& [x, valid] : { std::pair{ 0.5, true }, { 0.26, true }, { 0.25, false },
         { 0.24, false }, { 0.74, true }, { 0.75, false } })
  {
    auto nodes = this->unit();
    nodes[TypeParam::corners][0] = x;
    EXPECT_EQ(isValidAsSeen(nodes), valid) << x;
  }
}

TYPED_TEST(Serendipity, whatIsNotFiniteOrLostInRoundingIsNotValid)
{
  const cadtest::FloatingPointPause pause;
  auto nodes = this->unit();
  nodes.back()[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(isValidAsSeen(nodes));
  nodes.back()[0] = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(isValidAsSeen(nodes));
  for (const double height : { 1e-6, 1e-17 })
  {
    auto flat = this->unit();
    for (Point3& node : flat)
    {
      node[TypeParam::dimension - 1] *= height;
    }
    flat[TypeParam::corners][0] += 0.01;
    EXPECT_EQ(isValidAsSeen(flat), height > 1e-10);
  }
}

/// The computed coefficients err by less than their bound: of cells far from the origin against the
/// same cells there, whose coordinates are small whole numbers of 2^-20, so that both are the same
/// cell exactly.
TYPED_TEST(Serendipity, roundingStaysBelowItsBound)
{
  constexpr double unit = 0x1p20;
  for (int round = 0; round < 200; ++round)
  {
    auto nodes = this->makeRandom(0.3);
    auto away = nodes;
    for (std::size_t n = 0; n < nodes.size(); ++n)
    {
      for (int k = 0; k < TypeParam::dimension; ++k)
      {
        nodes[n][k] = std::round(nodes[n][k] * unit) / unit;
        away[n][k] = nodes[n][k] + 1000.0;
      }
    }
    const auto form = formOf(nodes);
    const auto other = formOf(away);
    EXPECT_EQ(form.coefficients, other.coefficients) << "only differences count";
    // At the first corner, exactly but for the last product.
    const auto edgeAt = [&](int node, int end)
    {
      std::array<long double, 3> edge{};
      for (int k = 0; k < 3; ++k)
      {
        edge[k] = 4 * (static_cast<long double>(nodes[node][k]) - nodes[0][k]) -
                  (static_cast<long double>(nodes[end][k]) - nodes[0][k]);
      }
      return edge;
    };
    constexpr int corners = TypeParam::corners;
    const auto a = edgeAt(corners, 1);
    const auto b =
      edgeAt(isTriangular(this->shape) ? 8 : corners + 3, isTriangular(this->shape) ? 2 : 3);
    std::array<long double, 3> c{ 0, 0, 1 };
    if constexpr (TypeParam::dimension == 3)
    {
      c = isTriangular(this->shape) ? edgeAt(12, 3) : edgeAt(16, 4);
    }
    const long double exact = a[0] * (b[1] * c[2] - b[2] * c[1]) -
                              a[1] * (b[0] * c[2] - b[2] * c[0]) +
                              a[2] * (b[0] * c[1] - b[1] * c[0]);
    EXPECT_LE(std::abs(static_cast<double>(form.coefficients[0] - exact)), form.rounding);
  }
}

TEST(SerendipityCells, meanOfCoefficientsIsTheVolume)
{
  const auto volumeOf = [](const CurvedHexahedron& nodes)
  {
    const auto form = jacobianOf(nodes);
    return std::accumulate(form.coefficients.begin(), form.coefficients.end(), 0.0) / 216;
  };
  // One edge in z moved out by h in x: the moved part of the side x = 1 is
  // h 4 z (1 - z) y, whose integral is h / 3.
  CurvedHexahedron nodes = straightCell(shapes::Hexahedron{}, cornersOfUnit(shapes::Hexahedron{}));
  nodes[18][0] += 0.1; // edge 2, 6 at x = y = 1
  EXPECT_NEAR(volumeOf(nodes), 1 + 0.1 / 3, 1e-14);
  // A wedge the same way: twice its volume, 1, and h 4 z (1 - z) times 2 x over the triangle.
  CurvedWedge wedge = straightCell(shapes::Wedge{}, cornersOfUnit(shapes::Wedge{}));
  const auto before = jacobianOf(wedge).coefficients;
  EXPECT_NEAR(std::accumulate(before.begin(), before.end(), 0.0) / 90, 1, 1e-14);
  wedge[13][0] += 0.1; // edge 1, 4 at x = 1
  const auto after = jacobianOf(wedge).coefficients;
  // The side y = 0 keeps its plane; the slanted side moves by 0.1 4 z (1 - z) x along x.
  EXPECT_NEAR(std::accumulate(after.begin(), after.end(), 0.0) / 90, 1 + 2 * 0.1 / 3, 1e-14);
}

TEST(SerendipityCells, pyramidsAreValidIfStraight)
{
  const std::array<Point3, 5> corners{ { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 },
    { 0.5, 0.5, 1 } } };
  CurvedPyramid nodes = straightCell(shapes::Pyramid{}, corners);
  EXPECT_TRUE(isValid(nodes));
  nodes[5][2] -= 0.01;
  EXPECT_FALSE(isValid(nodes));
  auto inverted = corners;
  inverted[4][2] = -1;
  EXPECT_FALSE(isValid(straightCell(shapes::Pyramid{}, inverted)));
}

/// Bent quadrilaterals and cells without mid nodes elsewhere are judged as those of first order.
TEST(SerendipityCells, straightOnesAreJudgedByTheirCorners)
{
  auto corners = cornersOfUnit(shapes::Hexahedron{});
  corners[6] = { 0.2, 0.2, 1 };
  EXPECT_EQ(isValid(straightCell(shapes::Hexahedron{}, corners)), hasPositiveJacobian(corners));
  corners[6] = { 0.6, 0.6, 1 };
  EXPECT_TRUE(isValid(straightCell(shapes::Hexahedron{}, corners)));
  auto square = cornersOfUnit(shapes::Quadrilateral{});
  square[2] = { 0.4, 0.4, 0 };
  EXPECT_FALSE(isValid(straightCell(shapes::Quadrilateral{}, square), up));
}

TEST(SerendipityCells, pointsOfAQuadrilateralAreThoseOfItsShapeFunctions)
{
  CurvedQuadrilateral nodes =
    straightCell(shapes::Quadrilateral{}, cornersOfUnit(shapes::Quadrilateral{}));
  nodes[5] = { 1.2, 0.45, 0.3 };
  nodes[7] = { 0.1, 0.5, -0.2 };
  for (const Point2 where : { Point2{ 0.3, 0.7 }, { 1, 0.5 }, { 0, 0.2 }, { 0.9, 0.1 } })
  {
    EXPECT_LT(
      distance(pointAt(nodes, where), mapAt(nodes, Parameters{ where[0], where[1], 0 })), 1e-15);
  }
}

} // namespace
