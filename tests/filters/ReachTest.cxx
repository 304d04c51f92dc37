// How far a boundary may be from the CAD.

#include "DataSets.h"
#include "FilterRun.h"
#include "TestMeshes.h"
#include "TestShapes.h"

#include <vtkUnstructuredGrid.h>

#include <gtest/gtest.h>

namespace
{

using namespace cadtest;

constexpr double radius = 2;

/// With edges of 0.5 or less, which is why its vertices look no farther.
vtkSmartPointer<vtkPointSet> fineBall(const FilterRun& filters)
{
  return filters.refineUniformly(filters.project(toGrid(ballMesh(radius, 0.0))), 2);
}

void scale(vtkPointSet* mesh, double factor)
{
  for (vtkIdType p = 0; p < mesh->GetNumberOfPoints(); ++p)
  {
    double point[3];
    mesh->GetPoint(p, point);
    mesh->GetPoints()->SetPoint(p, factor * point[0], factor * point[1], factor * point[2]);
  }
}

double projectedOf(const FilterRun& filters, vtkPointSet* mesh, double maximumDistance)
{
  const auto projected = filters.run<vtkProjectOntoCAD>(
    mesh, [&](vtkProjectOntoCAD* filter) { filter->SetMaximumDistance(maximumDistance); });
  return fieldValue(projected, "CADVertices");
}

TEST(Reach, aGivenDistanceReachesFartherThanFacetsDo)
{
  const TemporaryFolder folder;
  const FilterRun filters(writeInto(folder, sphere(radius), ".step"));
  const auto mesh = fineBall(filters);
  const double all = fieldValue(mesh, "CADVertices");
  scale(mesh, 1.4);
  EXPECT_THROW(projectedOf(filters, mesh, 0), std::runtime_error);
  EXPECT_THROW(projectedOf(filters, mesh, 0.79), std::runtime_error);
  EXPECT_EQ(projectedOf(filters, mesh, 0.81), all);
}

TEST(Reach, aMeshElsewhereIsToldOf)
{
  const TemporaryFolder folder;
  const FilterRun filters(writeInto(folder, sphere(radius), ".step"));
  const auto mesh = fineBall(filters);
  scale(mesh, 1000);
  const Outcome outcome = filters.attempt<vtkProjectOntoCAD>(mesh, [](vtkProjectOntoCAD*) {});
  EXPECT_FALSE(outcome.succeeded);
  ASSERT_EQ(outcome.errors.size(), 1u);
  EXPECT_NE(outcome.errors[0].find("no vertex could be projected onto the CAD"), std::string::npos)
    << outcome.errors[0];
}

} // namespace
