// Shapes of Open CASCADE that are no models, and text of STEP and BREP files with one thing
// changed.

#include "BadFiles.h"

#include "Error.h"
#include "IsolatedRun.h"
#include "TestFiles.h"

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepLib.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRep_Builder.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Plane.hxx>
#include <Geom_SphericalSurface.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>
#include <gp_Pln.hxx>

#include <array>
#include <fstream>
#include <iterator>
#include <utility>

namespace badcad
{
namespace
{

/// What Open CASCADE writes, chattering; "" where it crashes.
std::string textOf(const TopoDS_Shape& shape, const std::string& extension)
{
  const auto write = [&]
  {
    const cadtest::TemporaryFolder folder;
    const std::string path = folder.file("shape" + extension);
    cadtest::writeShape(shape, path);
    std::ifstream file(path, std::ios::binary);
    return std::vector<char>{ std::istreambuf_iterator<char>(file),
      std::istreambuf_iterator<char>() };
  };
  try
  {
    const std::vector<char> bytes = cadrefine::runIsolated("writing", { 60 }, write);
    return { bytes.begin(), bytes.end() };
  }
  catch (const cadrefine::Error&)
  {
    return "";
  }
}

using Corners = std::vector<gp_Pnt>;

TopoDS_Wire polygon(const Corners& corners, bool closed)
{
  BRepBuilderAPI_MakePolygon maker;
  for (const gp_Pnt& corner : corners)
  {
    maker.Add(corner);
  }
  if (closed)
  {
    maker.Close();
  }
  return maker.Wire();
}

/// A face on `surface` with wires that nobody checks.
TopoDS_Face faceOn(const Handle(Geom_Surface) & surface, const std::vector<TopoDS_Wire>& wires)
{
  const BRep_Builder builder;
  TopoDS_Face face;
  builder.MakeFace(face, surface, 1e-7);
  for (const TopoDS_Wire& wire : wires)
  {
    builder.Add(face, wire);
  }
  return face;
}

TopoDS_Face flatFace(const std::vector<TopoDS_Wire>& wires)
{
  return faceOn(new Geom_Plane(gp_Pln()), wires);
}

TopoDS_Wire emptyWire()
{
  TopoDS_Wire wire;
  BRep_Builder().MakeWire(wire);
  return wire;
}

/// An edge from a vertex to another, without any curve.
TopoDS_Wire edgeWithoutCurve()
{
  const BRep_Builder builder;
  TopoDS_Vertex a, b;
  builder.MakeVertex(a, gp_Pnt(0, 0, 0), 1e-7);
  builder.MakeVertex(b, gp_Pnt(1, 0, 0), 1e-7);
  TopoDS_Edge edge;
  builder.MakeEdge(edge);
  builder.Add(edge, a.Oriented(TopAbs_FORWARD));
  builder.Add(edge, b.Oriented(TopAbs_REVERSED));
  TopoDS_Wire wire = emptyWire();
  builder.Add(wire, edge);
  return wire;
}

TopoDS_Shape inCompounds(TopoDS_Shape shape, int depth, const gp_Trsf& step)
{
  const BRep_Builder builder;
  for (int i = 0; i < depth; ++i)
  {
    TopoDS_Compound outer;
    builder.MakeCompound(outer);
    builder.Add(outer, shape.Moved(TopLoc_Location(step)));
    shape = outer;
  }
  return shape;
}

std::vector<std::pair<std::string, TopoDS_Shape>> shapes()
{
  const Corners square{ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } };
  const Corners bow{ { 0, 0, 0 }, { 1, 1, 0 }, { 1, 0, 0 }, { 0, 1, 0 } };
  const Corners skew{ { 0, 0, 0 }, { 1, 0, 5 }, { 1, 1, 0 }, { 0, 1, -5 } };
  const Corners tiny{ { 0, 0, 0 }, { 1e-6, 0, 0 }, { 1e-6, 1e-6, 0 } };
  const Corners huge{ { 0, 0, 0 }, { 1e18, 0, 0 }, { 1e18, 1e18, 0 } };
  const Handle(Geom_Surface) cylinder = new Geom_CylindricalSurface(gp_Ax3(), 1);
  const Handle(Geom_Surface) sphere = new Geom_SphericalSurface(gp_Ax3(), 1);
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(1, 2, 3).Shape();
  gp_Trsf move, turn;
  move.SetTranslation(gp_Vec(.01, 0, 0));
  turn.SetRotation(gp::OZ(), .1);
  return { { "a plane without a loop", flatFace({}) },
    { "a cylinder without a loop", faceOn(cylinder, {}) },
    { "a sphere without a loop", faceOn(sphere, {}) },
    { "an empty loop", flatFace({ emptyWire() }) },
    { "an edge without a curve", flatFace({ edgeWithoutCurve() }) },
    { "an open loop in a face", flatFace({ polygon(square, false) }) },
    { "a bow tie", flatFace({ polygon(bow, true) }) },
    { "a loop off its plane", flatFace({ polygon(skew, true) }) },
    { "a loop off its cylinder", faceOn(cylinder, { polygon(skew, true) }) },
    { "a loop off its sphere", faceOn(sphere, { polygon(bow, true) }) },
    { "the same loop twice", flatFace({ polygon(square, true), polygon(square, true) }) },
    { "a face of size 1e-6", flatFace({ polygon(tiny, true) }) },
    { "a face of size 1e18", flatFace({ polygon(huge, true) }) },
    { "a sphere of radius 1e-6", BRepPrimAPI_MakeSphere(1e-6).Shape() },
    { "a sphere of radius 1e12", BRepPrimAPI_MakeSphere(1e12).Shape() },
    { "500 compounds in each other, moved", inCompounds(box, 500, move) },
    { "500 compounds in each other, turned", inCompounds(box, 500, turn) } };
}

using Changes = std::vector<std::array<const char*, 2>>;

/// The text with the first `from` made `to`, for each change, where it occurs.
void addChanged(std::vector<BadFile>& files, const std::string& text, const std::string& extension,
  const Changes& changes)
{
  for (const auto& [from, to] : changes)
  {
    std::string changed = text;
    const std::size_t at = changed.find(from);
    if (at != std::string::npos)
    {
      changed.replace(at, std::string(from).size(), to);
      files.push_back({ "'" + std::string(from) + "' made '" + to + "'", extension, changed });
    }
  }
}

} // namespace

std::vector<BadFile> badShapes()
{
  std::vector<BadFile> files;
  for (const auto& [name, shape] : shapes())
  {
    for (const char* extension : { ".igs", ".step", ".brep" })
    {
      const std::string text = textOf(shape, extension);
      if (!text.empty())
      {
        files.push_back({ name, extension, text });
      }
    }
  }
  return files;
}

std::vector<BadFile> badStepFiles()
{
  std::vector<BadFile> files;
  const std::string text = textOf(BRepPrimAPI_MakeBox(1, 2, 3).Shape(), ".step");
  addChanged(files, text, ".step",
    { { "CARTESIAN_POINT('',(0.,0.,0.))", "CARTESIAN_POINT('',(1.E300,0.,0.))" },
      { "CARTESIAN_POINT('',(0.,0.,0.))", "CARTESIAN_POINT('',(1.E999,0.,0.))" },
      { "CARTESIAN_POINT('',(0.,0.,0.))", "CARTESIAN_POINT('',(nan,0.,0.))" },
      { "CARTESIAN_POINT('',(0.,0.,0.))", "CARTESIAN_POINT('',())" },
      { "CARTESIAN_POINT('',(0.,0.,0.))", "CARTESIAN_POINT('',(0.))" },
      { "CARTESIAN_POINT('',(0.,0.,0.))", "CARTESIAN_POINT('',$)" },
      { "CARTESIAN_POINT('',(0.,0.,0.))", "DIRECTION('',(0.,0.,0.))" },
      { "DIRECTION('',(1.,0.,0.))", "DIRECTION('',(0.,0.,0.))" },
      { "DIRECTION('',(1.,0.,0.))", "DIRECTION('',(1.E300,1.E300,0.))" },
      { "VECTOR('',#", "VECTOR('',#99999999" }, { "LINE('',#", "LINE('',#1" },
      { "EDGE_CURVE('',#", "EDGE_CURVE('',#1" }, { "PLANE('',#", "PLANE('',#1" },
      { "EDGE_LOOP('',(", "EDGE_LOOP('',(#1," }, { "FACE_BOUND('',#", "FACE_BOUND('',#1" },
      { "ADVANCED_FACE('',(", "ADVANCED_FACE('',(#1," }, { "ADVANCED_FACE('',(", "PLANE('',(" },
      { "CLOSED_SHELL('',(", "CLOSED_SHELL('',(#15,#15," }, { "ENDSEC;", "" }, { "DATA;", "" },
      { "HEADER;", "" }, { "#15 =", "#16 =" }, { "#15 =", "#-15 =" }, { "#15 =", "#99999999999 =" },
      { "SI_UNIT(", "SI_UNIT($," }, { "FILE_SCHEMA", "FILE_SCHEME" } });
  return files;
}

BadFile endlessBrep()
{
  std::vector<BadFile> files;
  addChanged(files, textOf(BRepPrimAPI_MakeSphere(1).Shape(), ".brep"), ".brep",
    { { "Surfaces 1\n4 0 0 0", "Surfaces 1\n4 1e300 0 0" } });
  return files.at(0);
}

std::vector<BadFile> badBrepFiles()
{
  std::vector<BadFile> files;
  const std::string text = textOf(BRepPrimAPI_MakeBox(1, 2, 3).Shape(), ".brep");
  // Both went through to the mesher and to the search, and killed the process that used the model.
  addChanged(files, text, ".brep",
    { { "Ve\n1e-07\n0 ", "Ve\n1e-07\nnan " }, { "Ve\n1e-07\n0 ", "Ve\n1e-07\n1e200 " } });
  addChanged(files, textOf(BRepPrimAPI_MakeCylinder(1, 2).Shape(), ".brep"), ".brep",
    { { " 0 6.28318530717959", " 0 185707963267949" }, { " 0 6.28318530717959", " 0 1e300" } });
  const std::string ball = textOf(BRepPrimAPI_MakeSphere(1).Shape(), ".brep");
  for (const char* section : { "Locations ", "Curve2ds ", "Curves ", "Polygon3D ",
         "PolygonOnTriangulations ", "Surfaces ", "Triangulations ", "\nTShapes " })
  {
    const std::string more = section + std::string("9"), less = section + std::string("-");
    addChanged(files, text, ".brep",
      { { section, more.c_str() }, { section, less.c_str() }, { section, "" },
        { section, (section + std::string("1000000000")).c_str() } });
  }
  addChanged(files, ball, ".brep",
    { { " 1 1 1", " 1 1 -1" }, { "Surfaces 1\n4", "Surfaces 1\n99" },
      { "Surfaces 1\n4 0 0 0", "Surfaces 1\n4 nan 0 0" },

      { "Surfaces 1\n4 0 0 0 0 0 1", "Surfaces 1\n4 0 0 0 0 0 0" }, { "6.28", "1e300" },
      { "6.28", "-6.28" }, { "6.28", "nan" }, { "3.14", "99.14" }, { "1e-07", "1e300" },
      { "1e-07", "-1" }, { "1e-07", "nan" }, { "+2 0", "+999 0" }, { "+2 0", "+1 0" },
      { "-2 0", "-0 0" }, { "Ve\n", "So\n" }, { "Ed\n", "Ve\n" }, { "Fa\n", "Ed\n" } });
  return files;
}

} // namespace badcad
