// Sums in fixed point, without communication.
#include "comm/FixedPointSum.h"
#include "FloatingPointPause.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace cadrefine
{

namespace
{

double sumOf(const std::vector<double>& addends)
{
  const std::int64_t exponent = FixedPointSum::exponentOf(addends);
  if (exponent == FixedPointSum::allZero)
  {
    return 0;
  }
  FixedPointSum sum(exponent);
  for (const double addend : addends)
  {
    sum.add(addend);
  }
  return sum.value();
}

TEST(FixedPointSum, isExactWhereTheExactSumIsKnown)
{
  EXPECT_EQ(sumOf({ 0.5 }), 0.5);
  EXPECT_EQ(sumOf({ -1.75 }), -1.75);
  EXPECT_EQ(sumOf({ 1.0, 0x1p-52 }), 1.0 + 0x1p-52);
  EXPECT_EQ(sumOf({ 1e16, 1.0, -1e16 }), 1.0);
  EXPECT_EQ(sumOf({ -1.0, 0x1p-60, 1.0 }), 0x1p-60);
  EXPECT_EQ(sumOf({ 3.0, -3.0 }), 0.0);
  EXPECT_FALSE(std::signbit(sumOf({ 3.0, -3.0 })));
}

TEST(FixedPointSum, takesTheSmallestAndTheLargestDoubles)
{
  const double least = std::numeric_limits<double>::denorm_min();
  const double most = std::numeric_limits<double>::max();
  EXPECT_EQ(sumOf({ least, least, least }), 3 * least);
  EXPECT_EQ(sumOf({ -least }), -least);
  EXPECT_EQ(sumOf({ most, -most, 0.0 }), 0.0);
  EXPECT_EQ(sumOf({ most, most, -most }), most);
  EXPECT_EQ(sumOf({ most, least }), most);
}

TEST(FixedPointSum, isInfiniteWhereItIsTooLarge)
{
  const cadtest::FloatingPointPause pause;
  const double most = std::numeric_limits<double>::max();
  EXPECT_EQ(sumOf({ most, most }), std::numeric_limits<double>::infinity());
}

TEST(FixedPointSum, namesTheExponentOfAList)
{
  EXPECT_EQ(FixedPointSum::exponentOf({}), FixedPointSum::allZero);
  EXPECT_EQ(FixedPointSum::exponentOf({ 0.0, -0.0 }), FixedPointSum::allZero);
  EXPECT_EQ(FixedPointSum::exponentOf({ 1.0, NAN }), FixedPointSum::notFinite);
  EXPECT_EQ(FixedPointSum::exponentOf({ -INFINITY }), FixedPointSum::notFinite);
  EXPECT_EQ(FixedPointSum::exponentOf({ 0.75, -2.0 }), 2);
}

TEST(FixedPointSum, hasOneFormForEachValue)
{
  FixedPointSum once(1);
  once.add(-0x1p-80);
  FixedPointSum inSteps(1);
  for (const double addend : { 1.0, -0x1p-50, -1.0, 0x1p-50, -0x1p-80 })
  {
    inSteps.add(addend);
  }
  EXPECT_EQ(once.limbs(), inSteps.limbs());
  for (std::size_t i = 1; i < 4; ++i)
  {
    EXPECT_GE(once.limbs()[i], 0);
    EXPECT_LT(once.limbs()[i], std::int64_t{ 1 } << 32);
  }
  EXPECT_EQ(FixedPointSum(1, once.limbs()).value(), -0x1p-80);
}

TEST(FixedPointSum, keepsItsErrorBound)
{
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> mantissa(-1, 1);
  std::uniform_int_distribution<int> exponent(-70, 0);
  std::vector<double> addends(100000);
  long double exact = 0; // 64 bits, and the largest addend is near 1: good to 2^-46 here
  for (double& addend : addends)
  {
    addend = std::scalbn(mantissa(random), exponent(random));
    exact += addend;
  }
  const double sum = sumOf(addends);
  EXPECT_NEAR(sum, static_cast<double>(exact), 1e-12);
  std::shuffle(addends.begin(), addends.end(), random);
  EXPECT_EQ(sumOf(addends), sum);
  for (double& addend : addends)
  {
    addend = -addend;
  }
  EXPECT_EQ(sumOf(addends), -sum);
}

} // namespace

} // namespace cadrefine
