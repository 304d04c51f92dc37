// The bundled aeroplane: patches side by side in the file, one closed solid after sewing.

#include <cadrefine/cad/extraction/ShapeIndex.h>
#include <cadrefine/cad/import/CADFile.h>
#include <cadrefine/cad/model/ModelBytes.h>

#include <BRepCheck_Analyzer.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepGProp.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <TopExp_Explorer.hxx>

#include <gtest/gtest.h>

#include <algorithm>

namespace
{

using namespace cadrefine;

const CADModel& aeroplane()
{
  static const auto model = readCADFile(CADREFINE_DATA "/aeroplane.igs");
  return *model;
}

const TopoDS_Shape& shape()
{
  static const TopoDS_Shape all = decodeModel(aeroplane().toBytes()).shape;
  return all;
}

double length(const TopoDS_Edge& edge)
{
  GProp_GProps properties;
  BRepGProp::LinearProperties(edge, properties);
  return properties.Mass();
}

TEST(Aeroplane, isReadWholeAsOneClosedShell)
{
  EXPECT_EQ(aeroplane().count(2), 962);
  EXPECT_EQ(aeroplane().unit(), "m");
  EXPECT_TRUE(aeroplane().unread().empty());
  int shells = 0;
  for (TopExp_Explorer shell(shape(), TopAbs_SHELL); shell.More(); shell.Next())
  {
    ++shells;
    EXPECT_TRUE(BRep_Tool::IsClosed(shell.Current()));
  }
  EXPECT_EQ(shells, 1);
  EXPECT_TRUE(BRepCheck_Analyzer(shape()).IsValid());
  for (const NurbsEdge& edge : aeroplane().nurbs().edges)
  {
    EXPECT_EQ(edge.faces.size(), 2U);
    EXPECT_LE(edge.tolerance, 1e-6);
  }
  const ShapeIndex index(shape());
  for (const TopoDS_Edge& edge : index.edges())
  {
    EXPECT_GT(length(edge), 0.002);
  }
}

TEST(Aeroplane, isSymmetricWithThePartsInPlace)
{
  GProp_GProps volume;
  BRepGProp::VolumeProperties(shape(), volume);
  EXPECT_NEAR(volume.CentreOfMass().Y(), 0, 1e-6);
  EXPECT_NEAR(volume.Mass(), 0.0875, 0.0005);
  const auto isOn = [](const Point3& p) { return aeroplane().nearest(p).distance < 1e-6; };
  EXPECT_TRUE(isOn({ 0, 0, -0.03 })) << "nose";
  EXPECT_TRUE(isOn({ 2, 0, 0.06 })) << "tail";
  EXPECT_TRUE(isOn({ 0.24502852, 0, 0.14781476 })) << "canopy";
  EXPECT_TRUE(isOn({ 1.739, 0, 0.45 })) << "fin";
  for (const double side : { -1.0, 1.0 })
  {
    EXPECT_TRUE(isOn({ 0.83, side * 0.365, -0.14 })) << "spinner of the nacelle";
    EXPECT_TRUE(isOn({ 1.06, side * 0.365, -0.14 })) << "plug of the nacelle";
  }
}

TEST(Aeroplane, noseHas52Faces)
{
  const TopoDS_Shape nose =
    BRepPrimAPI_MakeBox(gp_Pnt(0.05, -0.25, -0.2), gp_Pnt(0.2, 0.25, 0.2)).Shape();
  const ShapeIndex index(shape());
  const auto count = std::count_if(index.faces().begin(), index.faces().end(),
    [&](const TopoDS_Face& face)
    { return BRepExtrema_DistShapeShape(face, nose).Value() <= 1e-9; });
  EXPECT_EQ(count, 52);
}

TEST(Aeroplane, trailingEdgesAreCreasesAndPatchLinesAreNot)
{
  const auto sharp = [](const Point3& p)
  {
    const ClosestPoint hit = aeroplane().nearest(p);
    EXPECT_EQ(hit.entity.dimension, 1);
    EXPECT_LT(hit.distance, 1e-4);
    return hit.entity.dimension == 1 && aeroplane().nurbs().edges[hit.entity.index].sharp;
  };
  const double y = 0.7;
  const double chord = 0.34 - 0.3 * y + 0.085 * y * y;
  EXPECT_TRUE(
    sharp({ 0.78 + 0.38 * y + 0.06 * y * y + chord, y, -0.065 + 0.06 * y + 0.035 * y * y }));
  EXPECT_FALSE(sharp({ 0.575, 0, 0.132 })) << "crown of the fuselage";
}

} // namespace
