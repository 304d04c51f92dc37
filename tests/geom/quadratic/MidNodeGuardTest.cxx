// Mid nodes go as far as all cells stay valid, and no farther back than they must.

#include <cadrefine/quadratic/MidNodeGuard.h>

#include "TestMeshes.h"

#include <cadrefine/quadratic/MidNodes.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace
{

using namespace cadrefine;

const Vector3 up{ 0, 0, 1 };

MidNodes placed(const Mesh& mesh, const EdgeTable& table, const Moves& moves)
{
  MidNodes nodes{ table, middlesOf(mesh, table.edges), {} };
  for (std::size_t e = 0; e < table.edges.size(); ++e)
  {
    nodes.points[e] = moves.position(nodes.points, static_cast<Index>(e));
  }
  return nodes;
}

struct Settled
{
  int sweeps = 0; ///< Until all cells accept.
  std::vector<unsigned char> tooCurved;
};

Settled settle(const Mesh& mesh, const EdgeTable& table, const Vector3& plane, Moves& moves)
{
  const std::vector<Point3> middles = middlesOf(mesh, table.edges);
  MidNodeGuard guard(mesh, table, middles, moves, plane);
  int sweeps = 0;
  while (guard.stepBack(moves))
  {
    ++sweeps;
  }
  return { sweeps, guard.tooCurved() };
}

bool allValid(const Mesh& mesh, const MidNodes& nodes, const Vector3& plane)
{
  const auto valid = findValidCells(mesh, nodes, plane);
  return std::all_of(valid.begin(), valid.end(), [](unsigned char each) { return each == 1; });
}

TEST(MidNodeGuard, leavesValidMovesAlone)
{
  const Mesh mesh = cadtest::oneTriangle({ { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } } });
  const EdgeTable table = buildEdgeTable(mesh);
  Moves moves(middlesOf(mesh, table.edges));
  const Index edge = table.find(0, 1);
  moves.add(edge, { 0.5, -0.2, 0 });
  const Settled settled = settle(mesh, table, up, moves);
  EXPECT_EQ(settled.sweeps, 0);
  EXPECT_EQ(settled.tooCurved, std::vector<unsigned char>{ 0 });
  EXPECT_EQ(moves.fractions[edge], 1);
  EXPECT_EQ(placed(mesh, table, moves).points[edge], (Point3{ 0.5, -0.2, 0 }));
}

/// The Jacobian at the corner vanishes when the node has gone a quarter of the edge: of a way of
/// 0.26 a part of 0.9615 is too much, and the first of the parts 1 - 2^-k below it is 0.9375.
TEST(MidNodeGuard, takesSmallStepsFirst)
{
  const Mesh mesh = cadtest::oneTriangle({ { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } } });
  const EdgeTable table = buildEdgeTable(mesh);
  Moves moves(middlesOf(mesh, table.edges));
  const Index edge = table.find(0, 1);
  moves.add(edge, { 0.76, 0, 0 });
  const Settled settled = settle(mesh, table, up, moves);
  EXPECT_EQ(settled.sweeps, 4);
  EXPECT_EQ(settled.tooCurved, std::vector<unsigned char>{ 1 });
  EXPECT_EQ(moves.fractions[edge], 1 - 1.0 / 16);
  EXPECT_TRUE(allValid(mesh, placed(mesh, table, moves), up));
}

/// A cell that is flat accepts nothing, and a target too far away only the middle.
TEST(MidNodeGuard, endsInTheMiddle)
{
  Mesh mesh = cadtest::oneTetrahedron({ { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } });
  const EdgeTable table = buildEdgeTable(mesh);
  for (const double height : { 1.0, 0.0 })
  {
    mesh.points[3][2] = height;
    Moves moves(middlesOf(mesh, table.edges));
    const Index edge = table.find(1, 2);
    moves.add(edge, { -1e5, -1e5, 0 });
    const Settled settled = settle(mesh, table, {}, moves);
    EXPECT_LE(settled.sweeps, 20);
    EXPECT_EQ(settled.tooCurved[0] != 0, height > 0); // a flat one is not valid anyhow
    EXPECT_EQ(placed(mesh, table, moves).points[edge], (Point3{ 0.5, 0.5, 0 }));
    EXPECT_EQ(allValid(mesh, placed(mesh, table, moves), {}), height > 0);
  }
}

/// Random targets in a cube: all cells end valid, and in the same state whatever the cells' order.
TEST(MidNodeGuard, makesAllCellsValidInAnyOrder)
{
  const Mesh mesh = cadtest::cubeMesh(4, 0.1, 1);
  const EdgeTable table = buildEdgeTable(mesh);
  Moves moves(middlesOf(mesh, table.edges));
  std::mt19937 random(4);
  std::uniform_real_distribution<double> offset(-0.1, 0.1);
  for (std::size_t e = 0; e < table.edges.size(); e += 2)
  {
    const auto edge = static_cast<Index>(e);
    moves.add(
      edge, moves.targets[edge] + Vector3{ offset(random), offset(random), offset(random) });
  }
  EXPECT_FALSE(allValid(mesh, placed(mesh, table, moves), {}));
  Mesh shuffled = mesh;
  std::shuffle(shuffled.tetrahedra.begin(), shuffled.tetrahedra.end(), random);
  const EdgeTable otherTable = buildEdgeTable(shuffled);
  Moves others = moves;
  EXPECT_EQ(settle(mesh, table, {}, moves).sweeps, settle(shuffled, otherTable, {}, others).sweeps);
  EXPECT_TRUE(allValid(mesh, placed(mesh, table, moves), {}));
  EXPECT_EQ(moves.fractions, others.fractions);
  const auto onTheWay = std::count_if(moves.fractions.begin(), moves.fractions.end(),
    [](double fraction) { return fraction > 0 && fraction < 1; });
  EXPECT_GT(onTheWay, 0);
}

} // namespace
