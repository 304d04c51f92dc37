// What Open CASCADE cannot make a model of is lost alone, and listed; all else is read.

#include "IgesCases.h"
#include "TestFiles.h"

#include <cadrefine/cad/import/CADFile.h>

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRep_Builder.hxx>
#include <Geom_Circle.hxx>
#include <Geom_Line.hxx>
#include <Geom_Plane.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Wire.hxx>

#include <gp.hxx>
#include <gp_Ax1.hxx>
#include <gp_Pln.hxx>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace
{

using namespace cadrefine;
using namespace cadtest;

class Loss : public testing::Test
{
protected:
  std::shared_ptr<const CADModel> reread(const TopoDS_Shape& shape)
  {
    writeShape(shape, this->folder.file("shape.brep"));
    return readCADFile(this->folder.file("shape.brep"));
  }

  /// A box in STEP with more entities.
  std::shared_ptr<const CADModel> rereadWith(const std::string& entities)
  {
    const std::string path = this->folder.file("box.step");
    writeShape(BRepPrimAPI_MakeBox(1, 2, 3).Shape(), path);
    auto lines = linesOf(path);
    const auto end = std::find(lines.rbegin(), lines.rend(), "ENDSEC;");
    lines.insert(end.base() - 1, entities);
    writeLines(path, lines);
    return readCADFile(path);
  }

  TemporaryFolder folder;
};

/// A half disc of radius 1 whose arc is the part [first, last] of a trimmed circle.
TopoDS_Shape halfDisc(double trimFirst, double trimLast, double first, double last)
{
  const Handle(Geom_Circle) circle = new Geom_Circle(gp_Ax2(), 1);
  const Handle(Geom_Curve) arc = new Geom_TrimmedCurve(circle, trimFirst, trimLast);
  const gp_Pnt start = circle->Value(first);
  const gp_Pnt end = circle->Value(last);
  const BRep_Builder builder;
  TopoDS_Edge curved = BRepBuilderAPI_MakeEdge(circle, start, end).Edge();
  const TopoDS_Edge straight =
    BRepBuilderAPI_MakeEdge(TopExp::LastVertex(curved), TopExp::FirstVertex(curved)).Edge();
  const TopoDS_Wire wire = BRepBuilderAPI_MakeWire(curved, straight).Wire();
  const TopoDS_Face face = BRepBuilderAPI_MakeFace(gp_Pln(), wire).Face();
  for (TopExp_Explorer edge(face, TopAbs_EDGE); edge.More(); edge.Next())
  {
    if (edge.Current().IsSame(curved))
    {
      builder.UpdateEdge(TopoDS::Edge(edge.Current()), arc, 1e-7);
      builder.Range(TopoDS::Edge(edge.Current()), first, last);
    }
  }
  return face;
}

void expectHalfDisc(const CADModel& model)
{
  ASSERT_EQ(model.count(2), 1);
  ASSERT_EQ(model.count(1), 2);
  EXPECT_TRUE(model.unread().empty());
  for (const double angle : { 0.1, 1.0, 2.0, 3.0 })
  {
    const Point3 outside{ 2 * std::cos(angle), 2 * std::sin(angle), 0 };
    EXPECT_NEAR(model.nearest(outside).distance, 1, 1e-9);
  }
  EXPECT_NEAR(model.nearest({ 0.3, -1, 0 }).distance, 1, 1e-9);
}

TEST_F(Loss, anEdgeMayStickOutOfItsCurveByRounding)
{
  expectHalfDisc(*this->reread(halfDisc(0, M_PI, -1e-12, M_PI + 1e-12)));
}

TEST_F(Loss, anEdgeMayLieOnTheOtherSideOfAPeriod)
{
  expectHalfDisc(*this->reread(halfDisc(0, M_PI, 2 * M_PI, 3 * M_PI)));
}

/// A face that its one edge encloses nothing of.
TopoDS_Face faceWithoutArea()
{
  const BRep_Builder builder;
  TopoDS_Edge edge = BRepBuilderAPI_MakeEdge(gp_Pnt(5, 0, 0), gp_Pnt(6, 0, 0)).Edge();
  TopoDS_Wire wire;
  builder.MakeWire(wire);
  builder.Add(wire, edge);
  builder.Add(wire, edge.Reversed());
  TopoDS_Face face;
  builder.MakeFace(face, new Geom_Plane(gp_Pln()), 1e-7);
  builder.Add(face, wire);
  return face;
}

TEST_F(Loss, aFaceWithoutAreaIsLostAlone)
{
  const BRep_Builder builder;
  TopoDS_Compound both;
  builder.MakeCompound(both);
  builder.Add(both, faceWithoutArea());
  builder.Add(both, BRepPrimAPI_MakeBox(1, 2, 3).Shape());
  const auto model = this->reread(both);
  EXPECT_EQ(model->count(2), 6);
  ASSERT_EQ(model->unread().size(), 1u);
  EXPECT_EQ(model->unread()[0].entity, 1);
  EXPECT_EQ(model->unread()[0].type, "BREP face");
  EXPECT_EQ(model->unread()[0].reason, "its trim curves enclose no area");
}

/// Open CASCADE cannot sew a face whose edge has no end.
TEST_F(Loss, aStepThatFailsIsLeftOut)
{
  const BRep_Builder builder;
  TopoDS_Edge endless;
  builder.MakeEdge(endless, new Geom_Line(gp::OX()), 1e-7);
  builder.Range(endless, -2e100, 2e100);
  TopoDS_Wire wire;
  builder.MakeWire(wire);
  builder.Add(wire, endless);
  TopoDS_Face face;
  builder.MakeFace(face, new Geom_Plane(gp_Pln()), 1e-7);
  builder.Add(face, wire);
  TopoDS_Compound apart;
  builder.MakeCompound(apart);
  builder.Add(apart, face);
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(1, 2, 3).Shape();
  for (TopExp_Explorer side(box, TopAbs_FACE); side.More(); side.Next())
  {
    builder.Add(apart, side.Current());
  }
  const auto model = this->reread(apart);
  EXPECT_EQ(model->count(2), 6);
  ASSERT_EQ(model->report().repairs.size(), 1u);
  EXPECT_EQ(model->report().repairs[0].find("read without sewing: Open CASCADE"), 0u)
    << model->report().repairs[0];
  ASSERT_EQ(model->unread().size(), 1u);
  EXPECT_EQ(model->unread()[0].entity, 1);
}

/// Open CASCADE 7.6 crashes on a null colour.
TEST_F(Loss, aStyleOfCurvesOnAFaceCostsNothing)
{
  const std::string path = this->folder.file("box.step");
  writeShape(BRepPrimAPI_MakeBox(1, 2, 3).Shape(), path);
  const auto lines = linesOf(path);
  const auto face = std::find_if(lines.begin(), lines.end(),
    [](const std::string& line) { return line.find("ADVANCED_FACE") != std::string::npos; });
  const auto context = std::find_if(lines.begin(), lines.end(),
    [](const std::string& line)
    { return line.find("GEOMETRIC_REPRESENTATION_CONTEXT(3)") != std::string::npos; });
  const auto number = [](const std::string& line) { return line.substr(0, line.find(' ')); };
  const auto model = this->rereadWith(
    "#900=CURVE_STYLE('',$,$,$);#901=PRESENTATION_STYLE_ASSIGNMENT((#900));\n"
    "#902=STYLED_ITEM('',(#901)," +
    number(*face) + ");#903=MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',(#902)," +
    number(*context) + ");");
  EXPECT_EQ(model->count(2), 6);
  EXPECT_TRUE(model->unread().empty());
  EXPECT_TRUE(model->report().repairs.empty());
}

TEST_F(Loss, partsInFilesOfTheirOwnAreNamed)
{
  const auto model = this->rereadWith("#900=DOCUMENT_FILE('wing.stp','','',#901,'',$);\n"
                                      "#901=DOCUMENT_TYPE('geometry');\n"
                                      "#902=DOCUMENT_FILE('readme.txt','','',#901,'',$);");
  EXPECT_EQ(model->count(2), 6);
  ASSERT_EQ(model->unread().size(), 1u);
  EXPECT_EQ(model->unread()[0].entity, 900);
  EXPECT_EQ(model->unread()[0].type, "STEP DOCUMENT_FILE");
  EXPECT_EQ(model->unread()[0].reason, "a part of the assembly is in a file of its own, wing.stp");
}

TEST_F(Loss, igesRecordsNeedNoLineEnds)
{
  IgesWriter file;
  addSquare(file, { 0, 0, 0 }, {});
  file.write(this->folder.file("square.igs"));
  std::string records;
  for (std::string line : linesOf(this->folder.file("square.igs")))
  {
    line.resize(80, ' ');
    records += line;
  }
  const auto model = readCADFile(this->folder.write("records.igs", records));
  EXPECT_EQ(model->count(2), 1);
  ASSERT_EQ(model->report().repairs.size(), 1u);
  EXPECT_EQ(model->report().repairs[0], "its lines have no ends");
}

} // namespace
