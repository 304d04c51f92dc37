// Longest edge marking against a brute-force least fixpoint.

#include <cadrefine/refinement/LongestEdgeMarking.h>

#include "LeastMarking.h"
#include "MeshChecks.h"
#include "TestMeshes.h"

#include <cadrefine/refinement/Split.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <ostream>
#include <random>
#include <set>

namespace
{

using namespace cadrefine;

using cadtest::cellsOf;
using cadtest::IdPair;

struct Closure
{
  Closure(const Mesh& mesh, const std::vector<unsigned char>& cellMarks)
    : table(buildEdgeTable(mesh)), marks(table.edges.size(), 0)
  {
    markLongestEdges(mesh, table, cellMarks, true, marks);
    MarkClosure(table, mesh.dimension, true, marks).closeAll();
    for (std::size_t e = 0; e < marks.size(); ++e)
    {
      if (marks[e])
      {
        ids.insert({ mesh.ids[table.edges[e][0]], mesh.ids[table.edges[e][1]] });
      }
    }
  }

  EdgeTable table;
  EdgeMarks marks;
  std::set<IdPair> ids;
};

struct Case
{
  int dimension;
  double jitter; ///< 0: many edges of equal length.
};

void PrintTo(const Case& tried, std::ostream* out)
{
  *out << tried.dimension << "D, jitter " << tried.jitter;
}

class LongestEdge : public testing::TestWithParam<Case>
{
protected:
  Mesh mesh(std::uint64_t seed) const
  {
    const auto [dimension, jitter] = GetParam();
    return dimension == 3 ? cadtest::cubeMesh(3, jitter, seed)
                          : cadtest::squareMesh(8, jitter, seed);
  }

  static std::vector<unsigned char> someCells(const Mesh& mesh, std::uint64_t seed)
  {
    std::mt19937_64 random(seed);
    std::vector<unsigned char> marks(mesh.cellCount());
    std::generate(marks.begin(), marks.end(), [&] { return random() % 20 == 0; });
    return marks;
  }
};

INSTANTIATE_TEST_SUITE_P(Meshes, LongestEdge,
  testing::Values(Case{ 2, 0 }, Case{ 2, 0.3 }, Case{ 3, 0 }, Case{ 3, 0.2 }),
  [](const auto& mesh)
  {
    return std::string(mesh.param.dimension == 3 ? "Tetrahedra" : "Triangles") +
           (mesh.param.jitter > 0 ? "Moved" : "Regular");
  });

TEST_P(LongestEdge, closureIsTheLeastFixpoint)
{
  for (std::uint64_t seed = 0; seed < 6; ++seed)
  {
    const Mesh mesh = this->mesh(seed);
    const auto cellMarks = someCells(mesh, seed);
    const Closure closure(mesh, cellMarks);
    EXPECT_EQ(closure.ids, cadtest::leastMarking(mesh, cellMarks));
    EXPECT_FALSE(closure.ids.empty());
  }
}

/// The same cells from the last to the first.
Mesh withReversedCells(Mesh mesh)
{
  std::reverse(mesh.tetrahedra.begin(), mesh.tetrahedra.end());
  std::reverse(mesh.triangles.begin(), mesh.triangles.end());
  return mesh;
}

TEST_P(LongestEdge, closureDoesNotDependOnTheOrderOfCells)
{
  const Mesh mesh = this->mesh(11);
  const auto cellMarks = someCells(mesh, 12);
  const auto cells = cellsOf(mesh);
  std::set<std::vector<Index>> marked;
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    if (cellMarks[c])
    {
      marked.insert(cells[c]);
    }
  }
  std::vector<Mesh> others = { withReversedCells(mesh) };
  for (std::uint64_t seed = 0; seed < 4; ++seed)
  {
    others.push_back(cadtest::withShuffledCells(mesh, seed));
  }
  for (const Mesh& other : others)
  {
    std::vector<unsigned char> otherMarks;
    for (const auto& cell : cellsOf(other))
    {
      otherMarks.push_back(marked.count(cell) > 0);
    }
    EXPECT_EQ(Closure(other, otherMarks).ids, Closure(mesh, cellMarks).ids);
  }
}

/// Marks that arrive later, as those of other ranks do, give what marks from the start give;
/// however often they arrive, no cell is looked at more often than its edges are marked, but for
/// the sweeps.
TEST_P(LongestEdge, marksMayArriveLater)
{
  const Mesh mesh = this->mesh(16);
  const auto cellMarks = someCells(mesh, 17);
  const EdgeTable table = buildEdgeTable(mesh);
  EdgeMarks marks(table.edges.size(), 0);
  MarkClosure closure(table, 2, true, marks);
  EXPECT_FALSE(closure.closeAll());
  const std::size_t sides = mesh.dimension == 3 ? 6 : 3;
  std::size_t arrived = 0;
  for (std::size_t c = 0; c < cellMarks.size(); ++c)
  {
    std::vector<unsigned char> oneMark(cellMarks.size(), 0);
    oneMark[c] = cellMarks[c];
    const EdgeMarks before = marks;
    markLongestEdges(mesh, table, oneMark, true, marks);
    const auto fresh = std::mismatch(marks.begin(), marks.end(), before.begin()).first;
    if (fresh != marks.end())
    {
      const EdgeMarks arrival = marks;
      const bool changed = closure.closeFrom({ static_cast<Index>(fresh - marks.begin()) });
      EXPECT_EQ(changed, marks != arrival);
      ++arrived;
    }
  }
  EXPECT_GT(arrived, 3u);
  EXPECT_EQ(marks, Closure(mesh, cellMarks).marks);
  EXPECT_LE(closure.looks(), (MarkClosure::maximumSweeps + sides) * mesh.cellCount());
}

/// A strip of triangles: the edges between them grow, so that a mark at its thin end runs through
/// all of it.
Mesh growingStrip(int cells)
{
  Mesh mesh;
  mesh.dimension = 2;
  for (int i = 0; i < cells + 2; ++i)
  {
    const double height = 1 + 1e-3 * i;
    mesh.points.push_back({ 1e-4 * i, i % 2 == 0 ? height : -height, 0 });
    mesh.ids.push_back(i);
  }
  for (int i = 0; i < cells; ++i)
  {
    mesh.triangles.push_back({ i, i + 1, i + 2 });
  }
  return mesh;
}

/// The number of looks at cells, and of marked edges, once a mark at the strip's thin end is
/// closed.
std::pair<std::size_t, std::ptrdiff_t> workOnStrip(const Mesh& strip)
{
  std::vector<unsigned char> cellMarks(strip.cellCount());
  std::transform(strip.triangles.begin(), strip.triangles.end(), cellMarks.begin(),
    [](const std::array<Index, 3>& cell)
    { return std::find(cell.begin(), cell.end(), 0) != cell.end(); });
  const EdgeTable table = buildEdgeTable(strip);
  EdgeMarks marks(table.edges.size(), 0);
  markLongestEdges(strip, table, cellMarks, true, marks);
  MarkClosure closure(table, 2, true, marks);
  EXPECT_TRUE(closure.closeAll());
  return { closure.looks(), std::count(marks.begin(), marks.end(), 1) };
}

TEST(LongestEdgeWork, isLinearWhateverTheOrderOfCells)
{
  const int cells = 2000;
  const Mesh strip = growingStrip(cells);
  for (const Mesh& mesh :
    { strip, withReversedCells(strip), cadtest::withShuffledCells(strip, 18) })
  {
    const auto [looks, marked] = workOnStrip(mesh);
    EXPECT_EQ(marked, cells);
    EXPECT_LE(looks, (MarkClosure::maximumSweeps + 3u) * cells);
  }
}

TEST_P(LongestEdge, closedMarksStayAsTheyAre)
{
  const Mesh mesh = this->mesh(13);
  Closure closure(mesh, someCells(mesh, 14));
  EXPECT_FALSE(MarkClosure(closure.table, mesh.dimension, true, closure.marks).closeAll());
}

/// Six rounds of refinement near a corner: the mesh stays whole and its cells do not degenerate.
TEST_P(LongestEdge, bisectionKeepsMeshesConforming)
{
  Mesh mesh = this->mesh(15);
  for (int round = 0; round < 6; ++round)
  {
    std::vector<unsigned char> cellMarks;
    for (const auto& cell : cellsOf(mesh))
    {
      cellMarks.push_back(norm(mesh.points[cell[0]]) < 0.3);
    }
    const Closure closure(mesh, cellMarks);
    const Midpoints midpoints = makeMidpoints(mesh, closure.table, closure.marks);
    std::vector<GlobalId> ids(midpoints.edges.size());
    std::iota(ids.begin(), ids.end(), static_cast<GlobalId>(mesh.points.size()));
    const std::size_t before = mesh.cellCount();
    mesh = splitMarked(mesh, closure.table, {}, closure.marks, midpoints, ids).mesh;
    EXPECT_GT(mesh.cellCount(), before);
    EXPECT_TRUE(cadtest::isValid(mesh));
    EXPECT_TRUE(cadtest::hasNoHangingVertex(mesh));
    EXPECT_NEAR(cadtest::measureOf(mesh), 1, 1e-13);
    EXPECT_TRUE(cadtest::isWatertight(mesh,
      [&](const std::vector<Point3>& side) { return cadtest::onUnitCube(side, mesh.dimension); }));
  }
}

} // namespace
