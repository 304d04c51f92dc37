// Triangles in space and points alone, on a sphere.

#include "DataSets.h"
#include "FilterRun.h"
#include "MeshChecks.h"
#include "TestMeshes.h"
#include "TestShapes.h"

#include <gtest/gtest.h>
#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <cmath>

namespace
{

using namespace cadrefine;

constexpr double pi = 3.14159265358979323846;
constexpr double radius = 2;

class SphereSurface : public testing::Test
{
protected:
  cadtest::TemporaryFolder folder;
  cadtest::FilterRun filters{ cadtest::writeInto(folder, cadtest::sphere(radius), ".step") };
};

TEST_F(SphereSurface, ofPolyDataConvergesAtSecondOrder)
{
  cadtest::FilterRun::Data data =
    filters.project(cadtest::toPolyData(cadtest::sphereMesh(radius, 0.03)));
  double before = 0;
  for (int level = 0; level < 5; ++level)
  {
    ASSERT_NE(vtkPolyData::SafeDownCast(data), nullptr);
    const Mesh mesh = cadtest::toMesh(data);
    EXPECT_EQ(mesh.triangles.size(), 20u << (2 * level));
    EXPECT_EQ(cadtest::countOuterSides(mesh), 0u) << "the surface is closed";
    EXPECT_EQ(cadtest::fieldValue(data, "InvalidCells"), 0);
    for (const Point3& point : mesh.points)
    {
      EXPECT_NEAR(norm(point), radius, 1e-12 * 2 * radius);
    }
    const double deficit = 4.0 / 3.0 * pi * 8 - cadtest::volumeInside(mesh);
    if (level > 1)
    {
      EXPECT_NEAR(std::log2(before / deficit), 2, 0.2);
    }
    before = deficit;
    data = filters.refineUniformly(data);
  }
}

/// The section of a mesh that cuts its noses off: no vertex is within 0.025 of their tips.
TEST(NoseSurface, isFilledInRefinement)
{
  constexpr double height = 0.06;
  const cadtest::TemporaryFolder folder;
  const cadtest::FilterRun filters(
    cadtest::writeInto(folder, cadtest::ellipticPipe(1, height, 1), ".brep"));
  Mesh mesh;
  mesh.dimension = 2;
  std::vector<double> angles{ 0.21 };
  while (angles.back() < pi - 0.41)
  {
    angles.push_back(angles.back() + (pi - 0.42) / 8);
  }
  const std::size_t upper = angles.size();
  for (std::size_t k = 0; k < upper; ++k)
  {
    angles.push_back(angles[k] + pi);
  }
  const auto around = static_cast<Index>(angles.size());
  constexpr Index rows = 5;
  for (Index row = 0; row < rows; ++row)
  {
    for (const double angle : angles)
    {
      mesh.ids.push_back(static_cast<GlobalId>(mesh.points.size()));
      mesh.points.push_back({ std::cos(angle), height * std::sin(angle), 1.0 * row / (rows - 1) });
    }
  }
  for (Index row = 0; row + 1 < rows; ++row)
  {
    for (Index k = 0; k < around; ++k)
    {
      const Index a = row * around + k;
      const Index b = row * around + (k + 1) % around;
      mesh.triangles.push_back({ a, b, b + around });
      mesh.triangles.push_back({ a, b + around, a + around });
    }
  }
  cadtest::FilterRun::Data data = filters.project(cadtest::toPolyData(mesh));
  const auto errorOf = [&](vtkPointSet* of)
  { return cadtest::fieldValue(filters.measure(of, 2), "GlobalGeometricError"); };
  const double first = errorOf(data);
  EXPECT_GT(
    cadtest::fieldValue(filters.measure(data, 2), "MaximumGeometricDistance"), 0.02); // of the tips
  for (int level = 0; level < 3; ++level)
  {
    data = filters.refineUniformly(data);
  }
  EXPECT_EQ(cadtest::fieldValue(data, "UnprojectedVertices"), 0);
  EXPECT_EQ(cadtest::fieldValue(data, "InvalidCells"), 0);
  EXPECT_LT(errorOf(data), first / 25);
  EXPECT_LT(cadtest::fieldValue(filters.measure(data, 2), "MaximumGeometricDistance"), 3e-3);
}

TEST_F(SphereSurface, hasTheErrorOfTheVolumeBelowIt)
{
  const auto mesh = cadtest::toPolyData(cadtest::sphereMesh(radius, 0));
  const auto data = filters.measure(filters.project(mesh), 4);
  const double deficit =
    4.0 / 3.0 * pi * 8 - cadtest::volumeInside(cadtest::toMesh(filters.project(mesh)));
  EXPECT_NEAR(cadtest::fieldValue(data, "GlobalGeometricError"), deficit, 0.01 * deficit);
}

TEST_F(SphereSurface, isRefinedLocally)
{
  cadtest::FilterRun::Data data =
    filters.project(cadtest::toPolyData(cadtest::sphereMesh(radius, 0.03)));
  for (int step = 0; step < 4; ++step)
  {
    data = filters.refineWhereErrorExceeds(filters.measure(data, 1), 1e-2);
  }
  const Mesh mesh = cadtest::toMesh(data);
  EXPECT_GT(mesh.triangles.size(), 40u);
  EXPECT_EQ(cadtest::countOuterSides(mesh), 0u);
  EXPECT_TRUE(cadtest::hasNoHangingVertex(mesh));
}

/// Points without cells, and points with vertex cells.
TEST_F(SphereSurface, takesPointClouds)
{
  for (const bool withCells : { false, true })
  {
    const Mesh cloud = cadtest::cubeMesh(3, 0.2, 1);
    vtkNew<vtkPolyData> points;
    points->SetPoints(cadtest::toGrid(cloud)->GetPoints());
    vtkNew<vtkCellArray> vertices;
    for (vtkIdType p = 0; withCells && p < points->GetNumberOfPoints(); ++p)
    {
      vertices->InsertNextCell({ p });
    }
    points->SetVerts(vertices);
    const auto data = filters.project(points);
    ASSERT_EQ(data->GetNumberOfPoints(), points->GetNumberOfPoints());
    for (vtkIdType p = 0; p < data->GetNumberOfPoints(); ++p)
    {
      const Point3& before = cloud.points[p];
      Point3 after;
      data->GetPoint(p, after.data());
      EXPECT_NEAR(norm(after), radius, 1e-12 * 2 * radius);
      if (norm(before) > 0)
      {
        EXPECT_LT(distance(after, (radius / norm(before)) * before), 1e-7);
      }
    }
    EXPECT_EQ(cadtest::fieldValue(data, "ProjectedPoints"), 64);
    EXPECT_EQ(cadtest::fieldValue(data, "UnprojectedVertices"), 0);
  }
}

TEST_F(SphereSurface, leavesPointsBeyondTheMaximumDistance)
{
  const auto grid = cadtest::toGrid(cadtest::cubeMesh(3, 0, 1));
  vtkNew<vtkUnstructuredGrid> points;
  points->SetPoints(grid->GetPoints());
  const auto data = filters.run<vtkProjectOntoCAD>(
    points, [](vtkProjectOntoCAD* filter) { filter->SetMaximumDistance(1); });
  vtkDataArray* dimensions = data->GetPointData()->GetArray("CADDimension");
  ASSERT_NE(dimensions, nullptr);
  for (vtkIdType p = 0; p < data->GetNumberOfPoints(); ++p)
  {
    Point3 before;
    Point3 after;
    grid->GetPoint(p, before.data());
    data->GetPoint(p, after.data());
    const bool isNear = radius - norm(before) <= 1;
    EXPECT_EQ(dimensions->GetTuple1(p) >= 0, isNear);
    EXPECT_EQ(after == before, !isNear);
  }
}

} // namespace
