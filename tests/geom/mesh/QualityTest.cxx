#include <cadrefine/mesh/Quality.h>

#include <gtest/gtest.h>

#include <cmath>

namespace
{

using namespace cadrefine;

const std::array<Point3, 4> regular{ { { 1, 1, 1 }, { 1, -1, -1 }, { -1, -1, 1 }, { -1, 1, -1 } } };

TEST(Quality, volumeIsPositiveInVtksOrder)
{
  EXPECT_EQ(sixfoldVolume({ 0, 0, 0 }, { 2, 0, 0 }, { 0, 3, 0 }, { 0, 0, 5 }), 30);
  EXPECT_EQ(sixfoldVolume({ 0, 0, 0 }, { 0, 3, 0 }, { 2, 0, 0 }, { 0, 0, 5 }), -30);
}

TEST(Quality, areaVectorPointsByTheRightHand)
{
  EXPECT_EQ(twofoldAreaVector({ 1, 1, 0 }, { 3, 1, 0 }, { 1, 4, 0 }), (Vector3{ 0, 0, 6 }));
  EXPECT_EQ(twofoldAreaVector({ 1, 1, 0 }, { 1, 4, 0 }, { 3, 1, 0 }), (Vector3{ 0, 0, -6 }));
}

TEST(Quality, isOneForEquilateralCells)
{
  EXPECT_NEAR(meanRatio(regular[0], regular[1], regular[3], regular[2]), -1, 1e-15);
  EXPECT_NEAR(meanRatio(regular[0], regular[1], regular[2], regular[3]), 1, 1e-15);
  EXPECT_NEAR(meanRatio({ 0, 0, 0 }, { 1, 0, 0 }, { 0.5, std::sqrt(0.75), 0 }), 1, 1e-15);
}

/// Three edges of length 1 at right angles: V = 1/6, squared edges add up to 9.
TEST(Quality, ofACornerIsTheClosedForm)
{
  const double expected = 12 * std::pow(0.5, 2.0 / 3.0) / 9;
  EXPECT_NEAR(meanRatio({ 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }), expected, 1e-15);
  EXPECT_NEAR(meanRatio({ 0, 0, 0 }, { 0, 1, 0 }, { 1, 0, 0 }, { 0, 0, 1 }), -expected, 1e-15);
}

/// Legs a and b at a right angle: 4 sqrt(3) (ab/2) / (2 a^2 + 2 b^2).
TEST(Quality, ofARightTriangleIsTheClosedForm)
{
  for (const double b : { 1.0, 0.5, 0.01 })
  {
    EXPECT_NEAR(
      meanRatio({ 0, 0, 3 }, { 1, 0, 3 }, { 0, b, 3 }), std::sqrt(3.0) * b / (1 + b * b), 1e-15);
  }
}

TEST(Quality, isZeroForFlatCells)
{
  EXPECT_EQ(meanRatio({ 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 }), 0);
  EXPECT_EQ(meanRatio({ 0, 0, 0 }, { 1, 0, 0 }, { 2, 0, 0 }), 0);
  EXPECT_EQ(meanRatio({ 1, 2, 3 }, { 1, 2, 3 }, { 1, 2, 3 }, { 1, 2, 3 }), 0);
  EXPECT_EQ(meanRatio({ 1, 2, 3 }, { 1, 2, 3 }, { 1, 2, 3 }), 0);
}

TEST(Quality, doesNotDependOnSize)
{
  for (const double scale : { 1e-9, 1e9 })
  {
    EXPECT_NEAR(meanRatio(scale * regular[0], scale * regular[1], scale * regular[2],
                  scale * Point3{ -3, 1, -1 }),
      meanRatio(regular[0], regular[1], regular[2], { -3, 1, -1 }), 1e-14);
  }
}

} // namespace
