#include "FloatingPointPause.h"

#include <cadrefine/mesh/QualitySummary.h>

#include "MixedMeshes.h"
#include "TestMeshes.h"

#include <cadrefine/mesh/Orientation.h>
#include <cadrefine/mesh/Quality.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace
{

using namespace cadrefine;

QualitySummary oneByOne(const Mesh& mesh)
{
  QualitySummary summary;
  const auto& p = mesh.points;
  for (const auto& [a, b, c, d] : mesh.tetrahedra)
  {
    summary.invalidCells += orientation(p[a], p[b], p[c], p[d]) <= 0;
    summary.smallestRatio = std::min(summary.smallestRatio, meanRatio(p[a], p[b], p[c], p[d]));
  }
  return summary;
}

void expectSame(const Mesh& mesh)
{
  const QualitySummary expected = oneByOne(mesh);
  const QualitySummary summary = summariseCells(mesh);
  EXPECT_EQ(summary.invalidCells, expected.invalidCells);
  EXPECT_NEAR(summary.minimum(), expected.minimum(), 1e-14);
}

TEST(QualitySummary, isThatOfTheCellsOneByOne)
{
  for (std::uint64_t seed = 1; seed < 30; ++seed)
  {
    expectSame(cadtest::cubeMesh(4, 0.02 * static_cast<double>(seed), seed));
  }
  EXPECT_EQ(summariseCells(cadtest::cubeMesh(4, 0.1, 1)).invalidCells, 0);
}

TEST(QualitySummary, countsInvertedAndFlatCells)
{
  Mesh mesh = cadtest::cubeMesh(2, 0.1, 1);
  std::swap(mesh.tetrahedra[5][0], mesh.tetrahedra[5][1]);
  mesh.tetrahedra.push_back({ 0, 1, 2, 2 });
  expectSame(mesh);
  EXPECT_EQ(summariseCells(mesh).invalidCells, 2);
  EXPECT_LT(summariseCells(mesh).minimum(), 0);
}

/// Mirrored cubes have the least value that there is, -1, and count all the same.
TEST(QualitySummary, countsEveryInvertedHexahedron)
{
  Mesh mesh = cadtest::hexahedraMesh(2, 0, 1);
  for (auto& h : mesh.hexahedra)
  {
    h = { h[4], h[5], h[6], h[7], h[0], h[1], h[2], h[3] };
  }
  EXPECT_EQ(summariseCells(mesh).invalidCells, 8);
  EXPECT_EQ(summariseCells(mesh).minimum(), -1);
}

/// Volumes within the rounding errors, of either sign.
TEST(QualitySummary, decidesNearlyFlatCellsExactly)
{
  const double tiny = std::numeric_limits<double>::epsilon();
  for (const double height : { -2 * tiny, -tiny / 2, 0.0, tiny / 4, tiny, 8 * tiny, 1e-12, 1e-9 })
  {
    Mesh mesh = cadtest::oneTetrahedron(
      { { { 0.1, 0.3, 0.7 }, { 1.1, 0.3, 0.7 }, { 0.1, 1.3, 0.7 }, { 0.4, 0.7, 0.7 + height } } });
    expectSame(mesh);
  }
}

void expectSameAt(double size)
{
  Mesh mesh = cadtest::cubeMesh(2, 0.1, 3);
  for (Point3& point : mesh.points)
  {
    point = size * point;
  }
  expectSame(mesh);
}

TEST(QualitySummary, holdsAtAllSizes)
{
  for (const double size : { 1e-90, 1e-60, 1e-50, 1e-30, 1e30, 1e50 })
  {
    expectSameAt(size);
  }
}

TEST(QualitySummary, holdsWherePowersOverflow)
{
  const cadtest::FloatingPointPause pause;
  expectSameAt(1e60);
  expectSameAt(1e90);
}

TEST(QualitySummary, ofCellsWithoutANumberIsInvalid)
{
  const cadtest::FloatingPointPause pause;
  Mesh mesh = cadtest::cubeMesh(1, 0, 1);
  mesh.points[0][1] = std::numeric_limits<double>::quiet_NaN();
  expectSame(mesh);
  EXPECT_GT(summariseCells(mesh).invalidCells, 0);
}

TEST(QualitySummary, ofNoCellsHasNoMinimum)
{
  const QualitySummary summary = summariseCells({});
  EXPECT_EQ(summary.invalidCells, 0);
  EXPECT_EQ(summary.minimum(), std::numeric_limits<double>::infinity());
}

} // namespace
