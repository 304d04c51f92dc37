// Signs of volumes and areas that rounding would get wrong.

#include "FloatingPointPause.h"

#include <cadrefine/mesh/Orientation.h>
#include <cadrefine/mesh/Quality.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace
{

using namespace cadrefine;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double above(double x)
{
  return std::nextafter(x, infinity);
}

TEST(Orientation, isPositiveInVtksOrder)
{
  EXPECT_EQ(orientation({ 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }), 1);
  EXPECT_EQ(orientation({ 0, 0, 0 }, { 0, 1, 0 }, { 1, 0, 0 }, { 0, 0, 1 }), -1);
  EXPECT_EQ(orientation({ 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 }), 0);
}

/// The plane x + y + z = 3/2 with one vertex off by the last bit of a coordinate: the determinant
/// in floating point is 0 or has any sign, the exact one is known.
TEST(Orientation, isExactNextToAPlane)
{
  const Point3 a{ 0.5, 0.5, 0.5 };
  const Point3 b{ 12, 12, -22.5 };
  const Point3 c{ 24, -22.5, 0 };
  for (int i = 0; i < 50; ++i)
  {
    const double x = 0.5 + i / 1024.0;
    const double y = 0.5 + 3 * i / 1024.0;
    const Point3 inPlane{ x, y, 1.5 - x - y };
    const int side = orientation(a, b, c, { 100, 100, 100 });
    EXPECT_NE(side, 0);
    EXPECT_EQ(orientation(a, b, c, inPlane), 0);
    EXPECT_EQ(orientation(a, b, c, { above(x), y, inPlane[2] }), side);
    EXPECT_EQ(orientation(a, b, c, { x, std::nextafter(y, -infinity), inPlane[2] }), -side);
    EXPECT_EQ(orientation(b, a, c, { x, above(y), inPlane[2] }), -side);
  }
}

/// With cells from good to flat by the last bit, and of any size.
TEST(Orientation, ofOneSideIsTheSame)
{
  const Point3 a{ 0.1, 0.2, 0.3 };
  const Point3 b{ 1.7, 0.9, 0.7 };
  const Point3 c{ 0.4, 1.3, 0.1 };
  const Point3 inside = (1.0 / 3.0) * (a + b + c);
  for (int k = -60; k <= 60; k += 12)
  {
    const double scale = std::pow(10.0, k);
    for (int l = 0; l <= 20; ++l)
    {
      const double height = std::pow(0.1, l);
      for (const double side : { -height, 0.0, height })
      {
        const Point3 d = inside + Vector3{ 0, 0, side };
        EXPECT_EQ(isPositive(scale * a, scale * b, scale * c, scale * d),
          orientation(scale * a, scale * b, scale * c, scale * d) > 0)
          << scale << " " << side;
      }
    }
  }
}

/// Midpoints of rounded coordinates need not lie on the line: the four corners of a bisected face
/// may have a volume of one bit, whose sign changes with every exchange of two vertices.
TEST(Orientation, changesItsSignWithEveryExchange)
{
  const Point3 a{ 0.1, 0.2, 0.3 };
  const Point3 b{ 1.7, 0.9, 0.7 };
  const Point3 c{ 0.4, 1.3, 0.1 };
  const Point3 d = 0.5 * (a + (1.0 / 3.0) * (a + b + c));
  const int sign = orientation(a, b, c, d);
  EXPECT_EQ(orientation(b, a, c, d), -sign);
  EXPECT_EQ(orientation(a, c, b, d), -sign);
  EXPECT_EQ(orientation(a, b, d, c), -sign);
  EXPECT_EQ(orientation(b, c, a, d), sign);
}

void expectSignsAt(double scale)
{
  const Point3 apex{ scale, scale, scale * 1e-20 };
  EXPECT_EQ(orientation({ 0, 0, 0 }, { scale, 0, 0 }, { 0, scale, 0 }, apex), 1);
  EXPECT_EQ(orientation({ 0, 0, 0 }, { 0, scale, 0 }, { scale, 0, 0 }, apex), -1);
  EXPECT_EQ(turnOf({ 0, 0, 0 }, { scale, 0, 0 }, { 0, scale * 1e-20, 0 }, { 0, 0, 1 }), 1);
}

TEST(Orientation, survivesTinyAndLargeCoordinates)
{
  for (const double scale : { 1e-120, 1e-30, 1e30, 1e51 })
  {
    expectSignsAt(scale);
  }
}

TEST(Orientation, survivesOverflow)
{
  const cadtest::FloatingPointPause pause;
  expectSignsAt(1e150);
}

TEST(Orientation, ofWhatIsNotFiniteIsNeither)
{
  const cadtest::FloatingPointPause pause;
  for (const double bad : { infinity, -infinity, nan })
  {
    EXPECT_EQ(orientation({ 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, bad }), 0);
    EXPECT_EQ(turnOf({ 0, 0, 0 }, { 1, 0, 0 }, { 0, bad, 0 }, { 0, 0, 1 }), 0);
  }
}

TEST(Orientation, givesTheSignsOfANormal)
{
  using Signs = std::array<int, 3>;
  EXPECT_EQ(normalSigns({ 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }), (Signs{ 0, 0, 1 }));
  EXPECT_EQ(normalSigns({ 0, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }), (Signs{ 1, 0, 0 }));
  EXPECT_EQ(normalSigns({ 0, 0, 0 }, { 0, 0, 1 }, { 1, 0, 0 }), (Signs{ 0, 1, 0 }));
  EXPECT_EQ(normalSigns({ 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }), (Signs{ 1, 1, 1 }));
  EXPECT_EQ(normalSigns({ 0, 0, 0 }, { 1, 2, 3 }, { 2, 4, 6 }), (Signs{ 0, 0, 0 }));
}

/// A triangle that collapses onto a line, up to the last bit.
TEST(Turn, isExactNextToALine)
{
  const Point3 a{ 0.5, 0.5, 0 };
  const Point3 b{ 24, 24, 0 };
  for (int i = 1; i < 50; ++i)
  {
    const double x = 0.5 + i / 1024.0;
    EXPECT_EQ(turnOf(a, b, { x, x, 0 }, { 0, 0, 1 }), 0);
    EXPECT_EQ(turnOf(a, b, { x, above(x), 0 }, { 0, 0, 1 }), 1);
    EXPECT_EQ(turnOf(a, b, { x, above(x), 0 }, { 0, 0, -1 }), -1);
    EXPECT_EQ(turnOf(a, b, { above(x), x, 0 }, { 0, 0, 1 }), -1);
  }
}

TEST(Turn, ofATriangleInSpaceIsSeenFromTheReference)
{
  const Point3 a{ 0, 0, 0 };
  const Point3 b{ 1, 0, 1 };
  const Point3 c{ 0, 1, 1 };
  const Vector3 normal = twofoldAreaVector(a, b, c);
  EXPECT_EQ(turnOf(a, b, c, normal), 1);
  EXPECT_EQ(turnOf(a, c, b, normal), -1);
  EXPECT_EQ(turnOf(a, b, 0.5 * (a + b), normal), 0);
}

} // namespace
