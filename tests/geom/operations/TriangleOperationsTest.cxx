// The local operations on triangles in the plane and in space, one by one.

#include "TestMeshes.h"

#include <cadrefine/mesh/Quality.h>
#include <cadrefine/operations/Operations.h>
#include <cadrefine/operations/SplitSwaps.h>
#include <cadrefine/operations/TriangleOperations.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace
{

using namespace cadrefine;
using Kind = EditableMesh::Kind;

const Vector3 upward{ 0, 0, 1 };

EditableMesh triangles(Kind kind, const std::vector<Point3>& points, const Cells<3>& cells)
{
  EditableMesh mesh(kind, kind == Kind::Plane ? upward : Vector3{});
  for (const Point3& point : points)
  {
    mesh.addVertex({ point, point, {}, false, false });
  }
  for (const auto& cell : cells)
  {
    mesh.addFacet({ cell, 0, static_cast<Index>(mesh.facets().size()) });
  }
  return mesh;
}

double areaOf(const EditableMesh& mesh, const std::array<Index, 3>& cell)
{
  return 0.5 * twofoldAreaVector(mesh.vertex(cell[0]).point, mesh.vertex(cell[1]).point,
                 mesh.vertex(cell[2]).point)[2];
}

double areaOf(const EditableMesh& mesh)
{
  double area = 0;
  for (std::size_t f = 0; f < mesh.facets().size(); ++f)
  {
    const auto facet = static_cast<Index>(f);
    area += mesh.facets().exists(facet) ? areaOf(mesh, mesh.facets()[facet].corners) : 0;
  }
  return area;
}

void setOnRim(EditableMesh& mesh, const std::vector<Index>& vertices)
{
  for (const Index v : vertices)
  {
    EditableMesh::Vertex vertex = mesh.vertex(v);
    vertex.isOnRim = true;
    mesh.setVertex(v, vertex);
  }
}

/// The edge from 0 to 1 with vertices 2 on its left and 3 on its right.
EditableMesh twoTriangles(Kind kind, const Point3& left, const Point3& right)
{
  return triangles(kind, { { 0, 0, 0 }, { 1, 0, 0 }, left, right }, { { 0, 1, 2 }, { 1, 0, 3 } });
}

TEST(Swap, isTheOtherDiagonal)
{
  std::mt19937 random(3);
  const auto between = [&](double low, double high)
  { return low + (high - low) * static_cast<double>(random() % 4096) / 4096; };
  int valid = 0;
  for (int k = 0; k < 200; ++k)
  {
    EditableMesh mesh = twoTriangles(Kind::Plane, { between(-1, 2), between(0.1, 1), 0 },
      { between(-1, 2), between(-1, -0.1), 0 });
    const double area = areaOf(mesh);
    Cavity cavity;
    ASSERT_TRUE(proposeEdgeRemoval(mesh, k % 2, 1 - k % 2, cavity));
    // By hand: the triangles 0 3 2 and 3 1 2 turn to the left where the quadrilateral is convex.
    const bool isConvex = areaOf(mesh, { 0, 3, 2 }) > 0 && areaOf(mesh, { 3, 1, 2 }) > 0;
    EXPECT_EQ(mesh.isValid(cavity), isConvex);
    valid += isConvex;
    mesh.replace(cavity);
    EXPECT_NEAR(areaOf(mesh), area, 1e-15);
    EXPECT_TRUE(mesh.facets().at(0, 1).empty());
    EXPECT_EQ(mesh.facets().at(2, 3).size(), 2u);
  }
  EXPECT_GT(valid, 50);
  EXPECT_LT(valid, 180);
}

TEST(Swap, leavesSegmentsAndWhatIsBeyondAlone)
{
  Cavity cavity;
  EditableMesh tags = twoTriangles(Kind::Plane, { 0.5, 1, 0 }, { 0.5, -1, 0 });
  tags.replace({ {}, { 1 }, {}, {}, { { { 1, 0, 3 }, 1, 1 } }, {} });
  tags.closeFacets();
  EXPECT_FALSE(proposeEdgeRemoval(tags, 0, 1, cavity));

  EditableMesh turned = triangles(Kind::Surface,
    { { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, 1, 0 }, { 0.5, -1, 0 } }, { { 0, 1, 2 }, { 0, 1, 3 } });
  turned.closeFacets();
  EXPECT_FALSE(proposeEdgeRemoval(turned, 0, 1, cavity)) << "the facets do not turn alike";

  EditableMesh three = triangles(Kind::Surface,
    { { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, 1, 0 }, { 0.5, -1, 0 }, { 0.5, 0, 1 } },
    { { 0, 1, 2 }, { 1, 0, 3 }, { 0, 1, 4 } });
  three.closeFacets();
  EXPECT_FALSE(proposeEdgeRemoval(three, 0, 1, cavity)) << "three facets meet there";

  for (const Kind kind : { Kind::Plane, Kind::Surface })
  {
    EditableMesh mesh = twoTriangles(kind, { 0.5, 1, 0 }, { 0.5, -1, 0 });
    EXPECT_TRUE(proposeEdgeRemoval(mesh, 0, 1, cavity));
    EXPECT_FALSE(proposeEdgeRemoval(mesh, 0, 2, cavity)) << "there is nothing on the other side";
    setOnRim(mesh, { 2, 3 });
    // In the plane there is no place for it elsewhere.
    EXPECT_EQ(proposeEdgeRemoval(mesh, 0, 1, cavity), kind == Kind::Plane);
    setOnRim(mesh, { 0, 1 });
    EXPECT_FALSE(proposeEdgeRemoval(mesh, 0, 1, cavity));
  }
}

/// The faces of a tetrahedron.
EditableMesh closedSurface()
{
  EditableMesh mesh =
    triangles(Kind::Surface, { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } },
      { { 1, 2, 3 }, { 0, 3, 2 }, { 0, 1, 3 }, { 0, 2, 1 } });
  mesh.closeFacets();
  return mesh;
}

TEST(Swap, makesNoEdgeThatIsThere)
{
  Cavity cavity;
  EXPECT_FALSE(proposeEdgeRemoval(closedSurface(), 0, 1, cavity));
}

/// A square of n * n boxes, its sides lines of their own.
EditableMesh square(int n)
{
  const Mesh boxes = cadtest::squareMesh(n, 0.1, 5);
  EditableMesh mesh = triangles(Kind::Plane, boxes.points, boxes.triangles);
  for (const auto& cell : boxes.triangles)
  {
    for (const auto& [i, j] : triangleEdges)
    {
      for (int side = 0; side < 4; ++side)
      {
        const auto isOnSide = [&](Index v)
        { return boxes.points[v][side / 2] == static_cast<double>(side % 2); };
        if (isOnSide(cell[i]) && isOnSide(cell[j]))
        {
          mesh.addSegment({ { cell[i], cell[j] }, side, -1, {} });
        }
      }
    }
  }
  mesh.closeFacets();
  return mesh;
}

TEST(TriangleCollapse, keepsTheSquare)
{
  const EditableMesh mesh = square(4);
  std::array<int, 4> possible{};
  int corners = 0;
  for (std::size_t f = 0; f < mesh.facets().size(); ++f)
  {
    const auto& cell = mesh.facets()[static_cast<Index>(f)].corners;
    for (int k = 0; k < 6; ++k)
    {
      const Index from = cell[k % 3];
      const Index to = cell[(k % 3 + 1 + k / 3) % 3];
      const EditableMesh::Freedom freedom = mesh.freedomOf(from);
      const Point3& point = mesh.vertex(from).point;
      const int sides = static_cast<int>(point[0] == 0 || point[0] == 1) +
                        static_cast<int>(point[1] == 0 || point[1] == 1);
      EXPECT_EQ(freedom, sides == 0   ? EditableMesh::Freedom::Facet
                         : sides == 1 ? EditableMesh::Freedom::Segment
                                      : EditableMesh::Freedom::None);
      corners += sides == 2;
      Cavity cavity;
      if (proposeCollapse(mesh, from, to, cavity) && mesh.isValid(cavity))
      {
        ++possible[static_cast<std::size_t>(freedom)];
        EditableMesh collapsed = mesh;
        collapsed.replace(cavity);
        EXPECT_NEAR(areaOf(collapsed), 1, 1e-14);
        EXPECT_TRUE(collapsed.facets().at(from).empty());
        EXPECT_TRUE(collapsed.segments().at(from).empty());
      }
    }
  }
  EXPECT_GT(corners, 0);
  EXPECT_EQ(possible[static_cast<std::size_t>(EditableMesh::Freedom::None)], 0);
  EXPECT_GT(possible[static_cast<std::size_t>(EditableMesh::Freedom::Segment)], 0);
  EXPECT_GT(possible[static_cast<std::size_t>(EditableMesh::Freedom::Facet)], 0);
}

TEST(TriangleCollapse, leavesClosedSurfacesClosed)
{
  const EditableMesh mesh = closedSurface();
  Cavity cavity;
  for (Index to = 1; to < 4; ++to)
  {
    EXPECT_FALSE(proposeCollapse(mesh, 0, to, cavity)) << "two facets would lie on each other";
  }
}

/// Two fans of six triangles round a vertex that they have in common, 0.
EditableMesh twoTips(bool areJoined)
{
  std::vector<Point3> points{ { 0, 0, 0 } };
  Cells<3> cells;
  for (const Index fan : { 0, 1 })
  {
    const auto first = static_cast<Index>(points.size());
    for (Index k = 0; k < 6; ++k)
    {
      const double angle = 1.0471975511965976 * k;
      points.push_back({ std::cos(angle), std::sin(angle), fan == 0 ? -1.0 : 1.0 });
      cells.push_back({ 0, first + k, first + (k + 1) % 6 });
    }
    if (!areJoined)
    {
      break;
    }
  }
  EditableMesh mesh = triangles(Kind::Surface, points, cells);
  mesh.closeFacets();
  return mesh;
}

TEST(TriangleCollapse, leavesTipsThatMeetAlone)
{
  Cavity cavity;
  EXPECT_TRUE(proposeCollapse(twoTips(false), 0, 1, cavity));
  EXPECT_FALSE(proposeCollapse(twoTips(true), 0, 1, cavity));
}

TEST(TriangleCollapse, makesNoEdgeThatMayBeBeyond)
{
  EditableMesh mesh = twoTips(false);
  Cavity cavity;
  ASSERT_TRUE(proposeCollapse(mesh, 0, 1, cavity));
  setOnRim(mesh, { 1 });
  EXPECT_TRUE(proposeCollapse(mesh, 0, 1, cavity));
  setOnRim(mesh, { 3 });
  EXPECT_FALSE(proposeCollapse(mesh, 0, 1, cavity));
}

/// In space a triangle has no outside, so that what it comes from tells whether it turned over.
TEST(TriangleCollapse, tellsTrianglesThatTurnOver)
{
  // From 1 the border is not seen as a whole: 5 is in the way of 2.
  const std::vector<Point3> points{ { 0, 0, 0 }, { 2, 0, 0.1 }, { 0.2, 1, 0 }, { -0.3, 0.2, 0 },
    { 0.2, -1, 0 }, { 0.9, 0.3, 0 } };
  const Cells<3> cells{ { 0, 1, 5 }, { 0, 5, 2 }, { 0, 2, 3 }, { 0, 3, 4 }, { 0, 4, 1 } };
  EditableMesh mesh = triangles(Kind::Surface, points, cells);
  mesh.closeFacets();
  Cavity cavity;
  ASSERT_TRUE(proposeCollapse(mesh, 0, 1, cavity));
  EXPECT_FALSE(mesh.isValid(cavity));
  ASSERT_TRUE(proposeCollapse(mesh, 0, 3, cavity));
  EXPECT_TRUE(mesh.isValid(cavity));
}

TEST(TriangleSplit, swapsWhereThatGains)
{
  // A strip, 8 long and 1 wide, of two triangles and one at the end of the long edge between.
  const std::vector<Point3> points{ { 0, 0, 0 }, { 8, 0, 0 }, { 8, 1, 0 }, { 0, 1, 0 } };
  EditableMesh mesh = triangles(Kind::Plane, points, { { 0, 1, 2 }, { 0, 2, 3 } });
  mesh.closeFacets();
  const Index middle = mesh.addVertex({ { 4, 0, 0 }, { 4, 0, 0 }, {}, false, false });
  Cavity cavity;
  ASSERT_TRUE(proposeSplit(mesh, 0, 1, middle, cavity));
  ASSERT_EQ(cavity.newFacets.size(), 2u);
  const double before = mesh.worst({ 0, 1 });
  swapRoundMiddle(mesh, middle, cavity);
  ASSERT_EQ(cavity.newFacets.size(), 3u);
  EXPECT_TRUE(mesh.isValid(cavity));
  double worst = 1;
  for (const auto& facet : cavity.newFacets)
  {
    worst = std::min(worst, mesh.quality(facet.corners));
  }
  // The two at the ends have legs 4 and 1: 4 sqrt(3) 2 / (16 + 1 + 17).
  EXPECT_NEAR(worst, std::min(4 * std::sqrt(3.0) * 2 / 34, 4 * std::sqrt(3.0) * 4 / 98), 1e-15);
  EXPECT_GT(worst, before);
  mesh.replace(cavity);
  EXPECT_NEAR(areaOf(mesh), 8, 1e-14);
}

TEST(TriangleSplit, keepsAreaAndLabels)
{
  EditableMesh mesh = square(2);
  const auto corners = mesh.facets()[0].corners;
  const Point3 middle = 0.5 * (mesh.vertex(corners[0]).point + mesh.vertex(corners[1]).point);
  const Index vertex = mesh.addVertex({ middle, middle, {}, false, false });
  const std::size_t around = mesh.facets().at(corners[0], corners[1]).size();
  Cavity cavity;
  ASSERT_TRUE(proposeSplit(mesh, corners[0], corners[1], vertex, cavity));
  EXPECT_EQ(cavity.newFacets.size(), 2 * around);
  EXPECT_EQ(cavity.newSegments.size(), 2 * cavity.segments.size());
  EXPECT_TRUE(mesh.isValid(cavity));
  mesh.replace(cavity);
  EXPECT_NEAR(areaOf(mesh), 1, 1e-15);
}

} // namespace
