// A mesh on two sides of a bore that hold together at an edge across it.

#include "TestShapes.h"

#include <cadrefine/operations/PinchedEdges.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <utility>

namespace
{

using namespace cadrefine;

/// A cell on either side of a bore of radius 1, in a block: the edge between them leads across it,
/// `away` from its axis.
EditableMesh pinched(const CADModel& model, double away)
{
  EditableMesh mesh;
  const auto add = [&](const Point3& point)
  {
    const ClosestPoint where = model.nearest(point, {});
    mesh.addVertex({ point, point, where.distance < 1e-9 ? where.entity : EntityId{} });
  };
  const double half = std::sqrt(1 - away * away);
  add({ away, half, 2 });
  add({ away, -half, 2 });
  for (const double side : { 2, -2 })
  {
    add({ side, 0, 1 });
    add({ side, 0, 3 });
  }
  for (const Index first : { 2, 4 })
  {
    std::array<Index, 4> cell{ 0, 1, first, first + 1 };
    if (!mesh.isValid(cell))
    {
      std::swap(cell[0], cell[1]);
    }
    mesh.addCell({ cell, 0, first / 2 - 1 });
    mesh.addFacet({ { cell[0], cell[2], cell[1] }, 0, -1 });
    mesh.addFacet({ { cell[0], cell[1], cell[3] }, 0, -1 });
  }
  mesh.closeFacets();
  return mesh;
}

class PinchedEdges : public testing::TestWithParam<double>
{
protected:
  std::shared_ptr<const CADModel> model = cadtest::modelOf(cadtest::pipe(1, 3, 4));
  BoundaryProjector projector{ *model, BoundaryKind::Faces };
  SurfaceRule rule{ projector };
};

INSTANTIATE_TEST_SUITE_P(Places, PinchedEdges, testing::Values(0, 0.3, -0.3));

/// Even where the middle of the edge is nearer to the other side.
TEST_P(PinchedEdges, getAMiddleOnEachSide)
{
  EditableMesh mesh = pinched(*model, GetParam());
  ASSERT_GE(mesh.segmentOf(0, 1), 0);
  const OperationResult result = openPinchedEdges(mesh, rule);
  ASSERT_EQ(result.added.size(), 2u);
  EXPECT_EQ(result.counts.splits, 2);
  EXPECT_TRUE(mesh.cells().at(0, 1).empty());
  EXPECT_TRUE(mesh.facets().at(0, 1).empty());
  EXPECT_LT(mesh.segmentOf(0, 1), 0);
  for (const Index middle : { 6, 7 })
  {
    ASSERT_EQ(mesh.cells().at(middle).size(), 2u);
    EXPECT_EQ(mesh.facets().at(middle).size(), 4u);
    for (const Index cell : mesh.cells().at(middle))
    {
      EXPECT_TRUE(mesh.isValid(mesh.cells()[cell].corners));
      const auto& corners = mesh.cells()[cell].corners;
      const double side = hasCorner(corners, 2) || hasCorner(corners, 3) ? 1 : -1;
      const Point3& wanted = mesh.vertex(middle).wanted;
      EXPECT_NEAR(wanted[0], side, 1e-9);
      EXPECT_NEAR(wanted[1], 0, 1e-9);
      const Point3 nearest =
        projector.nearestOn(mesh.vertex(middle).entity, mesh.vertex(middle).point).point;
      EXPECT_LT(distance(nearest, wanted), 1e-9);
    }
  }
}

/// An edge may have cells beyond the mesh.
TEST_F(PinchedEdges, stayWhereOneSideIsUnknown)
{
  EditableMesh mesh = pinched(*model, 0);
  for (const Index end : { 0, 1 })
  {
    EditableMesh::Vertex vertex = mesh.vertex(end);
    vertex.isOnRim = true;
    mesh.setVertex(end, vertex);
  }
  EXPECT_EQ(openPinchedEdges(mesh, rule).counts.operations(), 0);
  EXPECT_EQ(mesh.cells().at(0, 1).size(), 2u);
}

} // namespace
