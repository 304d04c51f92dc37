// Positions that cells propose for their interior vertices.

#include "InteriorSmoothing.h"

#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{

using namespace cadrefine;

const ProposalGrid grid{ { -1, -1, -1 }, 4 };
const double gridStep = 4 / std::ldexp(1.0, 36);

std::vector<unsigned char> flags(std::size_t count, std::initializer_list<std::size_t> set)
{
  std::vector<unsigned char> result(count, 0);
  for (const std::size_t i : set)
  {
    result[i] = 1;
  }
  return result;
}

TEST(InteriorSmoothing, proposesTheApexOfTheEquilateralTetrahedron)
{
  const double side = std::sqrt(0.75);
  const SimplexMesh mesh =
    cadtest::oneTetrahedron({ { { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, side, 0 }, { 0.1, 0.2, 0.1 } } });
  const auto sums =
    proposeInteriorPositions(mesh, mesh.points, flags(4, { 3 }), flags(4, { 0 }), grid);
  ASSERT_GT(sums[3].weight, 0);
  EXPECT_LT(
    distance(grid.position(sums[3]), { 0.5, side / 3, std::sqrt(2.0 / 3.0) }), 2 * gridStep);
}

TEST(InteriorSmoothing, proposesTheApexOfTheEquilateralTriangle)
{
  const SimplexMesh mesh =
    cadtest::oneTriangle({ { { 0, 0, 0.5 }, { 1, 0, 0.5 }, { 0.1, 0.1, 0.5 } } });
  const auto sums =
    proposeInteriorPositions(mesh, mesh.points, flags(3, { 2 }), flags(3, { 1 }), grid);
  ASSERT_GT(sums[2].weight, 0);
  EXPECT_LT(distance(grid.position(sums[2]), { 0.5, std::sqrt(0.75), 0.5 }), 2 * gridStep);
}

/// The opposite side stands where its vertices want to be, not where they are.
TEST(InteriorSmoothing, looksAtTheTargetsOfTheOthers)
{
  const SimplexMesh mesh = cadtest::oneTriangle({ { { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, 0.5, 0 } } });
  auto wanted = mesh.points;
  wanted[0][1] = 0.5;
  wanted[1][1] = 0.5;
  const auto sums = proposeInteriorPositions(mesh, wanted, flags(3, { 2 }), flags(3, { 0 }), grid);
  EXPECT_LT(distance(grid.position(sums[2]), { 0.5, 0.5 + std::sqrt(0.75), 0 }), 2 * gridStep);
}

TEST(InteriorSmoothing, proposesNothingWhereNothingIsStuckOrInterior)
{
  const SimplexMesh mesh = cadtest::ballMesh(1, 0.03);
  const auto none = flags(13, {});
  for (const auto& sums :
    { proposeInteriorPositions(mesh, mesh.points, flags(13, { 12 }), none, grid),
      proposeInteriorPositions(mesh, mesh.points, none, flags(13, { 0 }), grid) })
  {
    for (const Proposal& sum : sums)
    {
      EXPECT_EQ(sum.weight, 0);
    }
  }
}

/// All cells of a regular ball propose for the centre: by symmetry it stays.
TEST(InteriorSmoothing, keepsTheCentreOfASymmetricBall)
{
  const SimplexMesh mesh = cadtest::ballMesh(1, 0);
  const std::vector<unsigned char> all(13, 1);
  const auto sums = proposeInteriorPositions(mesh, mesh.points, flags(13, { 12 }), all, grid);
  EXPECT_LT(norm(grid.position(sums[12])), 20 * gridStep);
}

TEST(InteriorSmoothing, weighsWorseCellsMore)
{
  const auto weightAt = [](double height)
  {
    const SimplexMesh mesh =
      cadtest::oneTriangle({ { { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, height, 0 } } });
    return proposeInteriorPositions(mesh, mesh.points, flags(3, { 2 }), flags(3, { 0 }), grid)[2]
      .weight;
  };
  EXPECT_LT(weightAt(0.8), weightAt(0.4));
  EXPECT_LT(weightAt(0.4), weightAt(0.05));
}

TEST(InteriorSmoothing, addsUpBitForBitInAnyOrder)
{
  const SimplexMesh mesh = cadtest::cubeMesh(4, 0.2, 1);
  const std::vector<unsigned char> all(mesh.points.size(), 1);
  const auto expected = proposeInteriorPositions(mesh, mesh.points, all, all, grid);
  for (std::uint64_t seed = 0; seed < 3; ++seed)
  {
    const SimplexMesh shuffled = cadtest::withShuffledCells(mesh, seed);
    const auto sums = proposeInteriorPositions(shuffled, mesh.points, all, all, grid);
    for (std::size_t v = 0; v < sums.size(); ++v)
    {
      EXPECT_EQ(sums[v].weight, expected[v].weight);
      EXPECT_EQ(sums[v].weightedPosition, expected[v].weightedPosition);
    }
  }
}

} // namespace
