#include "MeshChecks.h"
#include "TestMeshes.h"

#include <cadrefine/mesh/Facets.h>
#include <cadrefine/mesh/Quality.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace
{

using namespace cadrefine;

std::set<std::array<GlobalId, 3>> idsOf(const Mesh& mesh, const std::vector<Facet>& facets)
{
  std::set<std::array<GlobalId, 3>> result;
  for (const Facet& facet : facets)
  {
    std::array<GlobalId, 3> ids{ -1, -1, -1 };
    for (int k = 0; k < 3 && facet.vertices[k] >= 0; ++k)
    {
      ids[k] = mesh.ids[facet.vertices[k]];
    }
    std::sort(ids.begin(), ids.end());
    result.insert(ids);
  }
  return result;
}

TEST(Facets, encloseTheVolumeWithOutwardNormals)
{
  const Mesh mesh = cadtest::cubeMesh(3, 0.2, 1);
  Mesh surface;
  surface.dimension = 2;
  surface.points = mesh.points;
  for (const Facet& facet : findOuterFacets(mesh))
  {
    surface.triangles.push_back({ facet.vertices[0], facet.vertices[1], facet.vertices[2] });
  }
  EXPECT_EQ(surface.triangles.size(), 6u * 2 * 9);
  EXPECT_NEAR(cadtest::volumeInside(surface), 1, 1e-14);
}

TEST(Facets, nameTheirCell)
{
  const Mesh mesh = cadtest::ballMesh(2, 0.05);
  const std::vector<Facet> facets = findOuterFacets(mesh);
  ASSERT_EQ(facets.size(), 20u);
  for (const Facet& facet : facets)
  {
    const auto& cell = mesh.tetrahedra.at(facet.cell);
    for (const Index vertex : facet)
    {
      EXPECT_NE(std::find(cell.begin(), cell.end(), vertex), cell.end());
      EXPECT_NE(vertex, 12) << "the centre is not on the boundary";
    }
  }
}

TEST(Facets, ofAPlanarMeshRunRoundItCounterClockwise)
{
  const Mesh mesh = cadtest::squareMesh(4, 0.2, 2);
  double area = 0;
  const std::vector<Facet> facets = findOuterFacets(mesh);
  for (const Facet& facet : facets)
  {
    EXPECT_EQ(facet.vertices[2], -1);
    area += cross(mesh.points[facet.vertices[0]], mesh.points[facet.vertices[1]])[2] / 2;
  }
  EXPECT_EQ(facets.size(), 16u);
  EXPECT_NEAR(area, 1, 1e-14);
}

TEST(Facets, areTheSameWhateverTheOrderOfTheCells)
{
  const Mesh mesh = cadtest::cubeMesh(2, 0.2, 3);
  const Mesh shuffled = cadtest::withShuffledCells(mesh, 4);
  EXPECT_EQ(idsOf(mesh, findOuterFacets(mesh)), idsOf(shuffled, findOuterFacets(shuffled)));
}

TEST(Facets, areFoundAmongVerticesThatMayBeOnTheBoundary)
{
  for (const Mesh& mesh : { cadtest::cubeMesh(3, 0.2, 3), cadtest::squareMesh(4, 0.2, 2) })
  {
    const auto facets = findOuterFacets(mesh);
    std::vector<unsigned char> onBoundary(mesh.points.size(), 0);
    for (const Facet& facet : facets)
    {
      for (const Index vertex : facet)
      {
        if (vertex >= 0)
        {
          onBoundary[vertex] = 1;
        }
      }
    }
    ASSERT_LT(std::count(onBoundary.begin(), onBoundary.end(), 1), mesh.points.size());
    EXPECT_EQ(idsOf(mesh, findOuterFacets(mesh, onBoundary)), idsOf(mesh, facets));
    onBoundary[facets[0].vertices[0]] = 0; // Its facets are not looked at.
    EXPECT_LT(findOuterFacets(mesh, onBoundary).size(), facets.size());
  }
}

TEST(Facets, doNotTakeTagTrianglesForSides)
{
  Mesh mesh = cadtest::ballMesh(1, 0);
  mesh.triangles = { { 0, 1, 2 } };
  EXPECT_EQ(findOuterFacets(mesh).size(), 20u);
}

TEST(Facets, ofASurfaceAreItsTriangles)
{
  const Mesh mesh = cadtest::sphereMesh(1, 0);
  const std::vector<Facet> facets = facetsOfSurface(mesh);
  ASSERT_EQ(facets.size(), 20u);
  for (std::size_t f = 0; f < facets.size(); ++f)
  {
    EXPECT_TRUE(std::equal(facets[f].begin(), facets[f].end(), mesh.triangles[f].begin()));
    EXPECT_EQ(facets[f].cell, static_cast<Index>(f));
  }
}

TEST(FaceTables, agreeWithTheEdgeTable)
{
  for (int face = 0; face < 4; ++face)
  {
    for (int k = 0; k < 3; ++k)
    {
      const std::set<int> corners{ tetrahedronFaces[face][k], tetrahedronFaces[face][(k + 1) % 3] };
      const auto& edge = tetrahedronEdges[tetrahedronFaceEdges[face][k]];
      EXPECT_EQ(corners, std::set<int>({ edge[0], edge[1] }));
      EXPECT_EQ(corners.count(face), 0u);
    }
  }
}

} // namespace
