// The regularised shape of cells round a vertex, and steps that improve it.

#include <cadrefine/motion/ShapeEnergy.h>

#include <cadrefine/mesh/Quality.h>

#include <gtest/gtest.h>

#include <cmath>

namespace
{

using namespace cadrefine;

const double height = std::sqrt(0.75);
const Point3 a{ 0, 0, 0 };
const Point3 b{ 1, 0, 0 };
const Point3 c{ 0.5, height, 0 };
const Vector3 up{ 0, 0, 1 };

/// One cell over a fixed side of length 1: a tetrahedron or a triangle.
class OneCell : public testing::TestWithParam<int>
{
protected:
  ShapeEnergy energy(double delta) const
  {
    ShapeEnergy result(GetParam());
    if (GetParam() == 3)
    {
      result.addTetrahedron(a, b, c, delta);
    }
    else
    {
      result.addTriangle(a, b, up, delta);
    }
    return result;
  }

  Directions directions() const
  {
    return GetParam() == 3 ? Directions::everywhere() : Directions::across(up);
  }

  /// So many heights of the equilateral cell over the middle of the side.
  Point3 apex(double heights) const
  {
    return GetParam() == 3 ? Point3{ 0.5, height / 3, heights * std::sqrt(2.0 / 3.0) }
                           : Point3{ 0.5, heights * height, 0 };
  }

  double quality(const Point3& x) const
  {
    return GetParam() == 3 ? meanRatio(a, b, c, x)
                           : std::copysign(meanRatio(a, b, x), dot(up, cross(b - a, x - a)));
  }

  /// Where steps that lower the energy lead to.
  Point3 minimised(const Point3& x, double delta) const { return minimised(x, energy(delta)); }

  Point3 minimised(Point3 x, const ShapeEnergy& of) const
  {
    for (int k = 0; k < 60; ++k)
    {
      Vector3 step = of.step(x, directions());
      while (norm(step) > 1e-14 && !(of.at(x + step) < of.at(x)))
      {
        step = 0.5 * step;
      }
      x = x + step;
    }
    return x;
  }
};

INSTANTIATE_TEST_SUITE_P(Dimensions, OneCell, testing::Values(2, 3));

TEST_P(OneCell, isTheSquareOfTheInverseMeanRatio)
{
  EXPECT_NEAR(energy(0).at(apex(1)), 1, 1e-14);
  for (const double heights : { 0.01, 0.4, 3.0 })
  {
    const Point3 x = apex(heights) + Vector3{ 0.1, 0, 0 };
    EXPECT_NEAR(energy(0).at(x) * quality(x) * quality(x), 1, 1e-13);
  }
}

TEST_P(OneCell, isAHigherPowerOnRequest)
{
  ShapeEnergy of = energy(0);
  of.setExponent(16);
  const Point3 x = apex(0.4) + Vector3{ 0.1, 0, 0 };
  EXPECT_NEAR(of.at(x) * std::pow(quality(x), 16), 1, 1e-12);
  EXPECT_NEAR(of.largestAt(x) * quality(x), 1, 1e-13);
  EXPECT_TRUE(std::isinf(of.largestAt(apex(0))));
  EXPECT_LT(distance(minimised(apex(0.4), of), apex(1)), 1e-6);
}

TEST_P(OneCell, isInfiniteForInvalidCellsUnlessItIsRegularised)
{
  for (const double heights : { 0.0, -0.3 })
  {
    EXPECT_TRUE(std::isinf(energy(0).at(apex(heights))));
    EXPECT_TRUE(std::isfinite(energy(0.1).at(apex(heights))));
    EXPECT_GT(energy(0.1).at(apex(heights)), energy(0.1).at(apex(0.1)));
  }
  EXPECT_GT(energy(0.1).at(apex(-0.4)), energy(0.1).at(apex(-0.3)))
    << "the more inverted the worse";
}

TEST_P(OneCell, isLowestWhereTheCellIsEquilateral)
{
  for (const double heights : { 0.05, 0.5, 2.0, 20.0 })
  {
    const Point3 x = minimised(apex(heights) + Vector3{ 0.3, 0, 0 }, 0);
    EXPECT_LT(distance(x, apex(1)), 1e-6) << "from " << heights;
  }
}

/// With the side in place, the map from a reference is a shear that moves the apex: its squared
/// Frobenius norm is d + 2 v . w + |v|^2 |w|^2, its determinant 1 + v . w, where v is how far the
/// apex is from that of the reference, and w the normal of the side over the reference's height.
TEST_P(OneCell, keepsTheShapeOfAReference)
{
  const int d = GetParam();
  for (const double heights : { 0.02, 0.5, 30.0 })
  {
    const Point3 reference = apex(heights) + Vector3{ 0.4, 0, 0 };
    ShapeEnergy of(d);
    if (d == 3)
    {
      of.addTetrahedron(a, b, c, 0, { a, b, c, reference });
    }
    else
    {
      of.addTriangle(a, b, up, 0, { a, b, reference });
    }
    EXPECT_NEAR(of.at(reference), 1, 1e-12);
    const Vector3 normal = d == 3 ? Vector3{ 0, 0, 1 } : Vector3{ 0, 1, 0 };
    const Vector3 w = (1 / dot(normal, reference - a)) * normal;
    for (const double part : { 0.3, 1.0, 4.0 })
    {
      const Point3 x = apex(part * heights) - Vector3{ 0.2, 0, 0 };
      const Vector3 v = x - reference;
      const double eta = (d + 2 * dot(v, w) + squaredNorm(v) * squaredNorm(w)) /
                         (d * std::pow(1 + dot(v, w), 2.0 / d));
      EXPECT_NEAR(of.at(x), eta * eta, 1e-11 * eta * eta) << heights << ' ' << part;
    }
    EXPECT_LT(distance(minimised(apex(2 * heights), of), reference), 1e-6 * (1 + heights));
  }
}

TEST_P(OneCell, isToBeEquilateralAgainstAFlatReference)
{
  ShapeEnergy of(GetParam());
  GetParam() == 3 ? of.addTetrahedron(a, b, c, 0, { a, b, c, apex(-0.1) })
                  : of.addTriangle(a, b, up, 0, { a, b, apex(0) });
  const Point3 x = apex(0.7);
  EXPECT_EQ(of.at(x), energy(0).at(x));
}

/// As far as squares of volumes are numbers.
TEST_P(OneCell, scalesWithItsSize)
{
  const Point3 x = apex(0.4) + Vector3{ 0.1, 0, 0 };
  const Vector3 expected = energy(0.1).step(x, directions());
  for (const double size : { 0x1p-160, 0x1p-60, 0x1p60, 0x1p166 })
  {
    const double delta = 0.1 * std::pow(size, GetParam());
    ShapeEnergy large(GetParam());
    if (GetParam() == 3)
    {
      large.addTetrahedron(size * a, size * b, size * c, delta);
    }
    else
    {
      large.addTriangle(size * a, size * b, up, delta);
    }
    EXPECT_NEAR(large.at(size * x), energy(0.1).at(x), 1e-13 * energy(0.1).at(x));
    const Vector3 step = large.step(size * x, directions());
    EXPECT_LT(distance(step, size * expected), 1e-12 * size) << size;
  }
}

/// Also where the energy is not convex, and Newton's step is shifted.
TEST_P(OneCell, stepsTurnWithTheCell)
{
  const auto turned = [](const Vector3& v)
  {
    return (1.0 / 3) * Vector3{ 2 * v[0] - v[1] + 2 * v[2], 2 * v[0] + 2 * v[1] - v[2],
      -v[0] + 2 * v[1] + 2 * v[2] };
  };
  ShapeEnergy other(GetParam());
  if (GetParam() == 3)
  {
    other.addTetrahedron(turned(a), turned(b), turned(c), 0.05);
  }
  else
  {
    other.addTriangle(turned(a), turned(b), turned(up), 0.05);
  }
  const Directions otherDirections =
    GetParam() == 3 ? directions() : Directions::across(turned(up));
  for (const double heights : { -1.0, -0.3, 0.01, 0.5, 2.0 })
  {
    const Point3 x = apex(heights) + Vector3{ 0.9, 0, 0 };
    const Vector3 step = energy(0.05).step(x, directions());
    EXPECT_GT(norm(step), 0);
    EXPECT_LT(distance(other.step(turned(x), otherDirections), turned(step)), 1e-12) << heights;
  }
}

/// An inverted cell is turned over, without an energy that is infinite in between.
TEST_P(OneCell, leadsFromInvertedToValid)
{
  for (const double heights : { -0.01, -0.5, -1.0 })
  {
    EXPECT_GT(quality(minimised(apex(heights), 0.05)), 0.9) << "from " << heights;
  }
}

/// Newton's method: where the energy is convex, the error is squared with every step.
TEST_P(OneCell, stepsConvergeQuadratically)
{
  Point3 x = apex(1) + Vector3{ 0.01, 0.01, 0 };
  double error = distance(x, apex(1));
  for (int k = 0; k < 2; ++k)
  {
    x = x + energy(0).step(x, directions());
    EXPECT_LT(distance(x, apex(1)), 20 * error * error);
    error = distance(x, apex(1));
  }
}

TEST_P(OneCell, stepsKeepToTheirDirections)
{
  const Point3 x = apex(0.3) + Vector3{ 0.2, 0, 0 };
  const Vector3 along{ 3, 4, 0 };
  const Vector3 step = energy(0).step(x, Directions::along(along));
  EXPECT_GT(norm(step), 0);
  EXPECT_LT(norm(cross(step, along)), 1e-14 * norm(step) * norm(along));
  EXPECT_EQ(energy(0).step(x, Directions{}), Vector3{});
}

TEST(Directions, areOrthonormal)
{
  for (const Vector3& normal : { Vector3{ 0, 0, 3 }, Vector3{ 1, 2, -3 }, Vector3{ -1e-9, 0, 0 } })
  {
    const Directions directions = Directions::across(normal);
    ASSERT_EQ(directions.count, 2);
    const auto& [first, second, third] = directions.axes;
    EXPECT_NEAR(norm(first), 1, 1e-15);
    EXPECT_NEAR(norm(second), 1, 1e-15);
    EXPECT_NEAR(dot(first, second), 0, 1e-15);
    EXPECT_NEAR(norm(cross(cross(first, second), normalized(normal))), 0, 1e-15);
  }
  EXPECT_EQ(Directions::across({}).count, 0);
  EXPECT_EQ(Directions::along({}).count, 0);
  EXPECT_EQ(Directions::everywhere().count, 3);
}

} // namespace
