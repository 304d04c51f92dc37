// Volumes of hexahedra, wedges and pyramids, and quadrilaterals: closed forms.

#include "SampledCells.h"

#include <cadrefine/mesh/CellJacobian.h>
#include <cadrefine/mesh/Quality.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace
{

using namespace cadtest;

const Vector3 up{ 0, 0, 1 };

const Quadrilateral square{ { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } } };

TEST(Volume, isThatOfTheClosedForm)
{
  EXPECT_EQ(volume(cube), 1);
  EXPECT_EQ(volume(scaled(cube, { 2, 3, 0.5 })), 3);
  EXPECT_NEAR(volume(prism), std::sqrt(0.75) / 2, 1e-15);
  EXPECT_NEAR(volume(pyramid), std::sqrt(0.5) / 3, 1e-15);
  // A frustum: a square of side 1 shrinks to one of 1/2.
  EXPECT_NEAR(volume(withTop(cube, { 0.5, 0, 0, 0.5 })), 7.0 / 12, 1e-15);
  EXPECT_NEAR(volume(withTop(prism, { 0.5, 0, 0, 0.5 })), 7.0 / 12 * std::sqrt(0.75) / 2, 1e-15);
}

/// With plane faces a cell is the union of tetrahedra.
TEST(Volume, isThatOfTheTetrahedra)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> entry(-1, 1);
  for (int n = 0; n < 100; ++n)
  {
    const std::array<Vector3, 4> rows = withRandomCorners(std::array<Vector3, 4>{}, 1, random);
    const auto affine = [&](const Point3& p) {
      return Point3{ dot(rows[0], p), dot(rows[1], p), dot(rows[2], p) } + rows[3];
    };
    const Hexahedron h = mapped(withTop(cube, { 0.3, 0, 0, 0.3 }), affine);
    const int cut[6][2] = { { 1, 2 }, { 2, 3 }, { 3, 7 }, { 7, 4 }, { 4, 5 }, { 5, 1 } };
    double sum = 0;
    for (const auto& [a, b] : cut)
    {
      sum += sixfoldVolume(h[0], h[a], h[b], h[6]);
    }
    EXPECT_NEAR(volume(h), sum / 6, 1e-15);
    const Wedge w{ h[0], h[1], h[3], h[4], h[5], h[7] };
    EXPECT_NEAR(volume(w),
      (sixfoldVolume(w[0], w[1], w[2], w[3]) + sixfoldVolume(w[1], w[4], w[2], w[3]) +
        sixfoldVolume(w[4], w[5], w[2], w[3])) /
        6,
      1e-15);
    const Pyramid p{ h[0], h[1], h[2], h[3], h[6] };
    EXPECT_NEAR(volume(p),
      (sixfoldVolume(p[0], p[1], p[2], p[4]) + sixfoldVolume(p[0], p[2], p[3], p[4])) / 6, 1e-15);
  }
}

TEST(Quadrilateral, isValidWhereAllCornersTurnTheSameWay)
{
  EXPECT_TRUE(isValidQuadrilateral(square, up));
  EXPECT_FALSE(isValidQuadrilateral(square, -1.0 * up));
  EXPECT_EQ(scaledJacobian(square, up), 1);
  EXPECT_EQ(scaledJacobian(square, -1.0 * up), -1);
  for (const auto& [x, valid] :
    { std::pair{ 0.51, true }, { 0.5, false }, { 0.4, false }, { -0.1, false } })
  {
    Quadrilateral cell = square;
    cell[2] = { x, x, 0 };
    EXPECT_EQ(isValidQuadrilateral(cell, up), valid) << x;
    EXPECT_EQ(scaledJacobian(cell, up) > 0, valid) << x;
  }
  const Quadrilateral bowTie{ square[0], square[1], square[3], square[2] };
  EXPECT_FALSE(isValidQuadrilateral(bowTie, up));
}

TEST(Quadrilateral, isJudgedExactlyInAPlane)
{
  for (const double scale : { 1e-100, 1.0, 1e50 })
  {
    Quadrilateral cell = scaled(square, { scale, scale, scale });
    cell[2] = 0.5 * (cell[1] + cell[3]);
    EXPECT_FALSE(isValidQuadrilateral(cell, up));
    EXPECT_LE(scaledJacobian(cell, up), 0);
    cell[2][0] = std::nextafter(cell[2][0], std::numeric_limits<double>::infinity());
    EXPECT_TRUE(isValidQuadrilateral(cell, up));
    EXPECT_GT(scaledJacobian(cell, up), 0);
  }
}

TEST(Quadrilateral, isTheSameInSpace)
{
  Quadrilateral warped = square;
  warped[2][2] = 0.2;
  EXPECT_TRUE(isValidQuadrilateral(warped, { 0.1, 0.1, 1 }));
  EXPECT_GT(scaledJacobian(warped, up), 0.9);
  EXPECT_NEAR(area(square), 1, 1e-15);
  const Quadrilateral tilted = mapped(square,
    [](const Point3& p) {
      return Point3{ p[0], p[1], p[0] };
    });
  EXPECT_NEAR(area(tilted), std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(scaledJacobian(tilted, { -1, 0, 1 }), 1, 1e-15);
  EXPECT_NEAR(scaledJacobian(tilted, { 0, 0, 1 }), 1, 1e-15);
}

} // namespace
