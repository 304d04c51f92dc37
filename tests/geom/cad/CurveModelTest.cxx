// Files that hold only curves give edges with common vertices.

#include "TestFiles.h"

#include <cadrefine/cad/import/CADFile.h>

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRep_Builder.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <gp_Circ.hxx>

#include <gtest/gtest.h>

namespace
{

using namespace cadrefine;

TopoDS_Edge arc(const gp_Pnt& a, const gp_Pnt& b, const gp_Pnt& c)
{
  return BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(a, b, c).Value()).Edge();
}

TopoDS_Compound compoundOf(std::initializer_list<TopoDS_Shape> shapes)
{
  BRep_Builder builder;
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  for (const TopoDS_Shape& shape : shapes)
  {
    builder.Add(compound, shape);
  }
  return compound;
}

/// Three arcs round a triangle, whose ends miss each other by `gap`.
TopoDS_Shape threeArcs(double gap)
{
  const gp_Pnt a(0, 0, 0), b(4, 0, 0), c(2, 3, 0);
  const auto off = [gap](const gp_Pnt& p) { return gp_Pnt(p.X() + gap, p.Y() - gap, p.Z()); };
  return compoundOf({ arc(a, gp_Pnt(2, -0.5, 0), b), arc(off(b), gp_Pnt(3.3, 1.7, 0), c),
    arc(off(c), gp_Pnt(0.7, 1.7, 0), off(a)) });
}

class CurveModel : public testing::TestWithParam<const char*>
{
protected:
  std::shared_ptr<const CADModel> roundTrip(const TopoDS_Shape& shape) const
  {
    const std::string path = this->folder.file(std::string("curves") + GetParam());
    cadtest::writeShape(shape, path);
    return readCADFile(path);
  }

  cadtest::TemporaryFolder folder;
};

INSTANTIATE_TEST_SUITE_P(Formats, CurveModel, testing::Values(".brep", ".step", ".igs"),
  [](const auto& format) { return std::string(format.param + 1); });

void expectClosedChainOfThree(const CADModel& model)
{
  EXPECT_EQ(model.count(2), 0);
  ASSERT_EQ(model.count(1), 3);
  ASSERT_EQ(model.count(0), 3);
  EXPECT_TRUE(model.unread().empty());
  for (const NurbsVertex& vertex : model.nurbs().vertices)
  {
    EXPECT_EQ(vertex.edges.size(), 2u);
  }
  for (const NurbsEdge& edge : model.nurbs().edges)
  {
    EXPECT_TRUE(edge.sharp);
    EXPECT_NE(edge.firstVertex, edge.lastVertex);
    const Point3 start = evaluate(edge.segments.front(), edge.segments.front().t0);
    EXPECT_LT(distance(start, model.nurbs().vertices[edge.firstVertex].point), 1e-4);
  }
}

TEST_P(CurveModel, threeArcsShareThreeVertices)
{
  const auto model = this->roundTrip(threeArcs(0));
  expectClosedChainOfThree(*model);
  EXPECT_NEAR(model->nearest({ 2, -2, 0 }).distance, 1.5, 1e-9);
}

TEST_P(CurveModel, smallGapsAreClosed)
{
  expectClosedChainOfThree(*this->roundTrip(threeArcs(1e-5)));
}

TEST_P(CurveModel, aCircleIsOneEdgeThatEndsWhereItBegins)
{
  const gp_Circ circle(gp_Ax2(gp_Pnt(1, 1, 0), gp_Dir(0, 0, 1)), 3);
  const auto model = this->roundTrip(compoundOf({ BRepBuilderAPI_MakeEdge(circle).Edge() }));
  ASSERT_EQ(model->count(1), 1);
  EXPECT_EQ(model->count(0), 1);
  EXPECT_EQ(model->nurbs().edges[0].firstVertex, model->nurbs().edges[0].lastVertex);
  EXPECT_NEAR(model->nearest({ 1.5, 1, 0 }).distance, 2.5, 1e-9);
  const NurbsEdge& edge = model->nurbs().edges[0];
  const double t = 0.5 * (edge.segments.front().t0 + edge.segments.back().t1);
  const Point3 p = model->evaluate({ 1, 0 }, { t, 0 });
  EXPECT_NEAR(dot(model->tangent(0, t), p - Point3{ 1, 1, 0 }), 0, 1e-9);
  EXPECT_NEAR(norm(model->tangent(0, t)), 1, 1e-12);
}

TEST_P(CurveModel, curvesBesideFacesStay)
{
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(1, 1, 1).Shape();
  const TopoDS_Edge line = BRepBuilderAPI_MakeEdge(gp_Pnt(5, 0, 0), gp_Pnt(6, 0, 0)).Edge();
  const auto model = this->roundTrip(compoundOf({ box, line }));
  EXPECT_EQ(model->count(2), 6);
  EXPECT_EQ(model->count(1), 13) << "the box's trim curves must not come twice";
  EXPECT_EQ(model->count(0), 10);
}

} // namespace
