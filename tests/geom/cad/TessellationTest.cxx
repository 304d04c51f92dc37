// Drawings of single entities.

#include "CADFile.h"
#include "Error.h"
#include "TestFiles.h"

#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>

#include <gtest/gtest.h>

namespace
{

using namespace cadrefine;

std::shared_ptr<const CADModel> readShape(const TopoDS_Shape& shape)
{
  const cadtest::TemporaryFolder folder;
  cadtest::writeShape(shape, folder.file("shape.brep"));
  return readCADFile(folder.file("shape.brep"));
}

double volumeInside(const Tessellation& mesh)
{
  double volume = 0;
  for (const auto& [a, b, c] : mesh.triangles)
  {
    volume += dot(mesh.points[a], cross(mesh.points[b], mesh.points[c])) / 6;
  }
  return volume;
}

TEST(Tessellation, FollowsASphereOutward)
{
  const auto model = readShape(BRepPrimAPI_MakeSphere(2).Shape());
  const Tessellation mesh = model->tessellate({ 2, 0 }, 1e-3);
  EXPECT_NEAR(volumeInside(mesh), 4.0 / 3 * M_PI * 8, 0.1);
  ASSERT_EQ(mesh.normals.size(), mesh.points.size());
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
  {
    EXPECT_NEAR(norm(mesh.points[i]), 2, 1e-9);
    const bool pole = norm(mesh.normals[i]) == 0;
    EXPECT_TRUE(pole || distance(2.0 * mesh.normals[i], mesh.points[i]) < 1e-6);
  }
}

TEST(Tessellation, DoesNotDependOnWhatWasDrawnBefore)
{
  const auto model = readShape(BRepPrimAPI_MakeCylinder(1, 2).Shape());
  const Tessellation before = model->tessellate({ 2, 0 }, 1e-2);
  model->tessellate({ 2, 1 }, 1e-4);
  model->tessellate({ 1, 0 }, 1e-4);
  const Tessellation after = model->tessellate({ 2, 0 }, 1e-2);
  EXPECT_EQ(before.points, after.points);
  EXPECT_EQ(before.triangles, after.triangles);
}

TEST(Tessellation, DrawsEdgesAndNothingForVertices)
{
  const auto model = readShape(BRepPrimAPI_MakeCylinder(1, 2).Shape());
  for (int e = 0; e < model->count(1); ++e)
  {
    const Tessellation drawing = model->tessellate({ 1, e }, 1e-3);
    EXPECT_EQ(drawing.line.size(), drawing.points.size());
    EXPECT_GE(drawing.points.size(), 2u);
    for (const Point3& p : drawing.points)
    {
      EXPECT_NEAR(std::hypot(p[0], p[1]), 1, 1e-9);
    }
  }
  EXPECT_TRUE(model->tessellate({ 0, 0 }, 1e-3).points.empty());
}

TEST(Tessellation, RefusesWhatIsNotThere)
{
  const auto model = readShape(BRepPrimAPI_MakeCylinder(1, 2).Shape());
  EXPECT_THROW(model->tessellate({ 2, 3 }, 1e-3), Error);
  EXPECT_THROW(model->tessellate({ 2, -1 }, 1e-3), Error);
  EXPECT_THROW(model->tessellate({ 3, 0 }, 1e-3), Error);
  EXPECT_THROW(model->tessellate({ 2, 0 }, 0), Error);
}

} // namespace
