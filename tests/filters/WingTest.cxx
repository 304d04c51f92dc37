// The NACA 0012 section in its box of coarse tetrahedra.

#include "DataSets.h"
#include "FilterRun.h"
#include "MeshChecks.h"

#include <gtest/gtest.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <set>

namespace
{

using namespace cadrefine;

class Wing : public testing::TestWithParam<const char*>
{
protected:
  cadtest::FilterRun filters{ CADREFINE_DATA "/naca0012_" + std::string(GetParam()) + ".igs" };
  vtkSmartPointer<vtkUnstructuredGrid> coarse = cadtest::readGrid(
    std::string(CADREFINE_DATA) +
    (GetParam() == std::string("blunt") ? "/naca0012_blunt_coarse.vtu" : "/naca0012_coarse.vtu"));

  static double error(const cadtest::FilterRun::Data& data)
  {
    return cadtest::fieldValue(data, "GlobalGeometricError");
  }

  static void expectValid(const cadtest::FilterRun::Data& data)
  {
    EXPECT_TRUE(cadtest::isValid(cadtest::toMesh(data)));
    EXPECT_EQ(cadtest::fieldValue(data, "InvalidCells"), 0);
  }
};

INSTANTIATE_TEST_SUITE_P(TrailingEdges, Wing, testing::Values("sharp", "blunt"),
  [](const auto& edge) { return std::string(edge.param); });

/// Three uniform levels, and then six longest edge steps of the cells with a local error above
/// 1e-7.
TEST_P(Wing, errorFallsByFourAndNeverRises)
{
  auto data = filters.measure(filters.project(coarse), 1);
  expectValid(data);
  double before = error(data);
  EXPECT_GT(before, 0);
  double factor = 0;
  for (int level = 1; level <= 3; ++level)
  {
    data = filters.measure(filters.refineUniformly(data), 1);
    expectValid(data);
    EXPECT_GT(before / error(data), std::max(factor, 3.0)) << "it approaches 4, level " << level;
    factor = before / error(data);
    before = error(data);
  }
  EXPECT_GT(factor, 3.6) << "the section is resolved";
  EXPECT_LT(factor, 4.4);
  for (int step = 1; step <= 6; ++step)
  {
    data = filters.measure(filters.refineWhereErrorExceeds(data, 1e-7), 1);
    expectValid(data);
    EXPECT_LE(error(data), before) << "step " << step;
    before = error(data);
  }
  EXPECT_TRUE(cadtest::hasNoHangingVertex(cadtest::toMesh(data)));
}

TEST_P(Wing, everyVertexOnTheCadIsThere)
{
  const auto data = filters.refineUniformly(filters.project(coarse), 2);
  EXPECT_EQ(cadtest::fieldValue(data, "UnprojectedVertices"), 0);
  const auto again = filters.project(data);
  const Mesh mesh = cadtest::toMesh(data);
  const Mesh projected = cadtest::toMesh(again);
  ASSERT_EQ(mesh.points.size(), projected.points.size());
  double farthest = 0;
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
  {
    farthest = std::max(farthest, distance(mesh.points[v], projected.points[v]));
  }
  EXPECT_LE(farthest, 1e-12 * 3) << "a second projection finds nothing left to do";
}

/// Edges and faces are swapped, and vertices moved, where new cells are poor; none is taken back.
TEST_P(Wing, fewCellsArePoor)
{
  const auto data = filters.refineUniformly(filters.project(coarse), 2);
  EXPECT_GT(cadtest::fieldValue(data, "GlobalCells"),
    0.98 * 64 * static_cast<double>(coarse->GetNumberOfCells()));
  EXPECT_GE(filters.qualityPercentile(data, 0.08), 0.3);
}

/// Straight refinement leaves the gap between mesh and CAD as it is.
TEST_P(Wing, errorStaysWithoutProjection)
{
  auto data = filters.project(coarse);
  const double before = error(filters.measure(data, 5));
  for (int level = 1; level <= 2; ++level)
  {
    data = filters.refineStraight(data);
    EXPECT_NEAR(error(filters.measure(data, 5 - level)), before, 0.01 * before);
    expectValid(data);
  }
}

TEST_P(Wing, wallsAndFarFieldStay)
{
  const Mesh before = cadtest::toMesh(coarse);
  const Mesh after = cadtest::toMesh(filters.moveOntoCAD(coarse));
  ASSERT_EQ(before.points.size(), after.points.size());
  for (std::size_t v = 0; v < before.points.size(); ++v)
  {
    EXPECT_NEAR(before.points[v][1], after.points[v][1], 1e-12) << "it left its wall";
    if (before.points[v][0] < -0.5 || before.points[v][0] > 3.5)
    {
      EXPECT_EQ(before.points[v], after.points[v]) << "far field";
    }
  }
}

/// Also where cells are exchanged for others, and its edges halved.
TEST_P(Wing, operationsKeepVerticesAndShapeOfTheFarField)
{
  const auto farAway = [](const Mesh& mesh)
  {
    std::set<Point3> points;
    for (const Index v : cadtest::outerVertices(mesh))
    {
      if (mesh.points[v][0] < -0.5 || mesh.points[v][0] > 3.5)
      {
        points.insert(mesh.points[v]);
      }
    }
    return points;
  };
  const Mesh before = cadtest::toMesh(coarse);
  const Mesh after = cadtest::toMesh(filters.run<vtkProjectOntoCAD>(
    coarse, [](vtkProjectOntoCAD* filter) { filter->SetMinimumQuality(0.3); }));
  EXPECT_NE(before.tetrahedra.size(), after.tetrahedra.size());
  EXPECT_GT(farAway(before).size(), 8U);
  const auto left = farAway(after);
  for (const Point3& point : farAway(before))
  {
    EXPECT_EQ(left.count(point), 1U) << point[0] << " " << point[1] << " " << point[2];
  }
  double box[6];
  coarse->GetBounds(box);
  for (const Point3& point : left)
  {
    EXPECT_TRUE(point[0] == box[0] || point[0] == box[1] || point[1] == box[2] ||
                point[1] == box[3] || point[2] == box[4] || point[2] == box[5])
      << point[0] << " " << point[1] << " " << point[2];
  }
}

TEST_P(Wing, projectionIsLimitedToItsRegion)
{
  const auto data = filters.run<vtkProjectOntoCAD>(coarse,
    [](vtkProjectOntoCAD* filter)
    {
      filter->UseRegionOn();
      filter->SetRegion(-1, 1.5, -1, 5, -1, 1);
    });
  const Mesh before = cadtest::toMesh(coarse);
  const Mesh after = cadtest::toMesh(data);
  std::size_t moved = 0;
  for (std::size_t v = 0; v < before.points.size(); ++v)
  {
    moved += before.points[v] != after.points[v];
    EXPECT_TRUE(before.points[v][0] <= 1.5 || before.points[v] == after.points[v]);
  }
  EXPECT_GT(moved, 5u);
}

} // namespace
