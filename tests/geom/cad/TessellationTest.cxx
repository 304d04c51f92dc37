// Drawings of models.

#include "TestFiles.h"

#include <cadrefine/base/Error.h>
#include <cadrefine/cad/import/CADFile.h>
#include <cadrefine/cad/model/ModelDrawing.h>

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>

#include <gtest/gtest.h>

#include <set>

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

void expectSame(const Tessellation& a, const Tessellation& b)
{
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.normals, b.normals);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.line, b.line);
}

TEST(Tessellation, followsASphereOutward)
{
  const auto model = readShape(BRepPrimAPI_MakeSphere(2).Shape());
  const Tessellation mesh = drawModel(*model, 1e-3).faces.at(0);
  EXPECT_NEAR(volumeInside(mesh), 4.0 / 3 * M_PI * 8, 0.1);
  ASSERT_EQ(mesh.normals.size(), mesh.points.size());
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
  {
    EXPECT_NEAR(norm(mesh.points[i]), 2, 1e-9);
    EXPECT_LT(distance(2.0 * mesh.normals[i], mesh.points[i]), 1e-5) << "also at the poles";
  }
}

TEST(Tessellation, drawsEdges)
{
  const auto model = readShape(BRepPrimAPI_MakeCylinder(1, 2).Shape());
  for (const Tessellation& drawing : drawModel(*model, 1e-3).edges)
  {
    EXPECT_EQ(drawing.line.size(), drawing.points.size());
    EXPECT_EQ(drawing.normals.size(), drawing.points.size());
    EXPECT_GE(drawing.points.size(), 2u);
    for (const Point3& p : drawing.points)
    {
      EXPECT_NEAR(std::hypot(p[0], p[1]), 1, 1e-9);
    }
  }
}

TEST(Tessellation, ofAWholeModelIsTheSameOnAnyNumberOfThreads)
{
  const auto model = readShape(BRepPrimAPI_MakeCylinder(1, 2).Shape());
  const ModelDrawing drawing = drawModel(*model, 1e-3, {}, 3);
  EXPECT_TRUE(drawing.undrawn.empty());
  const ModelDrawing onOne = drawModel(*model, 1e-3, {}, 1);
  ASSERT_EQ(drawing.faces.size(), 3u);
  for (int f = 0; f < 3; ++f)
  {
    expectSame(drawing.faces[f], onOne.faces[f]);
  }
  ASSERT_EQ(drawing.edges.size(), static_cast<std::size_t>(model->count(1)));
  for (int e = 0; e < model->count(1); ++e)
  {
    expectSame(drawing.edges[e], onOne.edges[e]);
  }
  EXPECT_THROW(drawModel(*model, 0), Error);
}

TEST(Tessellation, ofAShareHasItsFacesItsEdgesAndOneAtEachOfItsVertices)
{
  const auto model = readShape(BRepPrimAPI_MakeBox(1, 2, 3).Shape());
  const ModelDrawing whole = drawModel(*model, 1e-3);
  const DrawingShare share{ 1, 5 };
  const ModelDrawing part = drawModel(*model, 1e-3, share);
  ASSERT_EQ(part.faces.size(), 6u);
  for (int f = 0; f < 6; ++f)
  {
    expectSame(part.faces[f], share.has(f) ? whole.faces[f] : Tessellation());
  }
  ASSERT_EQ(part.edges.size(), 12u);
  std::set<int> edges;
  for (int i = 1; i < 12; i += 5)
  {
    edges.insert(i);
    if (i < model->count(0))
    {
      edges.insert(model->nurbs().vertices[i].edges.front());
    }
  }
  for (int e = 0; e < 12; ++e)
  {
    expectSame(part.edges[e], edges.count(e) > 0 ? whole.edges[e] : Tessellation());
  }
}

} // namespace
