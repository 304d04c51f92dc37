// Meshes that are coarser than narrow faces of their CAD: all vertices reach it, in cells of some
// shape.

#include "DataSets.h"
#include "FilterRun.h"
#include "MeshChecks.h"
#include "TestMeshes.h"

#include <vtkUnstructuredGrid.h>

#include <gtest/gtest.h>

namespace
{

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

} // namespace
