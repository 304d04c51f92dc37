// Meshes of all shapes, split uniformly or where cells are marked.

#include "LeastMarking.h"
#include "MeshChecks.h"
#include "MixedMeshes.h"

#include <cadrefine/refinement/Split.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>

namespace
{

using namespace cadrefine;

using cadtest::IdPair;

/// Sorted by size and corners.
using CellsByPlace = std::multiset<std::vector<Point3>>;

std::vector<GlobalId> followingIds(const Mesh& mesh, const Midpoints& midpoints)
{
  std::vector<GlobalId> ids(midpoints.parentEdges.size());
  std::iota(ids.begin(), ids.end(), static_cast<GlobalId>(mesh.points.size()));
  return ids;
}

SplitMesh uniformly(const Mesh& mesh)
{
  const EdgeTable table = buildEdgeTable(mesh);
  const QuadTable quads = buildQuadTable(table);
  const EdgeMarks marks(table.edges.size(), 1);
  const Midpoints midpoints = makeMidpoints(mesh, table, quads, marks, true);
  return splitUniformly(mesh, table, quads, midpoints, followingIds(mesh, midpoints));
}

/// As one rank refines it: the marks closed, stacks in order, badly cut cells cut whole.
struct Marking
{
  Marking(const Mesh& mesh, const std::vector<unsigned char>& cellMarks, bool keepLayers)
    : table(buildEdgeTable(mesh)), quads(buildQuadTable(table)), marks(table.edges.size(), 0)
  {
    if (keepLayers)
    {
      EdgeStacks stacks(table, mesh.ids);
      stacks.spread();
      EXPECT_FALSE(stacks.spread());
      stacks.writeTo(table);
    }
    markLongestEdges(mesh, table, cellMarks, keepLayers, marks);
    MarkClosure(table, mesh.dimension, keepLayers, marks).closeAll();
  }

  SplitMesh split(const Mesh& mesh) const
  {
    const Midpoints midpoints = makeMidpoints(mesh, table, quads, marks, false);
    return splitMarked(mesh, table, quads, marks, midpoints, followingIds(mesh, midpoints));
  }

  std::set<IdPair> ids(const Mesh& mesh) const
  {
    std::set<IdPair> result;
    for (std::size_t e = 0; e < marks.size(); ++e)
    {
      if (marks[e])
      {
        result.insert({ mesh.ids[table.edges[e][0]], mesh.ids[table.edges[e][1]] });
      }
    }
    return result;
  }

  EdgeTable table;
  QuadTable quads;
  EdgeMarks marks;
};

CellsByPlace byPlace(const Mesh& mesh)
{
  CellsByPlace all;
  visitShapes(mesh,
    [&](auto, const auto& cells)
    {
      for (const auto& cell : cells)
      {
        std::vector<Point3> corners(cell.size());
        std::transform(
          cell.begin(), cell.end(), corners.begin(), [&](Index v) { return mesh.points[v]; });
        std::sort(corners.begin(), corners.end());
        all.insert(corners);
      }
    });
  return all;
}

bool onBox(const Mesh& mesh, const std::vector<Point3>& side)
{
  return cadtest::onUnitCube(side, mesh.dimension);
}

void expectSound(const Mesh& mesh)
{
  EXPECT_TRUE(cadtest::isValid(mesh));
  EXPECT_TRUE(cadtest::isWatertight(
    mesh, [&](const std::vector<Point3>& side) { return onBox(mesh, side); }));
  EXPECT_TRUE(cadtest::hasNoHangingVertex(mesh));
  EXPECT_NEAR(cadtest::measureOf(mesh), 1, 1e-13);
}

/// Cells with their corners turned about.
Mesh withTurnedCells(Mesh mesh, std::uint64_t seed)
{
  std::mt19937_64 random(seed);
  for (auto& h : mesh.hexahedra)
  {
    for (auto turns = random() % 4; turns > 0; --turns)
    {
      h = { h[1], h[2], h[3], h[0], h[5], h[6], h[7], h[4] };
    }
    for (auto turns = random() % 3; turns > 0; --turns)
    {
      h = { h[0], h[4], h[5], h[1], h[3], h[7], h[6], h[2] };
    }
  }
  for (auto& w : mesh.wedges)
  {
    for (auto turns = random() % 3; turns > 0; --turns)
    {
      w = { w[1], w[2], w[0], w[4], w[5], w[3] };
    }
    if (random() % 2)
    {
      w = { w[3], w[5], w[4], w[0], w[2], w[1] };
    }
  }
  for (auto& p : mesh.pyramids)
  {
    for (auto turns = random() % 4; turns > 0; --turns)
    {
      p = { p[1], p[2], p[3], p[0], p[4] };
    }
  }
  for (auto& q : mesh.quadrilaterals)
  {
    for (auto turns = random() % 4; turns > 0; --turns)
    {
      q = { q[1], q[2], q[3], q[0] };
    }
  }
  return mesh;
}

class MixedSplit : public testing::TestWithParam<int>
{
protected:
  static Mesh mesh(std::uint64_t seed, double jitter = 0.1)
  {
    const Mesh boxes = GetParam() == 3 ? cadtest::hexahedraMesh(2 + seed % 2, jitter, seed)
                                       : cadtest::quadrilateralsMesh(4, jitter, seed);
    return cadtest::withListedBoundary(cadtest::randomlyMixedMesh(boxes, seed));
  }

  static std::vector<unsigned char> someCells(const Mesh& mesh, std::uint64_t seed)
  {
    std::mt19937_64 random(seed);
    std::vector<unsigned char> marks(mesh.cellCount(mesh.dimension));
    std::generate(marks.begin(), marks.end(), [&] { return random() % 6 == 0; });
    marks[seed % marks.size()] = 1;
    return marks;
  }
};

INSTANTIATE_TEST_SUITE_P(Dimensions, MixedSplit, testing::Values(2, 3));

TEST_P(MixedSplit, meshesToStartFromAreSound)
{
  std::size_t shapes[4]{};
  for (std::uint64_t seed = 0; seed < 6; ++seed)
  {
    const Mesh mesh = this->mesh(seed);
    expectSound(mesh);
    EXPECT_TRUE(cadtest::isBoundedByListedCells(mesh));
    std::size_t* count = shapes;
    visitOwnShapes(mesh, [&](auto, const auto& cells) { *count++ += cells.size(); });
  }
  for (int k = 0; k < (GetParam() == 3 ? 4 : 2); ++k)
  {
    EXPECT_GT(shapes[k], 10u) << "shape " << k;
  }
}

TEST_P(MixedSplit, uniformLevelsAreSound)
{
  for (std::uint64_t seed = 0; seed < 4; ++seed)
  {
    SCOPED_TRACE(seed);
    Mesh mesh = this->mesh(seed);
    for (int level = 0; level < 2; ++level)
    {
      const SplitMesh split = uniformly(mesh);
      const Mesh& fine = split.mesh;
      EXPECT_EQ(fine.tetrahedra.size(), 8 * mesh.tetrahedra.size() + 4 * mesh.pyramids.size());
      EXPECT_EQ(fine.pyramids.size(), 6 * mesh.pyramids.size());
      EXPECT_EQ(fine.wedges.size(), 8 * mesh.wedges.size());
      EXPECT_EQ(fine.hexahedra.size(), 8 * mesh.hexahedra.size());
      EXPECT_EQ(fine.triangles.size(), 4 * mesh.triangles.size());
      EXPECT_EQ(fine.quadrilaterals.size(), 4 * mesh.quadrilaterals.size());
      EXPECT_EQ(fine.segments.size(), 2 * mesh.segments.size());
      mesh = fine;
      expectSound(mesh);
      EXPECT_TRUE(cadtest::isBoundedByListedCells(mesh));
    }
  }
}

/// Upside down over a base like a dart, one corner of which lies deeper than the others, a pyramid
/// is inverted.
TEST(PyramidSplit, partsWhatWouldBeInverted)
{
  Mesh mesh;
  mesh.points = { { -0.617, 0.213, -0.474 }, { -0.262, 0.213, -0.474 }, { -0.431, 0, -0.519 },
    { -0.615, -0.203, -0.478 }, { -0.493, 0.066, -0.583 } };
  mesh.ids = { 0, 1, 2, 3, 4 };
  const double volume = [&]
  {
    mesh.pyramids = { { 0, 1, 2, 3, 4 } };
    return cadtest::measureOf(mesh);
  }();
  CellsByPlace expected;
  for (int turn = 0; turn < 4; ++turn)
  {
    ASSERT_TRUE(cadtest::isValid(mesh));
    const EdgeTable table = buildEdgeTable(mesh);
    const EdgeMarks marks(table.edges.size(), 1);
    EXPECT_TRUE(cellsCutBadly(mesh, table, buildQuadTable(table), marks, true).empty());
    const SplitMesh split = uniformly(mesh);
    EXPECT_EQ(split.mesh.pyramids.size(), 4u);
    EXPECT_EQ(split.mesh.tetrahedra.size(), 8u);
    EXPECT_EQ(split.firstChildren[3], (std::vector<Index>{ 0, 12 }));
    EXPECT_TRUE(cadtest::isValid(split.mesh));
    EXPECT_NEAR(cadtest::measureOf(split.mesh), volume, 1e-15);
    expected = turn == 0 ? byPlace(split.mesh) : expected;
    EXPECT_EQ(byPlace(split.mesh), expected) << "whichever corner is the first";
    auto& [a, b, c, d, apex] = mesh.pyramids[0];
    mesh.pyramids[0] = { b, c, d, a, apex };
  }
}

/// Children, in the order in which they are named, fill their parents.
TEST_P(MixedSplit, namesChildrenOfEachCell)
{
  const auto measures = [](const Mesh& mesh)
  {
    std::vector<double> all;
    visitOwnShapes(mesh,
      [&](auto shape, const auto& cells)
      {
        for (const auto& cell : cells)
        {
          Mesh one;
          one.dimension = mesh.dimension;
          one.points = mesh.points;
          (one.*decltype(shape)::cells) = { cell };
          all.push_back(cadtest::measureOf(one));
        }
      });
    return all;
  };
  const Mesh mesh = this->mesh(3, 0); // sides are plane
  const auto before = measures(mesh);
  const auto expectFilled = [&](const SplitMesh& split)
  {
    const int d = mesh.dimension;
    const auto after = measures(split.mesh);
    ASSERT_EQ(split.firstChildren[d].size(), before.size() + 1);
    ASSERT_EQ(static_cast<std::size_t>(split.firstChildren[d].back()), after.size());
    for (std::size_t c = 0; c < before.size(); ++c)
    {
      double sum = 0;
      for (Index k = split.firstChildren[d][c]; k < split.firstChildren[d][c + 1]; ++k)
      {
        sum += after[split.children[d].empty() ? k : split.children[d][k]];
      }
      EXPECT_NEAR(sum, before[c], 1e-15) << "cell " << c;
    }
  };
  expectFilled(uniformly(mesh));
  for (const bool keepLayers : { false, true })
  {
    expectFilled(Marking(mesh, someCells(mesh, 4), keepLayers).split(mesh));
  }
}

/// Bit for bit; corners of cells in another turn make the same vertices, too.
TEST_P(MixedSplit, uniformSplitDoesNotDependOnTheOrderOfCellsAndCorners)
{
  const Mesh mesh = this->mesh(5);
  const auto expected = byPlace(uniformly(mesh).mesh);
  for (std::uint64_t seed = 0; seed < 3; ++seed)
  {
    const Mesh other = withTurnedCells(cadtest::withMixedOrder(mesh, seed), seed);
    EXPECT_EQ(byPlace(uniformly(other).mesh), expected);
  }
}

TEST_P(MixedSplit, markedLevelsAreSound)
{
  for (const bool keepLayers : { false, true })
  {
    for (std::uint64_t seed = 0; seed < 6; ++seed)
    {
      SCOPED_TRACE("seed " + std::to_string(seed) + (keepLayers ? ", layers kept" : ""));
      Mesh mesh = this->mesh(seed, 0.05);
      for (int level = 0; level < 3; ++level)
      {
        const std::size_t before = mesh.cellCount();
        const Marking marking(mesh, someCells(mesh, seed), keepLayers);
        if (!cellsCutBadly(mesh, marking.table, marking.quads, marking.marks, false).empty())
        {
          break; // what then happens is for all ranks to decide
        }
        mesh = marking.split(mesh).mesh;
        EXPECT_GT(mesh.cellCount(), before);
        expectSound(mesh);
        EXPECT_TRUE(cadtest::isBoundedByListedCells(mesh));
      }
    }
  }
}

TEST_P(MixedSplit, markedSplitDoesNotDependOnTheOrderOfCells)
{
  for (const bool keepLayers : { false, true })
  {
    const Mesh mesh = this->mesh(7);
    const auto cellMarks = someCells(mesh, 8);
    std::set<std::vector<Index>> marked;
    const auto visitMarks = [](const Mesh& any, const auto& visit)
    {
      std::size_t c = 0;
      visitOwnShapes(any,
        [&](auto, const auto& cells)
        {
          for (const auto& cell : cells)
          {
            visit(c++, std::vector<Index>(cell.begin(), cell.end()));
          }
        });
    };
    visitMarks(mesh,
      [&](std::size_t c, const std::vector<Index>& cell)
      {
        if (cellMarks[c])
        {
          marked.insert(cell);
        }
      });
    const auto expected = byPlace(Marking(mesh, cellMarks, keepLayers).split(mesh).mesh);
    for (std::uint64_t seed = 0; seed < 3; ++seed)
    {
      const Mesh other = cadtest::withMixedOrder(mesh, seed);
      std::vector<unsigned char> marks(cellMarks.size());
      visitMarks(other,
        [&](std::size_t c, const std::vector<Index>& cell) { marks[c] = marked.count(cell) > 0; });
      EXPECT_EQ(byPlace(Marking(other, marks, keepLayers).split(other).mesh), expected);
    }
  }
}

TEST_P(MixedSplit, marksAreTheLeastFixpoint)
{
  for (const bool keepLayers : { false, true })
  {
    for (std::uint64_t seed = 0; seed < 12; ++seed)
    {
      SCOPED_TRACE("seed " + std::to_string(seed) + (keepLayers ? ", layers kept" : ""));
      Mesh mesh = this->mesh(seed, seed % 3 == 0 ? 0 : 0.15);
      std::mt19937_64 random(seed);
      constexpr double stretches[] = { 1, 0.3, 1, 3 };
      for (Point3& point : mesh.points)
      {
        point[1] *= stretches[seed % 4]; // thin cells, long ones
      }
      const auto cellMarks = someCells(mesh, seed);
      const auto found = Marking(mesh, cellMarks, keepLayers).ids(mesh);
      EXPECT_EQ(found, cadtest::leastMixedMarking(mesh, cellMarks, keepLayers));
      EXPECT_FALSE(found.empty());
    }
  }
}

/// Layers round a sphere: cells over each other are cut alike, along the wall alone, into cells of
/// layers.
TEST(Layers, areCutAlongTheWallAlone)
{
  const std::vector<double> heights{ 0.01, 0.03, 0.07, 0.15 };
  for (const auto kind : { cadtest::BoxKind::Hexahedron, cadtest::BoxKind::Wedges })
  {
    const Mesh boxes = cadtest::hexahedralShellMesh(2, 0.005, 3, heights);
    const std::size_t layerBoxes = heights.size() * 54;
    Mesh mesh = cadtest::mixedMesh(
      boxes, [&](std::size_t c) { return c < layerBoxes ? kind : cadtest::BoxKind::Fan; }, 1);
    std::mt19937_64 random(2);
    for (int level = 0; level < 3; ++level)
    {
      std::vector<unsigned char> marks(mesh.cellCount(3));
      std::generate(marks.begin(), marks.end(), [&] { return random() % 12 == 0; });
      const Marking marking(mesh, marks, true);
      ASSERT_TRUE(cellsCutBadly(mesh, marking.table, marking.quads, marking.marks, false).empty());
      const SplitMesh split = marking.split(mesh);
      Index cell = static_cast<Index>(mesh.tetrahedra.size() + mesh.pyramids.size());
      const auto end = static_cast<Index>(mesh.cellCount(3));
      const auto firstOfLayers =
        static_cast<Index>(split.mesh.tetrahedra.size() + split.mesh.pyramids.size());
      for (; cell < end; ++cell)
      {
        for (Index k = split.firstChildren[3][cell]; k < split.firstChildren[3][cell + 1]; ++k)
        {
          EXPECT_GE(split.children[3][k], firstOfLayers) << "a pyramid or a tetrahedron";
        }
      }
      mesh = split.mesh;
      EXPECT_TRUE(cadtest::isValid(mesh));
      EXPECT_TRUE(cadtest::hasNoHangingVertex(mesh));
      EXPECT_TRUE(cadtest::isWatertight(mesh,
        [](const std::vector<Point3>& side)
        {
          return std::all_of(side.begin(), side.end(),
            [](const Point3& p) { return norm(p) < 2.011 || norm(p) > 4; });
        }));
    }
    // As many in each layer.
    EXPECT_EQ(mesh.wedges.size() % heights.size(), 0u);
    EXPECT_EQ(mesh.hexahedra.size() % heights.size(), 0u);
    EXPECT_GT(mesh.wedges.size() + mesh.hexahedra.size(), 2 * layerBoxes);
  }
}

/// As long as cells are long, there is no pyramid and no tetrahedron among their parts.
TEST(LongCells, areCutFromEndToEnd)
{
  for (const auto kind : { cadtest::BoxKind::Hexahedron, cadtest::BoxKind::Wedges })
  {
    Mesh mesh = cadtest::mixedMesh(
      cadtest::hexahedraMesh(4, 0.1, 5), [&](std::size_t) { return kind; }, 1);
    for (Point3& point : mesh.points)
    {
      point[2] *= 20;
    }
    std::mt19937_64 random(3);
    for (int level = 0; level < 3; ++level)
    {
      std::vector<unsigned char> marks(mesh.cellCount(3));
      std::generate(marks.begin(), marks.end(), [&] { return random() % 12 == 0; });
      const Marking marking(mesh, marks, true);
      const std::size_t before = mesh.cellCount(3);
      mesh = marking.split(mesh).mesh;
      EXPECT_GT(mesh.cellCount(3), before);
      EXPECT_EQ(mesh.cellCount(3), mesh.hexahedra.size() + mesh.wedges.size());
      EXPECT_TRUE(cadtest::isValid(mesh));
      EXPECT_TRUE(cadtest::hasNoHangingVertex(mesh));
    }
  }
}

} // namespace
