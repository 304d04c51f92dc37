// Boundary vertices that cannot reach the CAD at once: no cell inverts, whatever happens.

#include "DataSets.h"
#include "FilterRun.h"
#include "MeshChecks.h"
#include "TestMeshes.h"
#include "TestShapes.h"

#include <gtest/gtest.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>

namespace
{

using namespace cadrefine;

constexpr double radius = 2;

class CrowdedBall : public testing::Test
{
protected:
  cadtest::TemporaryFolder folder;
  cadtest::FilterRun filters{ cadtest::writeInto(folder, cadtest::sphere(radius), ".step") };
  SimplexMesh mesh = cadtest::crowdedBallMesh(radius);
};

/// The premise of the other tests.
TEST_F(CrowdedBall, wouldInvertACell)
{
  EXPECT_TRUE(cadtest::isValid(mesh));
  for (Index v = 0; v < 12; ++v)
  {
    mesh.points[v] = radius * normalized(mesh.points[v]);
  }
  EXPECT_FALSE(cadtest::isValid(mesh));
}

TEST_F(CrowdedBall, isProjectedByMovingTheInnerVertex)
{
  const auto data = filters.project(cadtest::toGrid(mesh));
  EXPECT_TRUE(cadtest::isValid(cadtest::toMesh(data)));
  EXPECT_EQ(cadtest::fieldValue(data, "UnprojectedVertices"), 0);
  EXPECT_NE(cadtest::toMesh(data).points[12], mesh.points[12]);
}

/// One tetrahedron whose apex would pass through the opposite side: nothing can make way, so that
/// vertices stop and tell how far they still are.
TEST_F(CrowdedBall, keepsDistancesWhereNothingMakesWay)
{
  SimplexMesh thin = cadtest::oneTetrahedron(
    { { { 1.9, 0, 0 }, { 1.95, 0.6, 0 }, { 1.95, -0.3, 0.5 }, { 1.95, -0.3, -0.5 } } });
  if (!cadtest::isValid(thin))
  {
    std::swap(thin.tetrahedra[0][0], thin.tetrahedra[0][1]);
  }
  const auto data = filters.project(cadtest::toGrid(thin));
  const SimplexMesh after = cadtest::toMesh(data);
  EXPECT_TRUE(cadtest::isValid(after));
  vtkDataArray* distances = data->GetPointData()->GetArray("CADDistance");
  vtkDataArray* dimensions = data->GetPointData()->GetArray("CADDimension");
  int unprojected = 0;
  for (vtkIdType p = 0; p < 4; ++p)
  {
    if (dimensions->GetTuple1(p) >= 0)
    {
      EXPECT_NEAR(distances->GetTuple1(p), std::abs(norm(after.points[p]) - radius), 1e-12);
    }
    unprojected += distances->GetTuple1(p) > 0;
  }
  EXPECT_GT(unprojected, 0);
  EXPECT_EQ(cadtest::fieldValue(data, "UnprojectedVertices"), unprojected);
}

TEST_F(CrowdedBall, staysValidThroughRefinement)
{
  auto data = filters.project(cadtest::toGrid(mesh));
  for (int level = 0; level < 3; ++level)
  {
    data = filters.refineUniformly(data);
    EXPECT_TRUE(cadtest::isValid(cadtest::toMesh(data)));
    EXPECT_EQ(cadtest::fieldValue(data, "InvalidCells"), 0);
  }
  EXPECT_EQ(cadtest::fieldValue(data, "UnprojectedVertices"), 0);
}

} // namespace
