// Regular splitting: 4 triangles, 8 tetrahedra.

#include "MeshChecks.h"
#include "TestMeshes.h"

#include <cadrefine/mesh/Quality.h>
#include <cadrefine/refinement/Split.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace
{

using namespace cadrefine;

struct Uniform
{
  explicit Uniform(const Mesh& mesh) : table(buildEdgeTable(mesh))
  {
    const EdgeMarks marks(table.edges.size(), 1);
    const Midpoints midpoints = makeMidpoints(mesh, table, marks);
    std::vector<GlobalId> ids(midpoints.edges.size());
    std::iota(ids.begin(), ids.end(), static_cast<GlobalId>(mesh.points.size()));
    split = splitUniformly(mesh, table, {}, midpoints, ids);
  }

  EdgeTable table;
  SplitMesh split;
};

double volumeOf(const Mesh& mesh, std::size_t c)
{
  const auto& cell = mesh.tetrahedra[c];
  const auto& p = mesh.points;
  return sixfoldVolume(p[cell[0]], p[cell[1]], p[cell[2]], p[cell[3]]) / 6;
}

TEST(UniformSplit, cutsATetrahedronIntoEightOfEqualVolume)
{
  // Midpoints and volumes are exact in binary.
  const Mesh mesh =
    cadtest::oneTetrahedron({ { { 0, 0, 0 }, { 4, 0, 0 }, { 1, 8, 0 }, { 2, 1, 4 } } });
  const Mesh fine = Uniform(mesh).split.mesh;
  ASSERT_EQ(fine.tetrahedra.size(), 8u);
  EXPECT_EQ(fine.points.size(), 10u);
  for (std::size_t c = 0; c < 8; ++c)
  {
    EXPECT_EQ(volumeOf(fine, c), volumeOf(mesh, 0) / 8) << "child " << c;
  }
}

/// The tetrahedron is stretched so that each of the three diagonals in turn is the shortest.
class Diagonal : public testing::TestWithParam<int>
{
};

INSTANTIATE_TEST_SUITE_P(Each, Diagonal, testing::Values(0, 1, 2));

TEST_P(Diagonal, isTheShortestAndItsChildrenAreValid)
{
  std::array<Point3, 4> points{ { { 1, 1, 1 }, { 1, -1, -1 }, { -1, -1, 1 }, { -1, 1, -1 } } };
  for (Point3& point : points)
  {
    point[GetParam()] *= 0.5; // each diagonal of the regular one runs along an axis
  }
  const Mesh mesh = cadtest::oneTetrahedron(points);
  const Mesh fine = Uniform(mesh).split.mesh;
  EXPECT_TRUE(cadtest::isValid(fine));
  EXPECT_NEAR(cadtest::measureOf(fine), cadtest::measureOf(mesh), 1e-15);
  std::vector<int> axes;
  const EdgeTable table = buildEdgeTable(fine);
  for (const auto& [a, b] : table.edges)
  {
    const Vector3 along = fine.points[b] - fine.points[a];
    const Point3 middle = 0.5 * (fine.points[a] + fine.points[b]);
    if (norm(middle) == 0)
    {
      axes.push_back(along[0] != 0 ? 0 : along[1] != 0 ? 1 : 2);
    }
  }
  EXPECT_EQ(axes, std::vector<int>{ GetParam() });
}

TEST(UniformSplit, choosesAmongEqualDiagonalsByIds)
{
  const std::array<Point3, 4> points{ { { 1, 1, 1 }, { 1, -1, -1 }, { -1, -1, 1 },
    { -1, 1, -1 } } };
  const Mesh mesh = cadtest::oneTetrahedron(points);
  const auto inner = [](const Mesh& coarse)
  {
    const Mesh fine = Uniform(coarse).split.mesh;
    const EdgeTable table = buildEdgeTable(fine);
    for (const auto& [a, b] : table.edges)
    {
      if (norm(fine.points[a] + fine.points[b]) == 0)
      {
        return std::min(fine.ids[a], fine.ids[b]);
      }
    }
    return GlobalId{ -1 };
  };
  EXPECT_EQ(inner(mesh), 4) << "the diagonal with the smallest id at an end";
}

TEST(UniformSplit, cutsATriangleIntoFourOfEqualArea)
{
  const Mesh mesh = cadtest::oneTriangle({ { { 0, 0, 0 }, { 4, 0, 0 }, { 1, 8, 0 } } });
  const Mesh fine = Uniform(mesh).split.mesh;
  ASSERT_EQ(fine.triangles.size(), 4u);
  for (const auto& cell : fine.triangles)
  {
    EXPECT_EQ(
      twofoldAreaVector(fine.points[cell[0]], fine.points[cell[1]], fine.points[cell[2]])[2], 8);
  }
}

class UniformMesh : public testing::TestWithParam<int>
{
protected:
  Mesh mesh(std::uint64_t seed) const
  {
    return GetParam() == 3 ? cadtest::cubeMesh(3, 0.2, seed) : cadtest::squareMesh(5, 0.2, seed);
  }
};

INSTANTIATE_TEST_SUITE_P(Dimensions, UniformMesh, testing::Values(2, 3));

TEST_P(UniformMesh, staysValidWatertightAndOfTheSameVolumeOverThreeLevels)
{
  Mesh mesh = this->mesh(1);
  const std::size_t children = GetParam() == 3 ? 8 : 4;
  for (int level = 0; level < 3; ++level)
  {
    const SplitMesh split = Uniform(mesh).split;
    EXPECT_EQ(split.mesh.tetrahedra.size() + split.mesh.triangles.size(),
      children * (mesh.tetrahedra.size() + mesh.triangles.size()));
    mesh = split.mesh;
    EXPECT_TRUE(cadtest::isValid(mesh));
    EXPECT_TRUE(cadtest::hasNoHangingVertex(mesh));
    EXPECT_TRUE(cadtest::isWatertight(
      mesh, [](const std::vector<Point3>& side) { return cadtest::onUnitCube(side, GetParam()); }));
    EXPECT_NEAR(cadtest::measureOf(mesh), 1, 1e-12);
  }
}

TEST_P(UniformMesh, namesParents)
{
  const Mesh mesh = this->mesh(2);
  const Uniform uniform(mesh);
  const auto& split = uniform.split;
  const auto& firsts = split.firstChildren[GetParam()];
  ASSERT_EQ(firsts.size(), mesh.tetrahedra.size() + mesh.triangles.size() + 1);
  EXPECT_EQ(firsts.back(), static_cast<Index>(split.mesh.cellCount()));
  ASSERT_EQ(split.parentEdges.size() + mesh.points.size(), split.mesh.points.size());
  for (std::size_t n = 0; n < split.parentEdges.size(); ++n)
  {
    const auto [a, b] = split.parentEdges[n];
    EXPECT_LT(mesh.ids[a], mesh.ids[b]);
    EXPECT_EQ(split.mesh.points[mesh.points.size() + n], 0.5 * (mesh.points[a] + mesh.points[b]));
  }
}

TEST(UniformSplit, splitsTagCellsAlongTheirTetrahedra)
{
  Mesh mesh = cadtest::ballMesh(1, 0.02);
  mesh.triangles = cadtest::sphereMesh(1, 0.02).triangles;
  mesh.segments = { { mesh.triangles[0][0], mesh.triangles[0][1] } };
  mesh.vertices = { { 3 } };
  const Mesh fine = Uniform(mesh).split.mesh;
  EXPECT_EQ(fine.triangles.size(), 80u);
  EXPECT_EQ(fine.segments.size(), 2u);
  EXPECT_EQ(fine.vertices, mesh.vertices);
  // Every tag triangle is a side of the refined tetrahedra that is met once.
  EXPECT_EQ(cadtest::countOuterSides(fine), 80u);
  Mesh surface = fine;
  surface.dimension = 2;
  EXPECT_NEAR(cadtest::volumeInside(surface), cadtest::measureOf(mesh), 1e-14);
}

} // namespace
