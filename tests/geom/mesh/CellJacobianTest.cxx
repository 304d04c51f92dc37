// Validity and shape of hexahedra, wedges and pyramids: closed forms, and sampling that must never
// contradict.

#include "FloatingPointPause.h"
#include "SampledCells.h"

#include <cadrefine/mesh/CellJacobian.h>
#include <cadrefine/mesh/Quality.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <set>

namespace
{

using namespace cadtest;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

template<class Cell>
class CellJacobian : public testing::Test
{
public:
  static Cell ideal()
  {
    if constexpr (std::is_same_v<Cell, Hexahedron>)
    {
      return cube;
    }
    else if constexpr (std::is_same_v<Cell, Wedge>)
    {
      return prism;
    }
    else
    {
      return pyramid;
    }
  }
};

using Cells = testing::Types<Hexahedron, Wedge, Pyramid>;
TYPED_TEST_SUITE(CellJacobian, Cells);

TYPED_TEST(CellJacobian, theIdealCellHasOne)
{
  const TypeParam cell = this->ideal();
  EXPECT_TRUE(hasPositiveJacobian(cell));
  EXPECT_NEAR(scaledJacobian(cell), 1, 1e-15);
  std::mt19937 random(1);
  for (int n = 0; n < 100; ++n)
  {
    EXPECT_LT(scaledJacobian(withRandomCorners(cell, 0.2, random)), 1);
  }
  for (const double height : { 0.5, 0.9, 1.1, 2.0, 100.0 })
  {
    EXPECT_LE(scaledJacobian(scaled(cell, { 1, 1, height })), 1);
  }
}

TYPED_TEST(CellJacobian, aMirroredCellIsNotValid)
{
  const TypeParam cell = mirrored(this->ideal());
  EXPECT_FALSE(hasPositiveJacobian(cell));
  EXPECT_LT(scaledJacobian(cell), -0.5);
  EXPECT_NEAR(volume(cell), -volume(this->ideal()), 1e-15);
}

TYPED_TEST(CellJacobian, aFlatCellIsNotValid)
{
  for (const Vector3& factors : { Vector3{ 0, 1, 1 }, { 1, 0, 1 }, { 1, 1, 0 }, { 0, 0, 0 } })
  {
    const TypeParam cell = scaled(this->ideal(), factors);
    EXPECT_FALSE(hasPositiveJacobian(cell));
    EXPECT_EQ(scaledJacobian(cell), 0);
    EXPECT_EQ(volume(cell), 0);
  }
  for (std::size_t k = 1; k < this->ideal().size(); ++k)
  {
    TypeParam collapsed = this->ideal();
    collapsed[k] = collapsed[k - 1];
    EXPECT_FALSE(hasPositiveJacobian(collapsed)) << k;
    EXPECT_LE(scaledJacobian(collapsed), 0) << k;
  }
}

TYPED_TEST(CellJacobian, isTheSameAtAnyScale)
{
  std::mt19937 random(2);
  for (int n = 0; n < 50; ++n)
  {
    const TypeParam cell = withRandomCorners(this->ideal(), 0.5, random);
    for (const double scale : { 1e-100, 1e-30, 1e50 })
    {
      const TypeParam other = scaled(cell, { scale, scale, scale });
      EXPECT_EQ(hasPositiveJacobian(other), hasPositiveJacobian(cell)) << scale;
      EXPECT_NEAR(scaledJacobian(other), scaledJacobian(cell), 1e-13) << scale;
      const double cubed = scale * scale * scale;
      EXPECT_NEAR(volume(other) / cubed, volume(cell), 1e-13) << scale;
    }
  }
}

TYPED_TEST(CellJacobian, aThinCellIsValid)
{
  for (const double height : { 1e-3, 1e-8, 1e-100 })
  {
    TypeParam cell = scaled(this->ideal(), { 1, 1, height });
    EXPECT_TRUE(hasPositiveJacobian(cell)) << height;
    EXPECT_GT(scaledJacobian(cell), 0) << height;
    cell[0][2] += 2 * height;
    EXPECT_FALSE(hasPositiveJacobian(cell)) << height;
  }
}

TYPED_TEST(CellJacobian, ofWhatIsNotFiniteIsNotPositive)
{
  const cadtest::FloatingPointPause pause;
  for (const double bad : { infinity, -infinity, nan })
  {
    for (std::size_t k = 0; k < this->ideal().size(); ++k)
    {
      TypeParam cell = this->ideal();
      cell[k][1] = bad;
      EXPECT_FALSE(hasPositiveJacobian(cell)) << k;
      EXPECT_FALSE(scaledJacobian(cell) > 0) << k;
    }
  }
}

TYPED_TEST(CellJacobian, agreesWithSamples)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> size(0, 1);
  int validCount = 0;
  for (int n = 0; n < 2000; ++n)
  {
    const TypeParam cell = withRandomCorners(this->ideal(), size(random), random);
    const double smallest = smallestSample(cell, 8);
    const bool valid = hasPositiveJacobian(cell);
    validCount += valid;
    EXPECT_FALSE(valid && smallest < 1e-14) << smallest;
    EXPECT_FALSE(!valid && smallest > 0.05) << smallest;
    EXPECT_EQ(scaledJacobian(cell) > 0, valid);
    EXPECT_NEAR(volume(cell), integral(cell), 1e-14);
  }
  EXPECT_GT(validCount, 500);
  EXPECT_LT(validCount, 1500);
}

/// Determinant (1 - t + a t) (1 - t + d t) of a top that is stretched, cos(angle) in the middle
/// of one that is turned.
template<class Cell>
void expectPositiveTwoByTwo(const Cell& cell)
{
  EXPECT_TRUE(hasPositiveJacobian(withTop(cell, { 0.1, 0, 0, 5 })));
  EXPECT_TRUE(hasPositiveJacobian(withTop(cell, rotation(120))));
  EXPECT_TRUE(hasPositiveJacobian(withTop(cell, rotation(179))));
  EXPECT_FALSE(hasPositiveJacobian(withTop(cell, { -1, 0, 0, -1 })));
  // The corners alone do not tell: determinants 1 at the bottom and 4 at the top, between them
  // (1 - 2 t) (1 - 5 t).
  const Cell folded = withTop(cell, { -1, 0, 0, -4 });
  EXPECT_FALSE(hasPositiveJacobian(folded));
  EXPECT_EQ(std::min(0.0, scaledJacobian(folded)), scaledJacobian(folded));
}

TEST(HexahedronJacobian, ofATurnedTop)
{
  const Hexahedron centred = mapped(cube,
    [](const Point3& p) {
      return p - Vector3{ 0.5, 0.5, 0 };
    });
  expectPositiveTwoByTwo(centred);
  EXPECT_NEAR(smallestSample(withTop(centred, { -1, 0, 0, -4 }), 20), -0.225, 1e-12);
}

TEST(WedgeJacobian, ofATurnedTop)
{
  expectPositiveTwoByTwo(prism);
  EXPECT_EQ(scaledJacobian(withTop(prism, { -1, 0, 0, -4 })), 0);
}

/// Positive at all corners and on all edges, negative within.
TEST(HexahedronJacobian, isBoundedWithinTheCell)
{
  std::mt19937 random(4);
  int found = 0;
  for (int n = 0; n < 200000 && found < 3; ++n)
  {
    const Hexahedron cell = withRandomCorners(cube, 0.7, random);
    if (smallestSample(cell, 1) > 0.01 && smallestSample(cell, 4) < 0)
    {
      ++found;
      EXPECT_FALSE(hasPositiveJacobian(cell));
      EXPECT_LE(scaledJacobian(cell), 0);
    }
  }
  EXPECT_EQ(found, 3);
}

TEST(HexahedronJacobian, isBoundedBelowWhereThatIsEnough)
{
  std::mt19937 random(8);
  std::uniform_real_distribution<double> size(0, 0.6);
  std::uniform_real_distribution<double> factor(0.001, 1);
  int bounds = 0;
  for (int i = 0; i < 2000; ++i)
  {
    const Hexahedron cell = scaled(withRandomCorners(cube, size(random), random),
      { factor(random), factor(random), factor(random) });
    const double exact = scaledJacobian(cell);
    const double bound = scaledJacobian(cell, 0);
    ASSERT_LE(bound, exact);
    ASSERT_EQ(bound > 0, exact > 0);
    if (bound != exact)
    {
      ++bounds;
      ASSERT_GT(smallestSample(cell, 4), 0);
    }
    ASSERT_GE(scaledJacobian(cell, 0.5), std::min(exact, 0.5));
    // Nothing is lost of a parallelepiped.
    const Hexahedron sheared = mapped(scaled(cube, { 1, factor(random), factor(random) }),
      [&](const Point3& p) {
        return Point3{ p[0] + p[1], p[1] + 0.5 * p[2], p[2] };
      });
    ASSERT_NEAR(scaledJacobian(sheared, 0), scaledJacobian(sheared), 1e-11);
  }
  EXPECT_GT(bounds, 300);
  EXPECT_LT(bounds, 1900);
  for (const double scale : { 1e-200, 1e-70, 1e-20, 1e20, 1e70 })
  {
    EXPECT_NEAR(scaledJacobian(scaled(cube, { scale, 1, scale }), 0), 1, 1e-11) << scale;
  }
  EXPECT_EQ(scaledJacobian(scaled(cube, { 1, 0, 1 }), 0), 0);
}

TEST(HexahedronJacobian, ofACubeWithACornerMovedThroughTheOppositeOne)
{
  // The determinant at the corner is 3 x - 2.
  for (const auto& [x, valid] : { std::pair{ 1.5, true }, { 0.67, true }, { 0.66, false },
         { 0.4, false }, { 0.0, false }, { -0.1, false } })
  {
    Hexahedron cell = cube;
    cell[6] = { x, x, x };
    EXPECT_EQ(hasPositiveJacobian(cell), valid) << x;
    EXPECT_EQ(smallestSample(cell, 8) > 1e-15, valid) << x;
  }
}

/// A corner that is flat but for the last bits of one coordinate.
TEST(HexahedronJacobian, ofAnAlmostFlatCornerIsExact)
{
  Hexahedron cell = cube;
  for (const double height : { 0.0, 1e-17, -1e-17, 1e-200 })
  {
    cell[0] = { 1 / 3.0, 1 / 3.0, 1 / 3.0 };
    cell[0][2] = 1 - cell[0][0] - cell[0][1] - height;
    const double below = 1 - cell[0][0] - cell[0][1] - cell[0][2];
    EXPECT_EQ(hasPositiveJacobian(cell), below > 0) << height;
  }
  for (const double depth : { 1e-17, 1e-100, -1e-17 })
  {
    Wedge wedge = prism;
    wedge[3] = { -0.5, -0.5, depth };
    EXPECT_EQ(hasPositiveJacobian(wedge), depth > 0) << depth;
    Pyramid flat = pyramid;
    flat[4][2] = depth;
    EXPECT_EQ(hasPositiveJacobian(flat), depth > 0) << depth;
  }
}

/// All numberings that a rotation of the cell gives.
std::set<std::array<int, 8>> rotationsOfHexahedron()
{
  const std::array<std::array<int, 8>, 2> turns{ { { 1, 2, 3, 0, 5, 6, 7, 4 },
    { 4, 5, 1, 0, 7, 6, 2, 3 } } };
  std::set<std::array<int, 8>> result{ { 0, 1, 2, 3, 4, 5, 6, 7 } };
  for (std::size_t before = 0; before != result.size();)
  {
    before = result.size();
    for (const auto& numbers : std::set<std::array<int, 8>>(result))
    {
      for (const auto& turn : turns)
      {
        std::array<int, 8> turned;
        std::transform(
          turn.begin(), turn.end(), turned.begin(), [&](int place) { return numbers[place]; });
        result.insert(turned);
      }
    }
  }
  return result;
}

TEST(HexahedronJacobian, doesNotDependOnTheFirstCorner)
{
  const auto rotations = rotationsOfHexahedron();
  ASSERT_EQ(rotations.size(), 24U);
  std::mt19937 random(5);
  for (int n = 0; n < 200; ++n)
  {
    const Hexahedron cell = withRandomCorners(cube, 0.45, random);
    for (const auto& numbers : rotations)
    {
      Hexahedron turned;
      std::transform(
        numbers.begin(), numbers.end(), turned.begin(), [&](int corner) { return cell[corner]; });
      EXPECT_EQ(hasPositiveJacobian(turned), hasPositiveJacobian(cell));
      EXPECT_NEAR(scaledJacobian(turned), scaledJacobian(cell), 1e-14);
      EXPECT_NEAR(volume(turned), volume(cell), 1e-14);
    }
  }
}

TEST(WedgeJacobian, doesNotDependOnTheFirstCorner)
{
  std::mt19937 random(6);
  for (int n = 0; n < 200; ++n)
  {
    const Wedge w = withRandomCorners(prism, 0.4, random);
    for (const Wedge& turned :
      { Wedge{ w[1], w[2], w[0], w[4], w[5], w[3] }, Wedge{ w[3], w[5], w[4], w[0], w[2], w[1] } })
    {
      EXPECT_EQ(hasPositiveJacobian(turned), hasPositiveJacobian(w));
      EXPECT_NEAR(scaledJacobian(turned), scaledJacobian(w), 1e-14);
      EXPECT_NEAR(volume(turned), volume(w), 1e-14);
    }
    EXPECT_FALSE(hasPositiveJacobian(Wedge{ w[3], w[4], w[5], w[0], w[1], w[2] }));
  }
}

/// Opposite corners of a square lifted by `height`: what its corners turn about the mean normal.
TEST(QuadrilateralJacobian, isThatOfTheMeanNormal)
{
  for (const double height : { 0.0, 0.5, 1.0, 10.0 })
  {
    const Quadrilateral warped{ { { 0, 0, 0 }, { 1, 0, height }, { 1, 1, 0 }, { 0, 1, height } } };
    EXPECT_NEAR(scaledJacobian(warped, { 0, 0, 2 }), 1 / (1 + height * height), 1e-15) << height;
    EXPECT_LT(scaledJacobian(warped, { 0, 0, -1 }), 0) << height;
  }
}

} // namespace
