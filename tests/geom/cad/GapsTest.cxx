// Patches that the file leaves apart become one topology; gaps that stay are reported.

#include "IgesCases.h"
#include "TestFiles.h"

#include <cadrefine/cad/import/CADFile.h>

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRep_Builder.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shell.hxx>
#include <gp_Pln.hxx>

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace
{

using namespace cadrefine;
using namespace cadtest;

/// The model's size is about this.
const double size = std::sqrt(5.0);
/// The largest tolerance of sewing.
const double tolerance = 1e-4 * size;

std::shared_ptr<const CADModel> twoSquaresApart(double gap)
{
  IgesWriter file;
  addSquare(file, { 0, 0, 0 }, {});
  addSquare(file, { 1 + gap, 0, 0 }, {});
  return readWritten(file);
}

TEST(Gaps, patchesThatMeetShareAnEdge)
{
  for (const double gap : { 0.0, 0.5 * tolerance })
  {
    const auto model = twoSquaresApart(gap);
    EXPECT_EQ(model->count(2), 2);
    EXPECT_EQ(model->count(1), 7) << gap;
    EXPECT_EQ(model->count(0), 6) << gap;
    EXPECT_GT(model->report().sewingTolerance, gap);
    EXPECT_LE(model->report().sewingTolerance, 1.01 * tolerance);
    EXPECT_TRUE(model->report().gaps.empty());
  }
}

TEST(Gaps, aWiderOneIsReportedWithItsPlace)
{
  const double width = 5 * tolerance;
  const auto model = twoSquaresApart(width);
  EXPECT_EQ(model->count(1), 8);
  ASSERT_EQ(model->report().gaps.size(), 1u);
  const Gap& gap = model->report().gaps[0];
  EXPECT_NEAR(gap.width, width, 1e-6 * size);
  EXPECT_NEAR(gap.point[0], 1, 1.1 * width);
  EXPECT_GT(gap.point[1], 0);
  EXPECT_LT(gap.point[1], 1);
  for (const int edge : gap.edges)
  {
    EXPECT_LT(model->nearestOn({ 1, edge }, gap.point).distance, 1.1 * width);
  }
}

TEST(Gaps, areNotSeenWhereEdgesMeetAtAnAngle)
{
  IgesWriter file;
  addSquare(file, { 0, 0, 0 }, {});
  addBilinear(file, { { 1, 0, 0.002 }, { 2, 0, 1 }, { 1, 1, 1 }, { 2, 1, 2 } });
  const auto model = readWritten(file);
  EXPECT_EQ(model->count(2), 2);
  EXPECT_TRUE(model->report().gaps.empty());
}

/// A shell of the one face that stands on the unit square's edge along y, at `x`.
TopoDS_Shell shellAt(double x, const gp_Dir& normal)
{
  const gp_Pln plane(gp_Ax3(gp_Pnt(x, 0, 0), normal, gp_Dir(0, 1, 0)));
  TopoDS_Shell shell;
  BRep_Builder().MakeShell(shell);
  BRep_Builder().Add(shell, BRepBuilderAPI_MakeFace(plane, 0, 1, 0, 1).Face());
  return shell;
}

TEST(Gaps, betweenOpenShellsAreSewnToo)
{
  TopoDS_Compound both;
  BRep_Builder().MakeCompound(both);
  BRep_Builder().Add(both, shellAt(0, gp_Dir(0, 0, 1)));
  BRep_Builder().Add(both, shellAt(0, gp_Dir(1, 0, 0)));
  const TemporaryFolder folder;
  writeShape(both, folder.file("shells.brep"));
  const auto model = readCADFile(folder.file("shells.brep"));
  EXPECT_EQ(model->count(2), 2);
  EXPECT_EQ(model->count(1), 7);
  EXPECT_EQ(model->count(0), 6);
}

/// Bodies that touch share no topology; else two vertices of a mesh would be wanted at one place,
/// and an edge would not know all of the faces beside it.
TEST(Gaps, bodiesThatTouchHaveOneVertexAndOneEdgeAtEachPlace)
{
  TopoDS_Compound bodies;
  const BRep_Builder builder;
  builder.MakeCompound(bodies);
  builder.Add(bodies, BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), gp_Pnt(1, 1, 1)).Shape());
  builder.Add(bodies, BRepPrimAPI_MakeBox(gp_Pnt(1, 0, 0), gp_Pnt(2, 1, 1)).Shape());
  const TemporaryFolder folder;
  writeShape(bodies, folder.file("bodies.brep"));
  const auto model = readCADFile(folder.file("bodies.brep"));
  ASSERT_EQ(model->count(0), 16);
  std::map<std::size_t, int> verticesWith;
  for (const NurbsVertex& vertex : model->nurbs().vertices)
  {
    ++verticesWith[vertex.edges.size()];
  }
  EXPECT_EQ(verticesWith, (std::map<std::size_t, int>{ { 0, 4 }, { 3, 8 }, { 4, 4 } }));
  for (int v = 0; v < model->count(0); ++v)
  {
    const Point3& point = model->nurbs().vertices[v].point;
    const EntityId found = model->nearest(point).entity;
    EXPECT_EQ(found.dimension, 0);
    EXPECT_EQ(model->nurbs().vertices[found.index].edges.size(), point[0] == 1 ? 4u : 3u);
  }
  std::map<std::size_t, int> edgesWith;
  for (const NurbsEdge& edge : model->nurbs().edges)
  {
    ++edgesWith[edge.faces.size()];
    EXPECT_EQ(edge.sharp, !edge.faces.empty());
  }
  EXPECT_EQ(edgesWith, (std::map<std::size_t, int>{ { 0, 4 }, { 2, 16 }, { 4, 4 } }));
  const EntityId between = model->nearest({ 1, 0, 0.3 }).entity;
  ASSERT_EQ(between.dimension, 1);
  EXPECT_EQ(model->nurbs().edges[between.index].faces.size(), 4u);
  EXPECT_TRUE(model->nurbs().edges[between.index].sharp);
}

} // namespace
