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
  Mesh mesh = cadtest::crowdedBallMesh(radius);
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

/// One tetrahedron whose four corners belong onto one plane: however they slide there, it has no
/// volume, so that vertices stop and tell how far they still are.
TEST_F(CrowdedBall, keepsDistancesWhereNothingMakesWay)
{
  const Mesh thin = cadtest::oneTetrahedron(
    { { { 1, 1, 0.02 }, { 2, 1, 0.03 }, { 1.3, 1.9, 0.02 }, { 1.4, 1.3, 0.25 } } });
  ASSERT_TRUE(cadtest::isValid(thin));
  cadtest::TemporaryFolder folderOfBox;
  const cadtest::FilterRun box(cadtest::writeInto(folderOfBox, cadtest::box(4, 4, 4), ".step"));
  const auto data = box.project(cadtest::toGrid(thin));
  const Mesh after = cadtest::toMesh(data);
  EXPECT_TRUE(cadtest::isValid(after));
  vtkDataArray* distances = data->GetPointData()->GetArray("CADDistance");
  vtkDataArray* dimensions = data->GetPointData()->GetArray("CADDimension");
  int unprojected = 0;
  for (vtkIdType p = 0; p < 4; ++p)
  {
    EXPECT_EQ(dimensions->GetTuple1(p), 2);
    EXPECT_NEAR(distances->GetTuple1(p), after.points[p][2], 1e-12);
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
