// Bisection of cells with any set of marked edges.

#include "MeshChecks.h"
#include "TestMeshes.h"

#include <cadrefine/refinement/Split.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <bitset>
#include <numeric>
#include <random>

namespace
{

using namespace cadrefine;

SplitMesh split(const Mesh& mesh, const EdgeTable& table, const EdgeMarks& marks)
{
  const Midpoints midpoints = makeMidpoints(mesh, table, marks);
  std::vector<GlobalId> ids(midpoints.edges.size());
  std::iota(ids.begin(), ids.end(), GlobalId{ 1000 });
  return splitMarked(mesh, table, {}, marks, midpoints, ids);
}

EdgeMarks marksOf(unsigned long subset, std::size_t count)
{
  EdgeMarks marks(count);
  for (std::size_t e = 0; e < count; ++e)
  {
    marks[e] = (subset >> e) & 1;
  }
  return marks;
}

/// Two tetrahedra over and under a triangle in the plane z = 0; edges of random order: by length,
/// or (regular) all equal and ordered by random ids.
Mesh twoTetrahedra(std::uint64_t seed)
{
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> move(-0.2, 0.2);
  const double height = std::sqrt(2.0 / 3.0);
  const double side = std::sqrt(0.75);
  Mesh mesh = cadtest::oneTetrahedron(
    { { { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, side, 0 }, { 0.5, side / 3, height } } });
  mesh.points.push_back({ 0.5, side / 3, -height });
  mesh.tetrahedra.push_back({ 0, 2, 1, 4 });
  for (std::size_t v = 0; seed % 2 == 0 && v < 5; ++v)
  {
    mesh.points[v][0] += move(random);
    mesh.points[v][1] += move(random);
  }
  mesh.ids = { 0, 1, 2, 3, 4 };
  std::shuffle(mesh.ids.begin(), mesh.ids.end(), random);
  return mesh;
}

/// All sides that are met once lie away from the side that the two cells share.
bool notShared(const std::vector<Point3>& side)
{
  return std::any_of(side.begin(), side.end(), [](const Point3& p) { return p[2] != 0; });
}

TEST(Bisection, ofEverySubsetOfTheEdgesOfATetrahedronIsValid)
{
  for (std::uint64_t seed = 0; seed < 12; ++seed)
  {
    Mesh mesh = twoTetrahedra(seed);
    mesh.tetrahedra.pop_back();
    const EdgeTable table = buildEdgeTable(mesh);
    for (unsigned long subset = 0; subset < 64; ++subset)
    {
      const SplitMesh result = split(mesh, table, marksOf(subset, 6));
      EXPECT_TRUE(cadtest::isValid(result.mesh));
      EXPECT_TRUE(cadtest::hasNoHangingVertex(result.mesh));
      EXPECT_NEAR(cadtest::measureOf(result.mesh), cadtest::measureOf(mesh), 1e-15);
      EXPECT_EQ(result.parentEdges.size(), std::bitset<6>(subset).count());
      EXPECT_GT(result.mesh.tetrahedra.size(), std::bitset<6>(subset).count());
      EXPECT_EQ(result.firstChildren[3],
        (std::vector<Index>{ 0, static_cast<Index>(result.mesh.tetrahedra.size()) }));
    }
  }
}

TEST(Bisection, ofEverySubsetConformsWithEveryNeighbour)
{
  for (std::uint64_t seed = 0; seed < 8; ++seed)
  {
    const Mesh mesh = twoTetrahedra(seed);
    const EdgeTable table = buildEdgeTable(mesh);
    ASSERT_EQ(table.edges.size(), 9u);
    for (unsigned long subset = 0; subset < 512; ++subset)
    {
      const Mesh fine = split(mesh, table, marksOf(subset, 9)).mesh;
      ASSERT_TRUE(cadtest::isWatertight(fine, notShared)) << "marks " << std::bitset<9>(subset);
      ASSERT_TRUE(cadtest::hasNoHangingVertex(fine)) << "marks " << std::bitset<9>(subset);
    }
  }
}

TEST(Bisection, ofEverySubsetOfTheEdgesOfATriangleIsValid)
{
  for (std::uint64_t seed = 0; seed < 12; ++seed)
  {
    Mesh mesh = twoTetrahedra(seed);
    mesh.dimension = 2;
    mesh.tetrahedra.clear();
    mesh.triangles = { { 0, 1, 2 } };
    const EdgeTable table = buildEdgeTable(mesh);
    for (unsigned long subset = 0; subset < 8; ++subset)
    {
      const Mesh fine = split(mesh, table, marksOf(subset, 3)).mesh;
      EXPECT_EQ(fine.triangles.size(), 1 + std::bitset<3>(subset).count());
      EXPECT_TRUE(cadtest::isValid(fine));
      EXPECT_TRUE(cadtest::hasNoHangingVertex(fine));
      EXPECT_NEAR(cadtest::measureOf(fine), cadtest::measureOf(mesh), 1e-15);
    }
  }
}

/// A tag triangle must be cut as the side of the tetrahedron that it lies on.
TEST(Bisection, cutsTagTrianglesLikeSides)
{
  for (std::uint64_t seed = 0; seed < 8; ++seed)
  {
    Mesh mesh = twoTetrahedra(seed);
    mesh.triangles = { { 0, 1, 2 }, { 1, 4, 0 } };
    const EdgeTable table = buildEdgeTable(mesh);
    for (unsigned long subset = 0; subset < 512; ++subset)
    {
      const SplitMesh result = split(mesh, table, marksOf(subset, 9));
      std::set<std::set<Index>> sides;
      for (const auto& cell : result.mesh.tetrahedra)
      {
        for (const auto& face : tetrahedronFaces)
        {
          sides.insert({ cell[face[0]], cell[face[1]], cell[face[2]] });
        }
      }
      for (const auto& triangle : result.mesh.triangles)
      {
        ASSERT_EQ(sides.count({ triangle.begin(), triangle.end() }), 1u);
      }
    }
  }
}

TEST(Bisection, withoutMarksChangesNothing)
{
  const Mesh mesh = cadtest::cubeMesh(2, 0.2, 1);
  const EdgeTable table = buildEdgeTable(mesh);
  const SplitMesh result = split(mesh, table, EdgeMarks(table.edges.size(), 0));
  EXPECT_EQ(result.mesh.tetrahedra, mesh.tetrahedra);
  EXPECT_EQ(result.mesh.points, mesh.points);
}

} // namespace
