// Faces without edges: the whole of their surface.

#include "TestFiles.h"

#include <cadrefine/cad/import/CADFile.h>

#include <BRep_Builder.hxx>
#include <Geom_Plane.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SphericalSurface.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Face.hxx>
#include <gp_Pln.hxx>

#include <gtest/gtest.h>

namespace
{

using namespace cadrefine;

std::shared_ptr<const CADModel> modelOf(const Handle(Geom_Surface) & surface)
{
  TopoDS_Face face;
  BRep_Builder().MakeFace(face, surface, 1e-7);
  const cadtest::TemporaryFolder folder;
  cadtest::writeShape(face, folder.file("face.brep"));
  return readCADFile(folder.file("face.brep"));
}

TEST(NakedFaces, aSphereGetsItsSeam)
{
  const auto model = modelOf(new Geom_SphericalSurface(gp_Ax3(), 2));
  ASSERT_EQ(model->count(2), 1);
  EXPECT_EQ(model->count(1), 1);
  EXPECT_NEAR(model->nearest({ 3, 4, 0 }).distance, 3, 1e-9);
}

TEST(NakedFaces, aPatchGetsItsBorder)
{
  const Handle(Geom_Surface) plane = new Geom_Plane(gp_Pln());
  const auto model = modelOf(new Geom_RectangularTrimmedSurface(plane, 0.0, 1.0, 0.0, 1.0));
  ASSERT_EQ(model->count(2), 1);
  EXPECT_EQ(model->count(1), 4);
  EXPECT_EQ(model->count(0), 4);
  EXPECT_EQ(model->nearest({ 0.5, -1, 0 }).entity.dimension, 1);
  EXPECT_NEAR(model->nearest({ 0.5, -1, 0 }).distance, 1, 1e-9);
}

TEST(NakedFaces, anUnboundedOneIsListed)
{
  TopoDS_Compound both;
  BRep_Builder builder;
  builder.MakeCompound(both);
  TopoDS_Face plane, sphere;
  builder.MakeFace(plane, new Geom_Plane(gp_Pln()), 1e-7);
  builder.MakeFace(sphere, new Geom_SphericalSurface(gp_Ax3(), 2), 1e-7);
  builder.Add(both, plane);
  builder.Add(both, sphere);
  const cadtest::TemporaryFolder folder;
  cadtest::writeShape(both, folder.file("face.brep"));
  const auto model = readCADFile(folder.file("face.brep"));
  EXPECT_EQ(model->count(2), 1);
  ASSERT_EQ(model->unread().size(), 1u);
  EXPECT_EQ(model->unread()[0].entity, 1);
  EXPECT_EQ(model->unread()[0].reason, "is unbounded");
}

} // namespace
