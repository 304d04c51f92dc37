// Moves that must not spoil a cell: it may collapse, invert, or have been poor from the start.

#include "MeshChecks.h"
#include "TestMeshes.h"

#include <cadrefine/mesh/CellJacobian.h>
#include <cadrefine/mesh/Orientation.h>
#include <cadrefine/mesh/Quality.h>
#include <cadrefine/motion/MoveGuard.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace
{

using namespace cadrefine;

/// Sweeps until nothing is halved; the number of sweeps.
int settle(const Mesh& mesh, Moves& moves)
{
  MoveGuard guard(mesh, moves, mesh.points, {});
  int sweeps = 0;
  while (guard.halveUnaccepted(moves))
  {
    ++sweeps;
    EXPECT_LT(sweeps, 100);
  }
  return sweeps;
}

/// Quality of the only cell where the moves put it; negative where it is inverted.
double qualityAfter(const Mesh& mesh, const Moves& moves)
{
  const auto at = [&](Index v) { return moves.position(mesh.points, v); };
  if (mesh.dimension == 3)
  {
    return meanRatio(at(0), at(1), at(2), at(3));
  }
  const double turn = dot(twofoldAreaVector(at(0), at(1), at(2)),
    twofoldAreaVector(mesh.points[0], mesh.points[1], mesh.points[2]));
  return std::copysign(meanRatio(at(0), at(1), at(2)), turn);
}

/// An equilateral triangle or tetrahedron whose last vertex is to move to height `target` (in
/// heights of the cell, so that 0 is flat and -1 is turned over).
class Apex : public testing::TestWithParam<int>
{
protected:
  Mesh cell(double height = 1) const
  {
    const double side = std::sqrt(0.75);
    return GetParam() == 3
             ? cadtest::oneTetrahedron({ { { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, side, 0 },
                 { 0.5, side / 3, height * std::sqrt(2.0 / 3.0) } } })
             : cadtest::oneTriangle({ { { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, height * side, 0 } } });
  }

  static Point3 apexAt(const Mesh& mesh, double height)
  {
    Point3 point = mesh.points[GetParam()];
    point[GetParam() - 1] *= height;
    return point;
  }

  static Moves move(const Mesh& mesh, double height)
  {
    Moves moves(mesh.points);
    moves.add(GetParam(), apexAt(mesh, height));
    return moves;
  }
};

INSTANTIATE_TEST_SUITE_P(Dimensions, Apex, testing::Values(2, 3));

TEST_P(Apex, reachesAGoodPlaceExactly)
{
  const Mesh mesh = cell();
  Moves moves = move(mesh, 0.7);
  EXPECT_EQ(settle(mesh, moves), 0);
  EXPECT_EQ(moves.fractions[GetParam()], 1);
  EXPECT_EQ(moves.position(mesh.points, GetParam()), apexAt(mesh, 0.7));
}

TEST_P(Apex, doesNotCollapseTheCell)
{
  const Mesh mesh = cell();
  Moves moves = move(mesh, 0);
  EXPECT_EQ(settle(mesh, moves), 1);
  EXPECT_EQ(moves.fractions[GetParam()], 0.5);
  EXPECT_GE(qualityAfter(mesh, moves), MoveGuard::qualityFloor);
}

TEST_P(Apex, doesNotInvertTheCell)
{
  for (const double height : { -0.2, -1.0, -3.0, -100.0 })
  {
    const Mesh mesh = cell();
    Moves moves = move(mesh, height);
    EXPECT_GT(settle(mesh, moves), 0);
    EXPECT_GT(moves.fractions[GetParam()], 0) << "part of the way is free";
    EXPECT_GE(qualityAfter(mesh, moves), MoveGuard::qualityFloor);
  }
}

TEST_P(Apex, doesNotMoveAtAllWhereNoPartOfTheWayIsFree)
{
  const Mesh mesh = cell();
  Moves moves = move(mesh, -1e9);
  EXPECT_EQ(settle(mesh, moves), MoveGuard::maximumHalvings + 1);
  EXPECT_EQ(moves.fractions[GetParam()], 0);
  EXPECT_EQ(moves.position(mesh.points, GetParam()), mesh.points[GetParam()]);
}

/// A cell below the floor must not freeze: it may lose half of its quality, but stays valid.
TEST_P(Apex, ofAPoorCellMovesAsLongAsItKeepsHalfOfItsQuality)
{
  const Mesh mesh = cell(1e-3);
  const double before = qualityAfter(mesh, Moves(mesh.points));
  ASSERT_LT(before, MoveGuard::qualityFloor);
  ASSERT_GT(before, 0);
  Moves better = move(mesh, 2);
  EXPECT_EQ(settle(mesh, better), 0);
  Moves slightlyWorse = move(mesh, 0.8);
  EXPECT_EQ(settle(mesh, slightlyWorse), 0);
  Moves flat = move(mesh, 0);
  EXPECT_GT(settle(mesh, flat), 0);
  EXPECT_GE(qualityAfter(mesh, flat), 0.5 * before);
}

/// Nor must moves in many steps make it ever worse.
TEST_P(Apex, ofAnAlmostFlatCellDoesNotMakeItFlatter)
{
  Mesh mesh = cell(1e-3);
  double before = qualityAfter(mesh, Moves(mesh.points));
  for (int step = 0; step < 40; ++step)
  {
    Moves flat = move(mesh, 0);
    settle(mesh, flat);
    mesh.points[GetParam()] = flat.position(mesh.points, GetParam());
  }
  EXPECT_GE(qualityAfter(mesh, Moves(mesh.points)), std::min(before, MoveGuard::lowestQuality));
}

TEST(MoveGuard, letsAnInvertedTetrahedronBecomeValid)
{
  const Mesh mesh =
    cadtest::oneTetrahedron({ { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, -1 } } });
  Moves moves(mesh.points);
  moves.add(3, { 0, 0, 1 });
  EXPECT_EQ(settle(mesh, moves), 0);
  EXPECT_GT(qualityAfter(mesh, moves), 0);
}

TEST(MoveGuard, movesAFlatTetrahedronOnlyIfItGetsNoWorse)
{
  const Mesh mesh =
    cadtest::oneTetrahedron({ { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0.3, 0.3, 0 } } });
  Moves up(mesh.points);
  up.add(3, { 0.3, 0.3, 1 });
  EXPECT_EQ(settle(mesh, up), 0);
  Moves down(mesh.points);
  down.add(3, { 0.3, 0.3, -1 });
  EXPECT_GT(settle(mesh, down), 0);
  EXPECT_EQ(down.fractions[3], 0);
}

TEST(MoveGuard, stopsATriangleInSpaceThatTurnsOver)
{
  Mesh mesh = cadtest::oneTriangle({ { { 0, 0, 0 }, { 1, 0, 1 }, { 0, 1, 1 } } });
  Moves moves(mesh.points);
  moves.add(2, { 1, -1, 0.5 });
  EXPECT_GT(settle(mesh, moves), 0);
  EXPECT_GT(qualityAfter(mesh, moves), 0);
}

/// In the plane, cells that do not turn the way most do are invalid; in space there is no such way.
TEST(MoveGuard, letsAnInvertedTriangleBecomeValidInThePlane)
{
  Mesh mesh = cadtest::oneTriangle({ { { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, -0.5, 0 } } });
  const Vector3 plane{ 0, 0, 1 };
  Moves over(mesh.points);
  over.add(2, { 0.5, 0.5, 0 });
  EXPECT_FALSE(MoveGuard(mesh, over, mesh.points, plane).halveUnaccepted(over));
  EXPECT_TRUE(MoveGuard(mesh, over, mesh.points, {}).halveUnaccepted(over));
  const std::vector<Point3> reference = mesh.points;
  mesh.points[2] = { 0.5, 0.5, 0 };
  Moves back(mesh.points);
  back.add(2, { 0.5, -0.5, 0 });
  EXPECT_TRUE(MoveGuard(mesh, back, reference, plane).halveUnaccepted(back))
    << "once mended, it stays so";
}

TEST(MoveGuard, stopsWholeMovesAtOnce)
{
  const Mesh mesh =
    cadtest::oneTetrahedron({ { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } });
  Moves down(mesh.points);
  down.add(3, { 0, 0, -0.1 });
  down.whole[3] = 1;
  EXPECT_EQ(settle(mesh, down), 1);
  EXPECT_EQ(down.position(mesh.points, 3), mesh.points[3]);
  Moves up(mesh.points);
  up.add(3, { 0, 0, 2 });
  up.whole[3] = 1;
  EXPECT_EQ(settle(mesh, up), 0);
  EXPECT_EQ(up.position(mesh.points, 3), (Point3{ 0, 0, 2 }));
}

/// The way ends in the plane of the others up to rounding: only exact arithmetic can tell.
TEST(MoveGuard, acceptsNoFlatCellHoweverPoorItWas)
{
  const Point3 a{ 0.1, 0.2, 0.3 };
  const Point3 b{ 1.7, 0.9, 0.7 };
  const Point3 c{ 0.4, 1.3, 0.1 };
  const Point3 inPlane = (1.0 / 3.0) * (a + b + c);
  const Vector3 normal = normalized(twofoldAreaVector(a, b, c));
  const Mesh mesh = cadtest::oneTetrahedron({ { a, b, c, inPlane + 1e-12 * normal } });
  for (int k = -3; k <= 3; ++k)
  {
    Moves moves(mesh.points);
    moves.add(3, inPlane + k * 1e-17 * normal);
    settle(mesh, moves);
    EXPECT_EQ(orientation(a, b, c, moves.position(mesh.points, 3)), 1);
  }
}

TEST(MoveGuard, namesTheVerticesOfSpoiltCells)
{
  Mesh mesh = cadtest::oneTetrahedron({ { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } });
  Moves moves(mesh.points);
  moves.add(3, { 0, 0, 0.3 });
  const std::vector<Point3> reference = mesh.points;
  const MoveGuard guard(mesh, moves, reference, {});
  EXPECT_TRUE(guard.verticesOfSpoiltCells(0.9).empty());
  mesh.points[3] = { 0, 0, 0.3 };
  EXPECT_EQ(guard.verticesOfSpoiltCells(0.9), (std::vector<Index>{ 0, 1, 2, 3 }));
  EXPECT_TRUE(guard.verticesOfSpoiltCells(0.1).empty());
}

/// Both cells at a vertex limit it: the result does not depend on which comes first.
TEST(MoveGuard, doesNotDependOnTheOrderOfCells)
{
  const Mesh mesh = cadtest::cubeMesh(3, 0.2, 1);
  const Mesh shuffled = cadtest::withShuffledCells(mesh, 2);
  Moves first(mesh.points);
  Moves second(shuffled.points);
  for (Index v = 0; v < static_cast<Index>(mesh.points.size()); v += 2)
  {
    const Point3 target = mesh.points[v] + Vector3{ 0.3, 0.01 * v, -0.2 };
    first.add(v, target);
    second.add(v, target);
  }
  EXPECT_GT(settle(mesh, first), 0);
  settle(shuffled, second);
  EXPECT_EQ(first.fractions, second.fractions);
  for (const auto& cell : mesh.tetrahedra)
  {
    const auto at = [&](int k) { return first.position(mesh.points, cell[k]); };
    EXPECT_GT(meanRatio(at(0), at(1), at(2), at(3)), 0);
  }
}

TEST(MoveGuard, leavesCellsAloneThatDoNotMove)
{
  Mesh mesh = cadtest::ballMesh(1, 0);
  std::swap(mesh.tetrahedra[0][0], mesh.tetrahedra[0][1]); // inverted from the start
  Moves moves(mesh.points);
  EXPECT_EQ(settle(mesh, moves), 0);
}

/// In space, as seen from where it was and from its own side.
TEST(QuadrilateralInSpace, staysValidAsSeenFromItsOwnSide)
{
  Mesh mesh;
  mesh.dimension = 2;
  mesh.points = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } };
  mesh.ids = { 0, 1, 2, 3 };
  mesh.quadrilaterals = { { 0, 1, 2, 3 } };
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> any(-1.5, 1.5);
  int halved = 0;
  for (int round = 0; round < 2000; ++round)
  {
    Moves moves(mesh.points);
    for (Index vertex = 0; vertex < 4; ++vertex)
    {
      moves.add(vertex, mesh.points[vertex] + Vector3{ any(random), any(random), any(random) });
    }
    halved += settle(mesh, moves) > 0;
    Mesh moved = mesh;
    for (Index vertex = 0; vertex < 4; ++vertex)
    {
      moved.points[vertex] = moves.position(mesh.points, vertex);
    }
    EXPECT_TRUE(cadtest::isValid(moved));
    std::array<Point3, 4> p;
    std::copy(moved.points.begin(), moved.points.end(), p.begin());
    EXPECT_TRUE(isValidQuadrilateral(p, { 0, 0, 1 }));
  }
  EXPECT_GT(halved, 100);
  EXPECT_LT(halved, 2000);
}

} // namespace
