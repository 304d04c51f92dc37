// What cells cost, and the best that can stand on a triangle.

#include <cadrefine/mesh/Quality.h>
#include <cadrefine/operations/ImprovementRule.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace
{

using namespace cadrefine;

TEST(QualityCost, fallsWithQualityAndEndsAtTheFloor)
{
  const QualityCost cost(0.3);
  EXPECT_EQ(cost.of(0.3), 0);
  EXPECT_EQ(cost.of(1), 0);
  EXPECT_DOUBLE_EQ(cost.of(0.1), 4);
  double before = cost.of(0.3);
  for (const double quality : { 0.2, 0.01, 2e-4, 1e-4, 5e-5, 0.0, -0.1, -1.0 })
  {
    EXPECT_GT(cost.of(quality), before) << quality;
    before = cost.of(quality);
  }
  EXPECT_GT(cost.of(-0.1), 100 * cost.of(1e-3)) << "inverted";
}

TEST(QualityCost, isNoGainBelowAHundredth)
{
  EXPECT_TRUE(QualityCost::isGain(1, 0.98));
  EXPECT_FALSE(QualityCost::isGain(1, 0.995));
  EXPECT_FALSE(QualityCost::isGain(0, 1));
}

TEST(LargestMeanRatio, isThatOfTheEquilateralTetrahedron)
{
  EXPECT_NEAR(largestMeanRatioOver({ 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }), 1, 1e-15);
  EXPECT_EQ(largestMeanRatioOver({ 1, 2, 3 }, { 1, 2, 3 }, { 1, 2, 3 }), 0);
}

/// Apexes at random never do better, and the one over the centroid does as well.
TEST(LargestMeanRatio, isReachedAndNeverPassed)
{
  std::mt19937 random(5);
  const auto part = [&] { return static_cast<double>(random() % 65536) / 65536 - 0.5; };
  const auto point = [&] { return Point3{ part(), part(), part() }; };
  for (int t = 0; t < 200; ++t)
  {
    const Point3 a = point();
    const Point3 b = point();
    const Point3 c = t % 2 == 0 ? point() : a + 0.5 * (b - a) + 0.01 * point(); // or narrow
    const double largest = largestMeanRatioOver(a, b, c);
    const double edges = squaredEdgeLengths(a, b, c);
    const Point3 centroid = (1.0 / 3) * (a + b + c);
    const Point3 best =
      centroid + std::sqrt(2 * edges / 9) * normalized(twofoldAreaVector(a, b, c));
    EXPECT_NEAR(meanRatio(a, b, c, best), largest, 1e-12);
    for (int k = 0; k < 100; ++k)
    {
      EXPECT_LE(meanRatio(a, b, c, best + 0.3 * point()), largest + 1e-12);
    }
  }
}

} // namespace
