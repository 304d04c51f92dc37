// Shapes of Open CASCADE that are no models.

#include "BadFiles.h"

#include "ShapeText.h"

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepLib.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Line.hxx>
#include <Geom_Plane.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Precision.hxx>
#include <TopExp.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>
#include <gp_Pln.hxx>

#include <utility>

namespace badcad
{
namespace
{

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

/// A triangle with one edge more, from a corner to itself.
TopoDS_Wire withEdgeOfNoLength(const Corners& corners)
{
  const BRep_Builder builder;
  const TopoDS_Wire sound = polygon(corners, true);
  TopoDS_Wire wire = emptyWire();
  TopoDS_Vertex corner;
  for (TopoDS_Iterator edge(sound); edge.More(); edge.Next())
  {
    builder.Add(wire, edge.Value());
    corner = TopExp::FirstVertex(TopoDS::Edge(edge.Value()));
  }
  TopoDS_Edge edge;
  builder.MakeEdge(edge, new Geom_Line(BRep_Tool::Pnt(corner), gp::DX()), Precision::Confusion());
  builder.Range(edge, 0, 0);
  builder.Add(edge, corner.Oriented(TopAbs_FORWARD));
  builder.Add(edge, corner.Oriented(TopAbs_REVERSED));
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
    { "an edge of length zero", flatFace({ withEdgeOfNoLength(square) }) },
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

} // namespace badcad
