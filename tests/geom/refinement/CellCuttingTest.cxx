// Hexahedra, wedges, pyramids and quadrilaterals cut at any of their edges: parts that fill them,
// and neighbours that agree.

#include "MeshChecks.h"

#include <cadrefine/mesh/CellState.h>
#include <cadrefine/mesh/Facets.h>
#include <cadrefine/mesh/Quality.h>
#include <cadrefine/refinement/CellCutting.h>
#include <cadrefine/refinement/Split.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <random>
#include <set>

namespace
{

using namespace cadrefine;

/// Corners as each shape's own functions map them.
std::vector<Point3> unitCorners(shapes::Hexahedron)
{
  return { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 },
    { 1, 1, 1 }, { 0, 1, 1 } };
}

std::vector<Point3> unitCorners(shapes::Wedge)
{
  return { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 }, { 0, 1, 1 } };
}

std::vector<Point3> unitCorners(shapes::Pyramid)
{
  return { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0.4, 0.6, 1 } };
}

std::vector<Point3> unitCorners(shapes::Quadrilateral)
{
  return { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } };
}

template<class Shape>
Mesh oneCell(Shape shape, const std::function<Point3(const Point3&)>& place)
{
  Mesh mesh;
  mesh.dimension = Shape::dimension;
  auto& cell = (mesh.*Shape::cells).emplace_back();
  for (const Point3& corner : unitCorners(shape))
  {
    mesh.points.push_back(place(corner));
  }
  std::iota(cell.begin(), cell.end(), 0);
  mesh.ids.assign(cell.begin(), cell.end());
  return mesh;
}

/// Where a cell of size 1 may lie; its sides stay planar but for the last one.
struct Placing
{
  const char* name;
  std::function<Point3(const Point3&)> place;
  bool isPlanar = true;
};

std::vector<Placing> placings(bool inThePlane)
{
  const double height = inThePlane ? 0 : 1;
  return { { "unit", [](const Point3& p) { return p; } },
    { "affine",
      [=](const Point3& p)
      {
        return Point3{ 2 * p[0] + 0.3 * p[1] + 0.1, 0.5 * p[1] + 0.2 * p[2] - 0.1 * p[0],
          height * 1.7 * p[2] };
      } },
    { "projective", // takes planes to planes
      [=](const Point3& p)
      {
        const double scale = 1 / (1 + 0.5 * p[0] + 0.3 * p[1] + 0.4 * p[2]);
        return Point3{ scale * (p[0] + 0.2 * p[1]), scale * p[1],
          height * scale * (p[2] + 0.1 * p[0]) };
      } },
    { "thin",
      [](const Point3& p) {
        return Point3{ p[0], 0.8 * p[1], 1e-4 * p[2] };
      } },
    { "perturbed",
      [=](const Point3& p)
      {
        const auto off = [&](double seed)
        { return 0.12 * std::sin(seed + 17 * p[0] + 31 * p[1] + 53 * p[2]); };
        return p + Vector3{ off(1), off(2), height * off(3) };
      },
      inThePlane } };
}

/// The mesh cut at some of its edges.
struct Cut
{
  /// `marks` by the cell's own edges.
  template<class Shape>
  Cut(Shape shape, const Mesh& mesh, unsigned subset)
    : table(buildEdgeTable(mesh)), quads(buildQuadTable(table)), marks(table.edges.size(), 0)
  {
    const auto& edges = (table.*edgesOfCells(shape))[0];
    for (std::size_t e = 0; e < edges.size(); ++e)
    {
      marks[edges[e]] = subset >> e & 1;
    }
    const EdgeMarks before = marks;
    MarkClosure(table, mesh.dimension, false, marks).closeAll();
    isClosed = before == marks;
  }

  Cut(const Mesh& mesh, const EdgeMarks& edgeMarks)
    : table(buildEdgeTable(mesh)), quads(buildQuadTable(table)), marks(edgeMarks)
  {
    MarkClosure(table, mesh.dimension, false, marks).closeAll();
  }

  SplitMesh split(const Mesh& mesh)
  {
    midpoints = makeMidpoints(mesh, table, quads, marks, false);
    std::vector<GlobalId> ids(midpoints.parentEdges.size());
    std::iota(ids.begin(), ids.end(), static_cast<GlobalId>(mesh.points.size()));
    return splitMarked(mesh, table, quads, marks, midpoints, ids);
  }

  EdgeTable table;
  QuadTable quads;
  EdgeMarks marks;
  bool isClosed = true;
  Midpoints midpoints;
};

using Corners = std::set<Index>;

/// Of each vertex the corners of the mesh that was cut that it lies between.
std::vector<Corners> cornersOfVertices(
  const Mesh& mesh, const Midpoints& midpoints, const SplitMesh& split)
{
  std::vector<Corners> result;
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
  {
    result.push_back({ static_cast<Index>(v) });
  }
  for (const auto& [a, b] : split.parentEdges)
  {
    Corners corners = result[a];
    corners.insert(result[b].begin(), result[b].end());
    result.push_back(corners);
  }
  auto vertex = static_cast<std::size_t>(midpoints.nextVertex()) - midpoints.cells.size();
  for (const Index cell : midpoints.cells)
  {
    Index number = 0;
    visitOwnShapes(mesh,
      [&](auto, const auto& cells)
      {
        for (const auto& corners : cells)
        {
          if (number++ == cell)
          {
            result[vertex] = Corners(corners.begin(), corners.end());
          }
        }
      });
    ++vertex;
  }
  return result;
}

std::vector<Corners> sidesOfMesh(const Mesh& mesh)
{
  std::vector<Corners> sides;
  forEachSide(mesh, [&](const Facet& side) { sides.emplace_back(side.begin(), side.end()); });
  return sides;
}

/// The sides of the parts: met twice, or once in a side of the mesh that is met once; those in a
/// side of two cells are met twice.
testing::AssertionResult isConforming(
  const Mesh& mesh, const Midpoints& midpoints, const SplitMesh& split)
{
  const auto cornersOf = cornersOfVertices(mesh, midpoints, split);
  std::map<Corners, int> coarse;
  for (const Corners& side : sidesOfMesh(mesh))
  {
    ++coarse[side];
  }
  std::map<Corners, int> fine;
  for (const Corners& side : sidesOfMesh(split.mesh))
  {
    ++fine[side];
  }
  for (const auto& [side, count] : fine)
  {
    Corners between;
    for (const Index v : side)
    {
      between.insert(cornersOf[v].begin(), cornersOf[v].end());
    }
    const auto parent = std::find_if(coarse.begin(), coarse.end(),
      [&](const auto& entry) {
        return std::includes(
          entry.first.begin(), entry.first.end(), between.begin(), between.end());
      });
    const int expected = parent == coarse.end() ? 2 : parent->second;
    if (count != expected)
    {
      return testing::AssertionFailure()
             << "a side between vertices " << testing::PrintToString(between) << " is met " << count
             << " times, not " << expected;
    }
  }
  return testing::AssertionSuccess();
}

/// Of the sides that are met once.
double outerMeasure(const Mesh& mesh)
{
  double sum = 0;
  for (const Facet& side : findOuterFacets(mesh))
  {
    std::array<Point3, 4> p{};
    std::transform(
      side.begin(), side.end(), p.begin(), [&](Index vertex) { return mesh.points[vertex]; });
    sum +=
      side.corners() == 2 ? distance(p[0], p[1]) : 0.5 * norm(twofoldAreaVector(p, side.corners()));
  }
  return sum;
}

/// The children that firstChildren and children name are all there are, each once.
void expectChildrenNumbered(const SplitMesh& split, int dimension)
{
  const auto& firsts = split.firstChildren[dimension];
  EXPECT_EQ(static_cast<std::size_t>(firsts.back()), split.mesh.cellCount(dimension));
  std::vector<Index> numbers = split.children[dimension];
  std::sort(numbers.begin(), numbers.end());
  std::vector<Index> all(split.mesh.cellCount(dimension));
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(numbers, all);
}

template<class Shape>
class CellCuttingOf : public testing::Test
{
};

using OtherShapes =
  testing::Types<shapes::Hexahedron, shapes::Wedge, shapes::Pyramid, shapes::Quadrilateral>;
TYPED_TEST_SUITE(CellCuttingOf, OtherShapes, );

TYPED_TEST(CellCuttingOf, partsFillTheCellWhateverEdgesAreMarked)
{
  constexpr TypeParam shape;
  constexpr unsigned subsets = 1u << std::size(TypeParam::edges);
  for (const Placing& placing : placings(TypeParam::dimension == 2))
  {
    SCOPED_TRACE(placing.name);
    const Mesh mesh = oneCell(shape, placing.place);
    ASSERT_TRUE(cadtest::isValid(mesh));
    const double volume = cadtest::measureOf(mesh);
    const double surface = outerMeasure(mesh);
    int tried = 0;
    int bad = 0;
    for (unsigned subset = 0; subset < subsets; ++subset)
    {
      Cut cut(shape, mesh, subset);
      if (!cut.isClosed)
      {
        continue;
      }
      ++tried;
      SCOPED_TRACE("edges " + std::to_string(subset));
      const SplitMesh split = cut.split(mesh);
      ASSERT_TRUE(isConforming(mesh, cut.midpoints, split));
      expectChildrenNumbered(split, TypeParam::dimension);
      const auto badly = cellsCutBadly(mesh, cut.table, cut.quads, cut.marks, false);
      const bool isValid = bool(cadtest::isValid(split.mesh));
      EXPECT_EQ(isValid, badly.empty());
      bad += !isValid;
      if (placing.isPlanar)
      {
        EXPECT_TRUE(cadtest::isValid(split.mesh));
        EXPECT_NEAR(cadtest::measureOf(split.mesh), volume, 1e-13 * volume);
        EXPECT_NEAR(outerMeasure(split.mesh), surface, 1e-13 * surface);
      }
      if (subset == subsets - 1 && TypeParam::corners == shapes::Hexahedron::corners)
      {
        EXPECT_EQ(split.mesh.hexahedra.size(), 8u);
      }
    }
    EXPECT_GE(tried, 16);
    EXPECT_LT(bad, tried / 10);
    this->RecordProperty(std::string("bad_") + placing.name, bad);
  }
}

/// Its tangent planes rise over the mean of the corners.
TEST(CellCutting, aPyramidOnAWarpedBaseIsCutIntoValidCells)
{
  Mesh mesh;
  mesh.points = { { 0, 0, 0.3 }, { 1, 0, -0.3 }, { 1, 1, 0.3 }, { 0, 1, -0.3 }, { 0.5, 0.5, 1 } };
  mesh.ids = { 0, 1, 2, 3, 4 };
  mesh.pyramids = { { 0, 1, 2, 3, 4 } };
  ASSERT_TRUE(cadtest::isValid(mesh));
  Cut cut(mesh, EdgeMarks(8, 1));
  const SplitMesh split = cut.split(mesh);
  EXPECT_TRUE(cadtest::isValid(split.mesh));
  EXPECT_NEAR(cadtest::measureOf(split.mesh), cadtest::measureOf(mesh), 1e-15);
}

/// Valid pyramids of any shape, many with a base that is far from flat.
TEST(CellCutting, everyValidPyramidIsCutIntoValidCells)
{
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> place(0, 1);
  for (int tried = 0; tried < 300;)
  {
    const Mesh mesh = oneCell(shapes::Pyramid{},
      [&](const Point3&) {
        return Point3{ place(random), place(random), place(random) };
      });
    const unsigned subsets = cadtest::isValid(mesh) ? 256 : 0;
    tried += subsets > 0;
    for (unsigned subset = 0; subset < subsets; ++subset)
    {
      const Cut cut(shapes::Pyramid{}, mesh, subset);
      EXPECT_TRUE(
        !cut.isClosed || cellsCutBadly(mesh, cut.table, cut.quads, cut.marks, false).empty());
    }
  }
}

/// Two cells that share a side, corner k of the one's at corner (turn - k) of the other's; points
/// and ids are at random, since neither validity nor size counts here.
template<class First, class Second>
Mesh glued(First, Second, int side, int otherSide, int turn, std::mt19937_64& random)
{
  Mesh mesh;
  auto& first = (mesh.*First::cells).emplace_back();
  std::iota(first.begin(), first.end(), 0);
  std::array<Index, Second::corners> second;
  second.fill(-1);
  const auto& corners = First::faces[side];
  const auto& others = Second::faces[otherSide];
  const int count = corners[3] < 0 ? 3 : 4;
  for (int k = 0; k < count; ++k)
  {
    second[others[(turn + count - k) % count]] = first[corners[k]];
  }
  auto next = static_cast<Index>(First::corners);
  for (Index& corner : second)
  {
    corner = corner < 0 ? next++ : corner;
  }
  (mesh.*Second::cells).push_back(second);
  std::uniform_real_distribution<double> any(0, 1);
  for (Index v = 0; v < next; ++v)
  {
    mesh.points.push_back({ any(random), any(random), any(random) });
    mesh.ids.push_back(v);
  }
  std::shuffle(mesh.ids.begin(), mesh.ids.end(), random);
  return mesh;
}

/// For each way to mark the edges of the common side, with some others.
void expectNeighboursAgree(const Mesh& mesh, const Corners& side, std::mt19937_64& random)
{
  const EdgeTable table = buildEdgeTable(mesh);
  std::vector<Index> common;
  for (std::size_t e = 0; e < table.edges.size(); ++e)
  {
    if (side.count(table.edges[e][0]) && side.count(table.edges[e][1]))
    {
      common.push_back(static_cast<Index>(e));
    }
  }
  ASSERT_EQ(common.size(), side.size());
  for (unsigned subset = 0; subset < 1u << common.size(); ++subset)
  {
    EdgeMarks marks(table.edges.size(), 0);
    const auto others = random() % 3; // none, half of them, all
    for (unsigned char& mark : marks)
    {
      mark = others == 2 || (others == 1 && random() % 2);
    }
    for (std::size_t k = 0; k < common.size(); ++k)
    {
      marks[common[k]] = subset >> k & 1;
    }
    Cut cut(mesh, marks);
    const SplitMesh split = cut.split(mesh);
    ASSERT_TRUE(isConforming(mesh, cut.midpoints, split)) << "edges " << subset;
  }
}

TEST(CellCutting, neighboursAgreeOnTheSideThatTheyShare)
{
  std::mt19937_64 random(3);
  int pairs = 0;
  const auto tryPair = [&](auto first, auto second)
  {
    for (int i = 0; i < static_cast<int>(std::size(first.faces)); ++i)
    {
      for (int k = 0; k < static_cast<int>(std::size(second.faces)); ++k)
      {
        const int count = first.faces[i][3] < 0 ? 3 : 4;
        const int other = second.faces[k][3] < 0 ? 3 : 4;
        for (int turn = 0; count == other && turn < count; ++turn)
        {
          SCOPED_TRACE("corners " + std::to_string(first.corners) + " and " +
                       std::to_string(second.corners) + ", sides " + std::to_string(i) + " and " +
                       std::to_string(k) + ", turn " + std::to_string(turn));
          const Mesh mesh = glued(first, second, i, k, turn, random);
          const auto& corners = first.faces[i];
          expectNeighboursAgree(mesh, Corners(corners, corners + count), random);
          ++pairs;
        }
      }
    }
  };
  const auto tryWith = [&](auto first)
  {
    tryPair(first, shapes::Tetrahedron{});
    tryPair(first, shapes::Pyramid{});
    tryPair(first, shapes::Wedge{});
    tryPair(first, shapes::Hexahedron{});
  };
  tryWith(shapes::Pyramid{});
  tryWith(shapes::Wedge{});
  tryWith(shapes::Hexahedron{});
  EXPECT_EQ(pairs, 4 * 10 * 10 + 3 * 6 * 10);
}

/// Cells of area listed on a side are cut as it is.
TEST(CellCutting, listedSidesAreCutAsTheirCells)
{
  std::mt19937_64 random(5);
  for (int round = 0; round < 300; ++round)
  {
    Mesh mesh =
      glued(shapes::Wedge{}, shapes::Hexahedron{}, 2 + round % 3, round % 6, round % 4, random);
    for (const Facet& side : findOuterFacets(mesh))
    {
      auto v = side.vertices;
      const auto corners = v.begin() + side.corners();
      std::rotate(v.begin(), v.begin() + static_cast<int>(random() % 3), corners);
      if (random() % 2)
      {
        std::reverse(v.begin(), corners);
      }
      side.corners() == 3 ? mesh.triangles.push_back({ v[0], v[1], v[2] })
                          : mesh.quadrilaterals.push_back(v);
    }
    const EdgeTable table = buildEdgeTable(mesh);
    EdgeMarks marks(table.edges.size(), 0);
    for (unsigned char& mark : marks)
    {
      mark = random() % 2;
    }
    Cut cut(mesh, marks);
    const SplitMesh split = cut.split(mesh);
    std::set<Corners> outer;
    for (const Facet& side : findOuterFacets(split.mesh))
    {
      outer.emplace(side.begin(), side.end());
    }
    std::set<Corners> listed;
    visitShapes(split.mesh, 2,
      [&](auto, const auto& cells)
      {
        for (const auto& cell : cells)
        {
          listed.emplace(cell.begin(), cell.end());
        }
      });
    EXPECT_EQ(listed, outer);
    expectChildrenNumbered(split, 2);
    expectChildrenNumbered(split, 3);
  }
}

} // namespace
