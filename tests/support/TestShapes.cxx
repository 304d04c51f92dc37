#include "TestShapes.h"

#include <cadrefine/cad/import/CADFile.h>

#include <BRepAlgoAPI_BuilderAlgo.hxx>
#include <BRepAlgoAPI_Common.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <gp.hxx>
#include <gp_Ax2.hxx>
#include <gp_Ax3.hxx>
#include <gp_Circ.hxx>
#include <gp_Cone.hxx>
#include <gp_Cylinder.hxx>
#include <gp_Elips.hxx>
#include <gp_Pln.hxx>
#include <gp_Trsf.hxx>

#include <cmath>
#include <stdexcept>

namespace cadtest
{

TopoDS_Shape sphere(double radius)
{
  return BRepPrimAPI_MakeSphere(radius).Shape();
}

TopoDS_Shape torus(double majorRadius, double minorRadius)
{
  return BRepPrimAPI_MakeTorus(majorRadius, minorRadius).Shape();
}

TopoDS_Shape box(double x, double y, double z)
{
  return BRepPrimAPI_MakeBox(x, y, z).Shape();
}

TopoDS_Shape cylinder(double radius, double height)
{
  return BRepPrimAPI_MakeCylinder(radius, height).Shape();
}

TopoDS_Shape pipe(double innerRadius, double outerRadius, double height)
{
  return BRepAlgoAPI_Cut(cylinder(outerRadius, height), cylinder(innerRadius, height)).Shape();
}

TopoDS_Shape roundedCylinder(double radius, double height)
{
  return BRepAlgoAPI_Fuse(
    cylinder(radius, height), BRepPrimAPI_MakeSphere(gp_Pnt(0, 0, height), radius).Shape())
    .Shape();
}

TopoDS_Shape filletedDisc(double radius, double fillet)
{
  return BRepAlgoAPI_Fuse(
    torus(radius, fillet), moved(cylinder(radius, 2 * fillet), { 0, 0, -fillet }))
    .Shape();
}

TopoDS_Shape longCylinder(double radius, double height)
{
  const TopoDS_Shape half = cylinder(radius, height);
  return BRepAlgoAPI_Fuse(half, moved(half, { 0, 0, height })).Shape();
}

TopoDS_Shape halfPipe(double radius, double height)
{
  return BRepBuilderAPI_MakeFace(gp_Cylinder(gp_Ax3(), radius), 0, M_PI, 0, height).Shape();
}

TopoDS_Shape ellipticPipe(double halfLength, double halfHeight, double width)
{
  return BRepPrimAPI_MakePrism(ellipse(halfLength, halfHeight), gp_Vec(0, 0, width)).Shape();
}

TopoDS_Shape halfCone(double radius, double upperRadius, double height)
{
  const double angle = std::atan2(upperRadius - radius, height);
  return BRepBuilderAPI_MakeFace(
    gp_Cone(gp_Ax3(), angle, radius), 0, M_PI, 0, height / std::cos(angle))
    .Shape();
}

TopoDS_Shape discOfTwoArcs(double radius, double turn)
{
  const gp_Circ circle(gp_Ax2(), radius);
  return BRepBuilderAPI_MakeFace(
    BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(circle, turn, M_PI - turn),
      BRepBuilderAPI_MakeEdge(circle, M_PI - turn, 2 * M_PI + turn)))
    .Shape();
}

TopoDS_Shape partWithCavity()
{
  const TopoDS_Shape hole =
    BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(1.5, 1.5, 0), gp::DZ()), 0.2, 2).Shape();
  const TopoDS_Shape cavity = BRepPrimAPI_MakeSphere(gp_Pnt(0.7, 0.7, 1), 0.3).Shape();
  return BRepAlgoAPI_Cut(BRepAlgoAPI_Cut(box(2, 2, 2), hole).Shape(), cavity).Shape();
}

TopoDS_Shape moved(const TopoDS_Shape& shape, const cadrefine::Vector3& by)
{
  gp_Trsf move;
  move.SetTranslation({ by[0], by[1], by[2] });
  return BRepBuilderAPI_Transform(shape, move, true).Shape();
}

TopoDS_Shape scaled(const TopoDS_Shape& shape, double factor)
{
  gp_Trsf scale;
  scale.SetScale(gp::Origin(), factor);
  return BRepBuilderAPI_Transform(shape, scale, true).Shape();
}

TopoDS_Shape together(const TopoDS_Shape& a, const TopoDS_Shape& b)
{
  TopoDS_Compound both;
  BRep_Builder builder;
  builder.MakeCompound(both);
  builder.Add(both, a);
  builder.Add(both, b);
  return both;
}

TopoDS_Shape circle(double radius)
{
  return BRepBuilderAPI_MakeEdge(gp_Circ(gp_Ax2(), radius)).Shape();
}

TopoDS_Shape ellipse(double longRadius, double shortRadius)
{
  return BRepBuilderAPI_MakeEdge(gp_Elips(gp_Ax2(), longRadius, shortRadius)).Shape();
}

TopoDS_Shape rectangle(double x, double y)
{
  return BRepBuilderAPI_MakeFace(gp_Pln(), 0, x, 0, y).Shape();
}

TopoDS_Shape cone(double radius, double height)
{
  return BRepPrimAPI_MakeCone(radius, 0, height).Shape();
}

TopoDS_Shape doubleCone(double radius, double height, double depth)
{
  const gp_Ax2 downward(gp::Origin(), gp::DZ().Reversed(), gp::DX());
  return BRepAlgoAPI_Fuse(
    cone(radius, height), BRepPrimAPI_MakeCone(downward, radius, 0, depth).Shape())
    .Shape();
}

TopoDS_Shape boxWithoutCorner(double x, double y, double z, double radius)
{
  return BRepAlgoAPI_Cut(box(x, y, z), sphere(radius)).Shape();
}

TopoDS_Shape eighthOfShell(double innerRadius, double outerRadius)
{
  return BRepAlgoAPI_Common(
    boxWithoutCorner(outerRadius, outerRadius, outerRadius, innerRadius), sphere(outerRadius))
    .Shape();
}

TopoDS_Shape cubesAtAnEdge()
{
  const TopoDS_Shape other = BRepPrimAPI_MakeBox(gp_Pnt(1, 1, 0), 1, 1, 1).Shape();
  return BRepAlgoAPI_Fuse(box(1, 1, 1), other).Shape();
}

TopoDS_Shape threeSheets()
{
  BRepAlgoAPI_BuilderAlgo together;
  TopTools_ListOfShape sheets;
  for (int s = 0; s < 3; ++s)
  {
    gp_Ax3 axes(gp::Origin(), gp::DY().Reversed(), gp::DX()); // x outward, y along the edge
    axes.Rotate(gp::OZ(), 2 * M_PI * s / 3);
    sheets.Append(BRepBuilderAPI_MakeFace(gp_Pln(axes), 0, 1, 0, 1).Shape());
  }
  together.SetArguments(sheets);
  together.Build();
  return together.Shape();
}

TopoDS_Shape readShape(const std::string& path)
{
  TopoDS_Shape shape;
  if (!BRepTools::Read(shape, path.c_str(), BRep_Builder()))
  {
    throw std::runtime_error("cannot read " + path);
  }
  return shape;
}

std::string writeInto(
  const TemporaryFolder& folder, const TopoDS_Shape& shape, const std::string& extension)
{
  Message::DefaultMessenger()->ChangePrinters().Clear(); // Open CASCADE reports every file
  std::string path = folder.file("shape" + extension);
  writeShape(shape, path);
  return path;
}

std::shared_ptr<const cadrefine::CADModel> modelOf(
  const TopoDS_Shape& shape, const std::string& extension)
{
  const TemporaryFolder folder;
  return cadrefine::readCADFile(writeInto(folder, shape, extension));
}

} // namespace cadtest
