// The local operations one by one: what they make of a few cells, and what they leave alone.

#include "SpoiltCube.h"

#include <cadrefine/mesh/Quality.h>
#include <cadrefine/operations/Operations.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace
{

using namespace cadrefine;
using cadtest::volumeOf;

constexpr double pi = 3.14159265358979323846;

void addVertices(EditableMesh& mesh, const std::vector<Point3>& points)
{
  for (const Point3& point : points)
  {
    mesh.addVertex({ point, point, {}, false, false });
  }
}

void putOnRim(EditableMesh& mesh, const std::vector<Index>& vertices)
{
  for (const Index v : vertices)
  {
    EditableMesh::Vertex vertex = mesh.vertex(v);
    vertex.isOnRim = true;
    mesh.setVertex(v, vertex);
  }
}

std::size_t countCells(const EditableMesh& mesh)
{
  std::size_t count = 0;
  for (std::size_t c = 0; c < mesh.cells().size(); ++c)
  {
    count += mesh.cells().exists(static_cast<Index>(c));
  }
  return count;
}

bool areAllValid(const std::vector<LabelledSimplex<4>>& cells, const EditableMesh& mesh)
{
  return std::all_of(
    cells.begin(), cells.end(), [&](const auto& cell) { return mesh.isValid(cell.corners); });
}

/// The edge from (0, 0, -1) to (0, 0, 1), vertices 0 and 1, in a ring of others at a distance that
/// varies. With `open` the ring is a half circle, and its ends have facets.
EditableMesh ringMesh(int corners, bool open = false, double height = 1)
{
  EditableMesh mesh;
  std::vector<Point3> points{ { 0, 0, -height }, { 0, 0, height } };
  for (int k = 0; k < corners; ++k)
  {
    const double angle = open ? pi * k / (corners - 1) : 2 * pi * k / corners;
    const double radius = 1 + 0.2 * std::sin(2.0 + 3 * k);
    points.push_back(
      { radius * std::cos(angle), radius * std::sin(angle), 0.1 * std::cos(5.0 * k) });
  }
  addVertices(mesh, points);
  for (int k = 0; k < (open ? corners - 1 : corners); ++k)
  {
    const std::array<Index, 4> cell{ 0, 1, 2 + k, 2 + (k + 1) % corners };
    EXPECT_TRUE(mesh.isValid(cell));
    mesh.addCell({ cell, 0, k });
  }
  if (open)
  {
    mesh.addFacet({ { 0, 1, 2 }, 0, 0 });
    mesh.addFacet({ { 1, 0, 1 + corners }, 0, 1 });
  }
  return mesh;
}

/// The best worst cell over all triangulations of the ring's vertices from i to j: brute force.
double bestOf(const EditableMesh& mesh, Index i, Index j)
{
  double best =
    j - i < 2 ? std::numeric_limits<double>::infinity() : -std::numeric_limits<double>::infinity();
  for (Index k = i + 1; k < j; ++k)
  {
    double worst = std::min(bestOf(mesh, i, k), bestOf(mesh, k, j));
    for (const std::array<Index, 4>& cell :
      { std::array<Index, 4>{ i, k, j, 1 }, std::array<Index, 4>{ i, j, k, 0 } })
    {
      worst = mesh.isValid(cell) ? std::min(worst, mesh.quality(cell))
                                 : -std::numeric_limits<double>::infinity();
    }
    best = std::max(best, worst);
  }
  return best;
}

class Ring : public testing::TestWithParam<int>
{
};

TEST_P(Ring, edgeRemovalFindsTheBestTriangulation)
{
  const int corners = GetParam();
  EditableMesh mesh = ringMesh(corners);
  const double volume = volumeOf(mesh);
  Cavity cavity;
  ASSERT_TRUE(proposeEdgeRemoval(mesh, 0, 1, cavity));
  EXPECT_EQ(cavity.newCells.size(), 2 * (corners - 2U));
  ASSERT_TRUE(areAllValid(cavity.newCells, mesh));
  double worst = std::numeric_limits<double>::infinity();
  for (const auto& cell : cavity.newCells)
  {
    worst = std::min(worst, mesh.quality(cell.corners));
  }
  EXPECT_EQ(worst, bestOf(mesh, 2, 1 + corners));
  mesh.replace(cavity);
  EXPECT_NEAR(volumeOf(mesh), volume, 1e-14);
  EXPECT_TRUE(mesh.cells().at(0, 1).empty());
}

/// A long edge is the better for it, a short one has a worse cell.
TEST_P(Ring, edgeRemovalLeavesWorseCellsIfTold)
{
  for (const double height : { 0.3, 3.0 })
  {
    const EditableMesh mesh = ringMesh(GetParam(), false, height);
    Cavity any;
    Cavity noWorse;
    ASSERT_TRUE(proposeEdgeRemoval(mesh, 0, 1, any));
    ASSERT_EQ(proposeEdgeRemoval(mesh, 0, 1, noWorse, NewCells::NoWorse), height > 1) << height;
    for (std::size_t c = 0; height > 1 && c < any.newCells.size(); ++c)
    {
      EXPECT_EQ(noWorse.newCells.at(c).corners, any.newCells[c].corners);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Corners, Ring, testing::Range(3, 8));

TEST(EdgeRemoval, leavesLargeRingsAlone)
{
  Cavity cavity;
  EXPECT_FALSE(proposeEdgeRemoval(ringMesh(8), 0, 1, cavity));
}

void setOnRim(EditableMesh& mesh, Index end)
{
  EditableMesh::Vertex vertex = mesh.vertex(end);
  vertex.isOnRim = true;
  mesh.setVertex(end, vertex);
}

TEST(Rim, keepsEdgesThatMayHaveCellsBeyond)
{
  for (const bool open : { false, true })
  {
    EditableMesh mesh = ringMesh(5, open);
    const Index middle = mesh.addVertex({ {}, {}, {}, false, false });
    Cavity cavity;
    for (const Index end : { 0, 1 }) // one end alone does not matter
    {
      EXPECT_TRUE(proposeEdgeRemoval(mesh, 0, 1, cavity));
      EXPECT_TRUE(proposeSplit(mesh, 0, 1, middle, cavity));
      setOnRim(mesh, end);
    }
    EXPECT_FALSE(proposeEdgeRemoval(mesh, 0, 1, cavity));
    EXPECT_FALSE(proposeSplit(mesh, 0, 1, middle, cavity));
    for (const Index end : { 0, 1 })
    {
      EditableMesh::Vertex vertex = mesh.vertex(end);
      vertex.isBesideOthers = true;
      mesh.setVertex(end, vertex);
    }
    // All cells round an edge inside a closed ring are here.
    EXPECT_NE(proposeEdgeRemoval(mesh, 0, 1, cavity), open);
    EXPECT_NE(proposeSplit(mesh, 0, 1, middle, cavity), open);
  }
}

TEST(EdgeRemoval, leavesEdgesBetweenMaterialsAlone)
{
  Cavity cavity;
  EditableMesh materials = ringMesh(5);
  materials.replace({ { 0 }, {}, {}, { { { 0, 1, 2, 3 }, 1, 0 } }, {}, {} });
  EXPECT_FALSE(proposeEdgeRemoval(materials, 0, 1, cavity));
}

TEST(EdgeRemoval, swapsTheDiagonalOfTwoFacets)
{
  EditableMesh mesh = ringMesh(4, true);
  Cavity cavity;
  ASSERT_TRUE(proposeEdgeRemoval(mesh, 0, 1, cavity));
  ASSERT_EQ(cavity.newFacets.size(), 2U);
  for (const auto& facet : cavity.newFacets)
  {
    const auto& [a, b, c] = facet.corners;
    const Vector3 normal =
      twofoldAreaVector(mesh.vertex(a).point, mesh.vertex(b).point, mesh.vertex(c).point);
    EXPECT_LT(normal[1], 0); // as of the facets before: the half circle is at y > 0
  }
  mesh.closeFacets();
  EXPECT_GE(mesh.segmentOf(0, 2), 0);
  EXPECT_LT(mesh.segmentOf(0, 1), 0);
  EXPECT_TRUE(proposeEdgeRemoval(mesh, 0, 1, cavity));
  mesh.addSegment({ { 0, 1 }, 7, -1 });
  EXPECT_FALSE(proposeEdgeRemoval(mesh, 0, 1, cavity)); // a crease
}

TEST(EdgeRemoval, takesACellWithTwoFacetsAway)
{
  EditableMesh mesh;
  addVertices(mesh, { { 0, 0, 0 }, { 0, 0, 1 }, { 1, 0, 0.5 }, { 0.5, 1e-3, 0.5 } });
  const bool turns = mesh.isValid({ 0, 1, 2, 3 });
  mesh.addCell({ { 0, 1, turns ? 2 : 3, turns ? 3 : 2 }, 0, 0 });
  mesh.addFacet({ { 0, 1, 2 }, 0, -1 });
  mesh.addFacet({ { 0, 1, 3 }, 0, -1 });
  Cavity cavity;
  ASSERT_TRUE(proposeEdgeRemoval(mesh, 0, 1, cavity));
  EXPECT_TRUE(cavity.newCells.empty());
  EXPECT_EQ(cavity.newFacets.size(), 2U);
  // Beyond the mesh there may be facets at the new edge, which would make four.
  EditableMesh block = mesh;
  putOnRim(block, { 2, 3 });
  EXPECT_FALSE(proposeEdgeRemoval(block, 0, 1, cavity));
  // Another facet at the new edge would make three.
  mesh.addFacet({ { 2, 3, 0 }, 0, -1 });
  EXPECT_FALSE(proposeEdgeRemoval(mesh, 0, 1, cavity));
}

TEST(FaceRemoval, makesThreeCellsOfTwo)
{
  EditableMesh mesh;
  addVertices(
    mesh, { { 1, 0, 0 }, { -0.5, 0.8, 0 }, { -0.5, -0.8, 0 }, { 0, 0, 1 }, { 0, 0, -1 } });
  mesh.addCell({ { 0, 1, 2, 3 }, 0, 0 });
  mesh.addCell({ { 0, 2, 1, 4 }, 0, 1 });
  const double volume = volumeOf(mesh);
  Cavity cavity;
  ASSERT_TRUE(proposeFaceRemoval(mesh, 0, 3, cavity));
  ASSERT_TRUE(areAllValid(cavity.newCells, mesh));
  EXPECT_FALSE(proposeFaceRemoval(mesh, 0, 0, cavity)); // nothing beyond that face
  ASSERT_TRUE(proposeFaceRemoval(mesh, 1, 3, cavity));
  mesh.replace(cavity);
  EXPECT_EQ(countCells(mesh), 3U);
  EXPECT_NEAR(volumeOf(mesh), volume, 1e-15);

  EditableMesh listed;
  addVertices(
    listed, { { 1, 0, 0 }, { -0.5, 0.8, 0 }, { -0.5, -0.8, 0 }, { 0, 0, 1 }, { 0, 0, -1 } });
  listed.addCell({ { 0, 1, 2, 3 }, 0, 0 });
  listed.addCell({ { 0, 2, 1, 4 }, 0, 1 });
  listed.addFacet({ { 0, 1, 2 }, 0, 0 });
  EXPECT_FALSE(proposeFaceRemoval(listed, 0, 3, cavity));
}

/// A cube's mesh, its boundary in facets; the six sides have labels of their own.
EditableMesh cube(int n)
{
  const Mesh boxes = cadtest::cubeMesh(n, 0.1, 5);
  EditableMesh mesh;
  addVertices(mesh, boxes.points);
  for (std::size_t c = 0; c < boxes.tetrahedra.size(); ++c)
  {
    const auto& cell = boxes.tetrahedra[c];
    mesh.addCell({ cell, 0, static_cast<Index>(c) });
    for (const auto& face : tetrahedronFaces)
    {
      for (int k = 0; k < 6; ++k)
      {
        const auto isOnSide = [&](int corner)
        { return boxes.points[cell[corner]][k / 2] == static_cast<double>(k % 2); };
        if (std::all_of(std::begin(face), std::end(face), isOnSide))
        {
          mesh.addFacet({ { cell[face[0]], cell[face[1]], cell[face[2]] }, k, -1 });
        }
      }
    }
  }
  mesh.closeFacets();
  return mesh;
}

TEST(Collapse, keepsTheCube)
{
  const EditableMesh mesh = cube(3);
  std::array<int, 4> tried{};
  std::array<int, 4> possible{};
  for (std::size_t c = 0; c < mesh.cells().size(); ++c)
  {
    const auto& corners = mesh.cells()[static_cast<Index>(c)].corners;
    for (const auto& [i, j] : tetrahedronEdges)
    {
      const auto freedom = static_cast<std::size_t>(mesh.freedomOf(corners[i]));
      Cavity cavity;
      ++tried[freedom];
      if (proposeCollapse(mesh, corners[i], corners[j], cavity) &&
          areAllValid(cavity.newCells, mesh))
      {
        ++possible[freedom];
        EditableMesh collapsed = mesh;
        collapsed.replace(cavity);
        EXPECT_NEAR(volumeOf(collapsed), 1, 1e-14);
        EXPECT_TRUE(collapsed.cells().at(corners[i]).empty());
      }
    }
  }
  // The sides' vertices go along the sides, those of edges and corners of the cube (whose segments
  // are not listed) nowhere.
  EXPECT_EQ(possible[static_cast<std::size_t>(EditableMesh::Freedom::None)], 0);
  EXPECT_GT(tried[static_cast<std::size_t>(EditableMesh::Freedom::None)], 0);
  EXPECT_GT(possible[static_cast<std::size_t>(EditableMesh::Freedom::Facet)], 0);
  EXPECT_GT(possible[static_cast<std::size_t>(EditableMesh::Freedom::Space)], 0);
}

/// Edges 0 2 and 1 2 are on the boundary, the triangle between them is inside.
TEST(Collapse, doesNotPinchTheBoundary)
{
  EditableMesh mesh;
  addVertices(mesh, { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0.3, 0.3, 1 }, { 0.3, 0.3, -1 },
                      { -1, 0, 0.5 }, { 1, 1, -0.5 } });
  mesh.addCell({ { 0, 1, 2, 3 }, 0, 0 });
  mesh.addCell({ { 0, 2, 1, 4 }, 0, 1 });
  mesh.addCell({ { 0, 3, 2, 5 }, 0, 2 });
  mesh.addCell({ { 1, 2, 4, 6 }, 0, 3 });
  const std::vector<std::array<Index, 3>> facets{ { 0, 1, 3 }, { 1, 2, 3 }, { 0, 1, 4 },
    { 0, 2, 4 }, { 0, 2, 5 }, { 0, 3, 5 }, { 2, 3, 5 }, { 1, 2, 6 }, { 1, 4, 6 }, { 2, 4, 6 } };
  for (const auto& facet : facets)
  {
    mesh.addFacet({ facet, 0, -1 });
  }
  Cavity cavity;
  EXPECT_FALSE(proposeCollapse(mesh, 0, 1, cavity)); // four facets at the edge 1 2
}

/// The vertex 0 is in the middle of a side of a box, and goes to 1; an edge from 1 to 3 may be
/// beyond.
TEST(Collapse, leavesWhatMayPinchTheBoundaryBeyond)
{
  EditableMesh mesh;
  addVertices(
    mesh, { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { -1, 0, 0 }, { 0, -1, 0 }, { 0, 0, -1 } });
  for (Index k = 1; k < 5; ++k)
  {
    const Index next = k % 4 + 1;
    mesh.addCell({ { 0, next, k, 5 }, 0, k - 1 });
    mesh.addFacet({ { 0, k, next }, 0, -1 });
  }
  Cavity cavity;
  EXPECT_TRUE(proposeCollapse(mesh, 0, 1, cavity));
  putOnRim(mesh, { 1, 3 });
  EXPECT_FALSE(proposeCollapse(mesh, 0, 1, cavity));
  EXPECT_TRUE(proposeCollapse(mesh, 0, 2, cavity));
}

TEST(Split, keepsVolumeAndLabels)
{
  EditableMesh mesh = cube(2);
  const std::size_t cells = countCells(mesh);
  const auto corners = mesh.cells()[0].corners;
  const Index a = corners[0];
  const Index b = corners[1];
  const std::size_t around = mesh.cells().at(a, b).size();
  const std::size_t facets = mesh.facets().at(a, b).size();
  const Point3 middle = 0.5 * (mesh.vertex(a).point + mesh.vertex(b).point);
  const Index vertex = mesh.addVertex({ middle, middle, {}, false, false });
  Cavity cavity;
  ASSERT_TRUE(proposeSplit(mesh, a, b, vertex, cavity));
  EXPECT_EQ(cavity.newFacets.size(), 2 * facets);
  mesh.replace(cavity);
  EXPECT_EQ(countCells(mesh), cells + around);
  EXPECT_NEAR(volumeOf(mesh), 1, 1e-15);
}

} // namespace
