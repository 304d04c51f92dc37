// What stands on what.

#include "MixedMeshes.h"

#include <cadrefine/mesh/EdgeTable.h>
#include <cadrefine/motion/CellStacks.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace
{

using namespace cadrefine;

/// Corner k of the side is an end of an edge of the mesh whose other end is corner k of the other.
bool areJoined(const EdgeTable& table, const Facet& side, const Facet& other)
{
  if (side.corners() != other.corners())
  {
    return false;
  }
  for (int k = 0; k < side.corners(); ++k)
  {
    if (table.find(side.vertices[k], other.vertices[k]) < 0)
    {
      return false;
    }
  }
  return true;
}

std::set<Index> cornersOf(const Facet& side)
{
  return { side.begin(), side.end() };
}

/// Sides of cells of which nothing is opposite: all of simplices and pyramids, of wedges the
/// quadrilaterals.
bool hasOpposite(const Facet& side, std::size_t cellCorners, int dimension)
{
  const std::size_t simplex = dimension + 1u;
  return cellCorners != simplex && cellCorners != 5 && (cellCorners != 6 || side.corners() == 3);
}

class Stacks : public testing::TestWithParam<int>
{
protected:
  const Mesh mesh = cadtest::randomlyMixedMesh(
    GetParam() == 3 ? cadtest::hexahedraMesh(3, 0, 1) : cadtest::quadrilateralsMesh(6, 0, 1), 4);
  const CellStacks stacks{ mesh };

  /// visit(side, number of the cell's corners)
  template<class Visit>
  void forAllSides(const Visit& visit) const
  {
    Index number = 0;
    visitOwnShapes(mesh,
      [&](auto shape, const auto& cells)
      {
        for (const auto& cell : cells)
        {
          forEachSide(shape, cell, number, [&](const Facet& side) { visit(side, cell.size()); });
          ++number;
        }
      });
  }
};

INSTANTIATE_TEST_SUITE_P(Dimensions, Stacks, testing::Values(2, 3));

TEST_P(Stacks, oppositeSidesAreJoinedByEdges)
{
  const EdgeTable table = buildEdgeTable(mesh);
  std::map<std::size_t, int> found;
  forAllSides(
    [&](const Facet& side, std::size_t corners)
    {
      const Facet opposite = stacks.opposite(side);
      if (!hasOpposite(side, corners, mesh.dimension))
      {
        EXPECT_EQ(opposite.vertices[0], -1);
        EXPECT_EQ(opposite.cell, -1);
        return;
      }
      ++found[corners];
      EXPECT_EQ(opposite.cell, side.cell);
      ASSERT_TRUE(areJoined(table, side, opposite));
      std::set<Index> both = cornersOf(side);
      both.insert(opposite.begin(), opposite.end());
      EXPECT_EQ(both.size(), corners);
      EXPECT_EQ(stacks.opposite(opposite).vertices, side.vertices);
    });
  EXPECT_EQ(found.size(), GetParam() == 3 ? 2u : 1u);
}

TEST_P(Stacks, beyondIsTheOtherCellIfItIsPartOfAStack)
{
  std::map<std::set<Index>, std::map<Index, std::size_t>> cellsOf;
  forAllSides(
    [&](const Facet& side, std::size_t corners) { cellsOf[cornersOf(side)][side.cell] = corners; });
  const std::size_t simplex = mesh.dimension + 1u;
  int found = 0;
  forAllSides(
    [&](const Facet& side, std::size_t)
    {
      Index expected = -1;
      for (const auto& [cell, corners] : cellsOf[cornersOf(side)])
      {
        expected = cell != side.cell && corners != simplex && corners != 5 ? cell : expected;
      }
      const Facet beyond = stacks.beyond(side);
      EXPECT_EQ(beyond.cell, expected);
      EXPECT_EQ(beyond.vertices, side.vertices);
      found += expected >= 0;
    });
  EXPECT_GT(found, 10);
}

/// From the wall up to the pyramids and tetrahedra on top.
TEST(LayerStacks, climbToTheTop)
{
  for (const cadtest::BoxKind kind : { cadtest::BoxKind::Hexahedron, cadtest::BoxKind::Wedges })
  {
    const Mesh hexahedra = cadtest::hexahedralShellMesh(2, 0.01, 2, { 0.1, 0.2, 0.3 });
    const Mesh mesh = cadtest::mixedMesh(
      hexahedra, [&](std::size_t c) { return c < 3 * 24 ? kind : cadtest::BoxKind::Fan; }, 5);
    const CellStacks stacks(mesh);
    int walls = 0;
    for (Facet side : findOuterFacets(mesh))
    {
      if (norm(mesh.points[side.vertices[0]]) > 2.1)
      {
        continue;
      }
      ++walls;
      double radius = norm(mesh.points[side.vertices[0]]);
      for (int level = 0; level < 3; ++level)
      {
        ASSERT_GE(side.cell, 0);
        const Facet above = stacks.opposite(side);
        ASSERT_GE(above.cell, 0);
        for (const Index v : above)
        {
          EXPECT_GT(norm(mesh.points[v]), 1.98 + 0.1 * level);
        }
        EXPECT_NEAR(norm(mesh.points[above.vertices[0]]), radius + 0.1, 1e-12);
        radius += 0.1;
        side = stacks.beyond(above);
      }
      EXPECT_EQ(side.cell, -1) << "the top";
    }
    EXPECT_EQ(walls, kind == cadtest::BoxKind::Wedges ? 48 : 24);
  }
}

} // namespace
