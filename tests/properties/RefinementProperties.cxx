// Refinement of random meshes with random marks.

#include "LeastMarking.h"
#include "MeshChecks.h"
#include "Rounds.h"
#include "TestMeshes.h"

#include <cadrefine/mesh/EdgeTable.h>
#include <cadrefine/mesh/Quality.h>
#include <cadrefine/refinement/LongestEdgeMarking.h>
#include <cadrefine/refinement/Split.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace propertytest
{

namespace
{

using namespace cadrefine;

/// A box of cells, some of them long and thin, with some sides (and edges) listed as tags. The box
/// reaches from the origin to `size`; inner vertices are moved.
struct RandomMesh
{
  explicit RandomMesh(Random& random)
  {
    const int dimension = random.among(2, 3);
    const double jitter = random.chance(0.2) ? 0 : random.between(0, 0.15);
    mesh = dimension == 3 ? cadtest::cubeMesh(random.among(1, 3), jitter, random.seed())
                          : cadtest::squareMesh(random.among(1, 8), jitter, random.seed());
    mesh = cadtest::withShuffledCells(mesh, random.seed());
    for (int k = 0; k < dimension; ++k)
    {
      size[k] = std::pow(10.0, random.between(-2, 2));
    }
    for (Point3& point : mesh.points)
    {
      for (int k = 0; k < 3; ++k)
      {
        point[k] *= size[k];
      }
    }
    addTags(random);
  }

  void addTags(Random& random)
  {
    for (const auto& cell : mesh.tetrahedra)
    {
      const auto& face = tetrahedronFaces[random.among(0, 3)];
      if (random.chance(0.2))
      {
        mesh.triangles.push_back({ cell[face[0]], cell[face[1]], cell[face[2]] });
      }
    }
    for (const auto& cell : mesh.triangles)
    {
      if (random.chance(0.2))
      {
        mesh.segments.push_back({ cell[0], cell[1] });
      }
    }
  }

  /// Whether these points lie on one side of the box.
  bool onBox(const std::vector<Point3>& points) const
  {
    for (int k = 0; k < mesh.dimension; ++k)
    {
      for (const double plane : { 0.0, size[k] })
      {
        if (std::all_of(
              points.begin(), points.end(), [&](const Point3& p) { return p[k] == plane; }))
        {
          return true;
        }
      }
    }
    return false;
  }

  Mesh mesh;
  Point3 size{ 1, 1, 1 };
};

std::vector<GlobalId> newIds(Random& random, const Mesh& mesh, const Midpoints& midpoints)
{
  std::vector<GlobalId> ids(midpoints.edges.size());
  std::iota(ids.begin(), ids.end(), *std::max_element(mesh.ids.begin(), mesh.ids.end()) + 1);
  std::shuffle(ids.begin(), ids.end(), random.engine());
  return ids;
}

/// The mesh once refined, and the edges that were cut.
struct Refined
{
  EdgeTable table;
  EdgeMarks marks;
  SplitMesh split;
};

std::vector<unsigned char> randomMarks(Random& random, const Mesh& mesh)
{
  const double part = std::pow(10.0, random.between(-2, 0));
  std::vector<unsigned char> marks(
    mesh.dimension == 3 ? mesh.tetrahedra.size() : mesh.triangles.size());
  std::generate(
    marks.begin(), marks.end(), [&] { return static_cast<unsigned char>(random.chance(part)); });
  return marks;
}

Refined bisect(Random& random, const Mesh& mesh, const std::vector<unsigned char>& cellMarks)
{
  Refined result;
  result.table = buildEdgeTable(mesh);
  result.marks.assign(result.table.edges.size(), 0);
  markLongestEdges(mesh, result.table, cellMarks, true, result.marks);
  MarkClosure(result.table, mesh.dimension, true, result.marks).closeAll();
  const Midpoints midpoints = makeMidpoints(mesh, result.table, result.marks);
  const auto ids = newIds(random, mesh, midpoints);
  result.split = splitMarked(mesh, result.table, {}, result.marks, midpoints, ids);
  return result;
}

Refined splitAll(Random& random, const Mesh& mesh)
{
  Refined result;
  result.table = buildEdgeTable(mesh);
  result.marks.assign(result.table.edges.size(), 1);
  const Midpoints midpoints = makeMidpoints(mesh, result.table, result.marks);
  const auto ids = newIds(random, mesh, midpoints);
  result.split = splitUniformly(mesh, result.table, {}, midpoints, ids);
  return result;
}

double measure(const Mesh& mesh, const std::array<Index, 4>& cell)
{
  const auto& p = mesh.points;
  return sixfoldVolume(p[cell[0]], p[cell[1]], p[cell[2]], p[cell[3]]) / 6;
}

double measure(const Mesh& mesh, const std::array<Index, 3>& cell)
{
  const auto& p = mesh.points;
  return norm(twofoldAreaVector(p[cell[0]], p[cell[1]], p[cell[2]])) / 2;
}

double measure(const Mesh& mesh, const std::array<Index, 2>& cell)
{
  return distance(mesh.points[cell[0]], mesh.points[cell[1]]);
}

/// Corners of children are corners of the parent, or the middles of its edges; and the children
/// fill it.
template<std::size_t Corners>
void expectNested(const Mesh& coarse, const Cells<Corners>& parents, const SplitMesh& split,
  const Cells<Corners>& children, double unit)
{
  const std::vector<Index>& first = split.firstChildren[Corners - 1];
  ASSERT_EQ(first.size(), parents.size() + 1);
  ASSERT_EQ(static_cast<std::size_t>(first.back()), children.size());
  const auto old = static_cast<Index>(coarse.points.size());
  for (std::size_t c = 0; c < parents.size(); ++c)
  {
    const auto isCorner = [&](Index v)
    { return std::find(parents[c].begin(), parents[c].end(), v) != parents[c].end(); };
    double sum = 0;
    for (Index child = first[c]; child < first[c + 1]; ++child)
    {
      sum += measure(split.mesh, children[child]);
      for (const Index v : children[child])
      {
        const bool within = v < old ? isCorner(v)
                                    : isCorner(split.parentEdges[v - old][0]) &&
                                        isCorner(split.parentEdges[v - old][1]);
        EXPECT_TRUE(within) << "cell " << c;
      }
    }
    EXPECT_NEAR(sum, measure(coarse, parents[c]), 1e-13 * unit) << "cell " << c;
  }
}

template<std::size_t Corners>
void addSides(const Cells<Corners>& cells, std::set<std::set<Index>>& sides)
{
  for (const auto& cell : cells)
  {
    for (const Index left : cell)
    {
      std::set<Index> side(cell.begin(), cell.end());
      side.erase(left);
      sides.insert(side);
    }
  }
}

/// Tags lie on sides of cells.
void expectTagsOnSides(const Mesh& mesh)
{
  std::set<std::set<Index>> sides;
  addSides(mesh.tetrahedra, sides);
  addSides(mesh.triangles, sides);
  for (const auto& triangle : mesh.triangles)
  {
    EXPECT_TRUE(mesh.dimension == 2 || sides.count({ triangle.begin(), triangle.end() }));
  }
  for (const auto& segment : mesh.segments)
  {
    EXPECT_TRUE(sides.count({ segment.begin(), segment.end() }));
  }
}

/// No edge that was cut is left.
void expectCutEdgesGone(const SplitMesh& split)
{
  const EdgeTable fine = buildEdgeTable(split.mesh);
  for (const auto& ends : split.parentEdges)
  {
    EXPECT_EQ(fine.find(ends[0], ends[1]), -1);
  }
}

void expectSound(const RandomMesh& box, const Mesh& coarse, const SplitMesh& split)
{
  const Mesh& fine = split.mesh;
  EXPECT_TRUE(cadtest::isValid(fine));
  EXPECT_TRUE(
    cadtest::isWatertight(fine, [&](const std::vector<Point3>& side) { return box.onBox(side); }));
  EXPECT_TRUE(cadtest::hasNoHangingVertex(fine));
  expectCutEdgesGone(split);
  expectTagsOnSides(fine);
  const double longest = *std::max_element(box.size.begin(), box.size.end());
  const double whole = box.size[0] * box.size[1] * box.size[2];
  EXPECT_NEAR(cadtest::measureOf(fine), whole, 1e-12 * whole);
  expectNested(coarse, coarse.tetrahedra, split, fine.tetrahedra, whole);
  expectNested(coarse, coarse.triangles, split, fine.triangles, longest * longest);
  expectNested(coarse, coarse.segments, split, fine.segments, longest);
}

std::set<cadtest::IdPair> markedIds(const Mesh& mesh, const Refined& refined)
{
  std::set<cadtest::IdPair> ids;
  for (std::size_t e = 0; e < refined.marks.size(); ++e)
  {
    if (refined.marks[e])
    {
      ids.insert({ mesh.ids[refined.table.edges[e][0]], mesh.ids[refined.table.edges[e][1]] });
    }
  }
  return ids;
}

constexpr std::size_t mostCells = 3000;

TEST(RefinementProperty, longestEdgeBisectionIsConformingNestedAndLeast)
{
  forEachSeed(40,
    [](Random& random)
    {
      const RandomMesh box(random);
      Mesh mesh = box.mesh;
      const int levels = random.among(1, 5);
      for (int level = 0; level < levels && mesh.cellCount() < mostCells; ++level)
      {
        SCOPED_TRACE("level " + std::to_string(level));
        auto cellMarks = randomMarks(random, mesh);
        const Refined refined = bisect(random, mesh, cellMarks);
        expectSound(box, mesh, refined.split);
        for (std::size_t c = 0; c < cellMarks.size(); ++c)
        {
          const auto& first = refined.split.firstChildren[mesh.dimension];
          EXPECT_TRUE(!cellMarks[c] || first[c + 1] - first[c] > 1) << "marked cell " << c;
        }
        cellMarks.resize(cadtest::cellsOf(mesh).size()); // tags are not marked
        EXPECT_EQ(markedIds(mesh, refined), cadtest::leastMarking(mesh, cellMarks));
        mesh = refined.split.mesh;
      }
    });
}

TEST(RefinementProperty, uniformSplittingIsConformingAndNested)
{
  forEachSeed(20,
    [](Random& random)
    {
      const RandomMesh box(random);
      Mesh mesh = box.mesh;
      for (int level = 0; level < 2 && mesh.cellCount() < mostCells / 8; ++level)
      {
        const Refined refined = splitAll(random, mesh);
        expectSound(box, mesh, refined.split);
        const Mesh& fine = refined.split.mesh;
        EXPECT_EQ(fine.tetrahedra.size(), 8 * mesh.tetrahedra.size());
        EXPECT_EQ(fine.triangles.size(), 4 * mesh.triangles.size());
        EXPECT_EQ(fine.segments.size(), 2 * mesh.segments.size());
        mesh = fine;
      }
    });
}

/// Powers of two scale without rounding.
TEST(RefinementProperty, scalesWithPowersOfTwo)
{
  forEachSeed(40,
    [](Random& random)
    {
      Mesh mesh = RandomMesh(random).mesh;
      const double factor = std::ldexp(1.0, random.among(-100, 100));
      const auto scaledPoints = [factor](std::vector<Point3> points)
      {
        for (Point3& point : points)
        {
          point = factor * point;
        }
        return points;
      };
      const int levels = random.among(1, 4);
      for (int level = 0; level < levels && mesh.cellCount() < mostCells; ++level)
      {
        const bool isUniform = random.chance(0.2);
        const auto cellMarks = randomMarks(random, mesh);
        Mesh scaledMesh = mesh;
        scaledMesh.points = scaledPoints(mesh.points);
        Random same = random;
        const auto refine = [&](Random& each, const Mesh& of)
        { return (isUniform ? splitAll(each, of) : bisect(each, of, cellMarks)).split.mesh; };
        mesh = refine(random, mesh);
        const Mesh other = refine(same, scaledMesh);
        EXPECT_EQ(other.tetrahedra, mesh.tetrahedra);
        EXPECT_EQ(other.triangles, mesh.triangles);
        EXPECT_EQ(other.segments, mesh.segments);
        EXPECT_EQ(other.ids, mesh.ids);
        EXPECT_EQ(other.points, scaledPoints(mesh.points));
      }
    });
}

} // namespace

} // namespace propertytest
