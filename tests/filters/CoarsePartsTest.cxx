// Meshes that are coarser than narrow faces of their CAD: all vertices reach it, in cells of some
// shape.

#include "DataSets.h"
#include "FilterRun.h"
#include "MeshChecks.h"
#include "TestMeshes.h"
#include "TestShapes.h"

#include <vtkUnstructuredGrid.h>

#include <gtest/gtest.h>

namespace
{

using namespace cadrefine;
using namespace cadtest;

constexpr const char* crankArm = "/usr/share/opencascade/data/occ/CrankArm.brep";

void expectAllOnCAD(vtkPointSet* mesh, double leastQuality)
{
  EXPECT_EQ(fieldValue(mesh, "UnprojectedVertices"), 0);
  EXPECT_EQ(fieldValue(mesh, "InvalidCells"), 0);
  EXPECT_GE(fieldValue(mesh, "MinimumQuality"), leastQuality);
}

/// With chamfers that are narrower than the arcs along them are high over their mesh edges.
TEST(CoarseParts, reachTheCADUnderUniformRefinement)
{
  const FilterRun filters(crankArm);
  FilterRun::Data mesh = filters.project(readGrid(CADREFINE_TRUTH "/crank_arm_coarse.vtu"));
  expectAllOnCAD(mesh, 0.09);
  for (int level = 0; level < 2; ++level)
  {
    const double cells = fieldValue(mesh, "GlobalCells");
    mesh = filters.refineUniformly(mesh);
    expectAllOnCAD(mesh, 0.09);
    EXPECT_NEAR(fieldValue(mesh, "GlobalCells"), 8 * cells, cells);
    EXPECT_TRUE(hasNoHangingVertex(toMesh(mesh)));
  }
}

/// The end of a cylinder is a hemisphere, that of its mesh flat, with vertices on the rim alone:
/// none of its normals fits.
TEST(CoarseParts, followARoundEndFromAFlatOne)
{
  const TemporaryFolder folder;
  const FilterRun filters(writeInto(folder, roundedCylinder(1, 4), ".brep"));
  FilterRun::Data mesh = filters.project(toGrid(prismMesh(1, 4, 6, 3)));
  for (int level = 0; level < 3; ++level)
  {
    mesh = filters.refineUniformly(mesh);
    expectAllOnCAD(mesh, 0.1);
    const double lacking = (4 + 2.0 / 3) * 3.14159265358979323846 - measureOf(toMesh(mesh));
    EXPECT_LT(
      std::abs(lacking), 1.05 * fieldValue(filters.measure(mesh, 3), "GlobalGeometricError"));
  }
}

/// What ends in the midst of a pipe of the CAD has corners on that alone, too.
TEST(CoarseParts, keepEndsInTheMidstOfAFaceFlat)
{
  const TemporaryFolder folder;
  const FilterRun filters(writeInto(folder, cylinder(1, 8), ".brep"));
  Mesh prism = prismMesh(1, 4, 6, 3);
  for (Point3& point : prism.points)
  {
    point[2] += 2;
  }
  const auto mesh = filters.refineUniformly(filters.project(toGrid(prism)));
  expectAllOnCAD(mesh, 0.1);
  EXPECT_NEAR(measureOf(toMesh(mesh)), 12, 1e-12); // over a regular polygon of twelve corners
}

} // namespace
