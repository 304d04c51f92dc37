// Meshes that are coarser than narrow faces of their CAD: all vertices reach it, in cells of some
// shape.

#include "DataSets.h"
#include "FilterRun.h"
#include "MeshChecks.h"
#include "QuadraticRuns.h"
#include "TestMeshes.h"
#include "TestShapes.h"

#include <vtkCoarsenWithCAD.h>
#include <vtkMeshValidity.h>
#include <vtkProjectOntoCAD.h>
#include <vtkUnstructuredGrid.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

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
  expectAllOnCAD(mesh, 0.1);
  for (int level = 0; level < 2; ++level)
  {
    const double cells = fieldValue(mesh, "GlobalCells");
    mesh = filters.refineUniformly(mesh);
    expectAllOnCAD(mesh, 0.1);
    EXPECT_NEAR(fieldValue(mesh, "GlobalCells"), 8 * cells, cells);
    EXPECT_TRUE(hasNoHangingVertex(toMesh(mesh)));
  }
}

/// Cells that are too curved once their mid nodes are on the CAD are bisected, these alone.
TEST(CoarseParts, getAllMidNodesOntoTheCAD)
{
  const FilterRun filters(crankArm);
  const auto projected = filters.project(readGrid(CADREFINE_TRUTH "/crank_arm_coarse.vtu"));
  for (const int level : { 0, 1 })
  {
    const auto before = refineToQuadratic(filters, projected, level, vtkRefineWithCAD::CUT_ONLY);
    EXPECT_GT(fieldValue(before, "UnprojectedVertices"), 0);
    const auto mesh = refineToQuadratic(filters, projected, level);
    EXPECT_EQ(fieldValue(mesh, "UnprojectedVertices"), 0);
    EXPECT_EQ(fieldValue(filters.run<vtkMeshValidity>(mesh, [](auto*) {}), "InvalidCells"), 0);
    EXPECT_GE(fieldValue(mesh, "MinimumQuality"), 0.1);
    EXPECT_LT(fieldValue(mesh, "GlobalCells"), 40000);
    EXPECT_LT(fieldValue(filters.measure(mesh, 1), "GlobalGeometricError"),
      0.05 * fieldValue(filters.measure(before, 1), "GlobalGeometricError"));
  }
}

/// A level of coarsening undoes one of refinement, with an error that is no larger than at first.
void expectCoarsenedBack(const char* file)
{
  const FilterRun filters(crankArm);
  const auto first = filters.project(readGrid(file));
  const auto errorOf = [&](vtkPointSet* mesh)
  { return fieldValue(filters.measure(mesh, 0), "GlobalGeometricError"); };
  const double target = errorOf(first);
  const auto back = filters.run<vtkCoarsenWithCAD>(filters.refineUniformly(first),
    [&](vtkCoarsenWithCAD* filter) { filter->SetTargetError(target); });
  expectAllOnCAD(back, 0.1);
  EXPECT_LE(errorOf(back), target);
  const double cells = fieldValue(first, "GlobalCells");
  EXPECT_NEAR(fieldValue(back, "GlobalCells"), cells, 0.05 * cells);
}

TEST(CoarseParts, areCoarsenedBack)
{
  expectCoarsenedBack(CADREFINE_TRUTH "/crank_arm_coarse.vtu");
}

/// Along the border of tags vertices go in one row: many that are to go cannot.
TEST(CoarseParts, areCoarsenedBackWithTags)
{
  expectCoarsenedBack(CADREFINE_TRUTH "/crank_arm_tagged.vtu");
}

/// A minimum that most cells cannot have.
TEST(CoarseParts, areNotCutAllOver)
{
  const FilterRun filters(crankArm);
  const auto mesh = readGrid(CADREFINE_TRUTH "/crank_arm_coarse.vtu");
  const auto projected = filters.run<vtkProjectOntoCAD>(
    mesh, [](vtkProjectOntoCAD* filter) { filter->SetMinimumQuality(0.5); });
  EXPECT_LT(
    fieldValue(projected, "GlobalCells"), 2.0 * static_cast<double>(mesh->GetNumberOfCells()));
  EXPECT_EQ(fieldValue(projected, "InvalidCells"), 0);
}

/// In a thin wall vertices slide along it to make way, but not across the hole in it: the wall of
/// the bottle's neck is thinner than the chords round it are far from it.
TEST(CoarseParts, keepTheirShapeWhereVerticesSlide)
{
  const FilterRun filters("/usr/share/opencascade/data/occ/bottle.brep");
  FilterRun::Data mesh = filters.project(readGrid(CADREFINE_TRUTH "/bottle.vtu"));
  double error = fieldValue(filters.measure(mesh, 1), "GlobalGeometricError");
  for (int level = 0; level < 2; ++level)
  {
    mesh = filters.refineUniformly(mesh);
    const double after = fieldValue(filters.measure(mesh, 1), "GlobalGeometricError");
    EXPECT_LT(after, error / 3);
    error = after;
  }
}

class RoundEnds : public testing::TestWithParam<int>
{
};

INSTANTIATE_TEST_SUITE_P(Corners, RoundEnds, testing::Values(4, 5, 6, 8));

/// The end of a cylinder is a hemisphere, that of its mesh flat, with vertices on the rim alone:
/// none of its normals fits. Edges of an even number are as near to the cylinder as to the dome.
TEST_P(RoundEnds, areFollowedFromFlatOnes)
{
  const TemporaryFolder folder;
  const FilterRun filters(writeInto(folder, roundedCylinder(1, 4), ".brep"));
  FilterRun::Data mesh = filters.project(toGrid(prismMesh(1, 4, GetParam(), 3)));
  const auto expectToKnowOfTheVolume = [&](double factor)
  {
    const double lacking = (4 + 2.0 / 3) * 3.14159265358979323846 - measureOf(toMesh(mesh));
    EXPECT_LT(
      std::abs(lacking), factor * fieldValue(filters.measure(mesh, 3), "GlobalGeometricError"));
  };
  expectToKnowOfTheVolume(1.1); // the mesh is coarse for depth 3
  for (int level = 0; level < 3; ++level)
  {
    mesh = filters.refineUniformly(mesh);
    expectAllOnCAD(mesh, 0.1);
    expectToKnowOfTheVolume(1.05);
  }
}

/// A regular prism with corners on a cylinder of radius 1, refined once on this CAD: the ends,
/// whose corners are on the CAD too, stay in their planes.
void expectFlatEnds(const TopoDS_Shape& cad, Mesh prism, double z, int corners)
{
  const TemporaryFolder folder;
  const FilterRun filters(writeInto(folder, cad, ".brep"));
  for (Point3& point : prism.points)
  {
    point[2] += z;
  }
  const auto mesh = filters.refineUniformly(filters.project(toGrid(prism)));
  expectAllOnCAD(mesh, 0.1);
  const double area = corners * std::sin(3.14159265358979323846 / corners); // of twice the corners
  EXPECT_NEAR(measureOf(toMesh(mesh)), 4 * area, 1e-12);
}

TEST(CoarseParts, keepEndsInTheMidstOfAFaceFlat)
{
  expectFlatEnds(cylinder(1, 8), prismMesh(1, 4, 6, 3), 2, 6);
}

/// Where the CAD goes on with another face.
TEST(CoarseParts, keepEndsBetweenTwoFacesFlat)
{
  expectFlatEnds(longCylinder(1, 4), prismMesh(1, 4, 6, 3), 0, 6);
}

/// Of one facet.
TEST(CoarseParts, keepQuadrilateralEndsFlat)
{
  Mesh prism = prismMesh(1, 4, 4, 1);
  prism.tetrahedra.clear();
  prism.hexahedra = { { 0, 1, 2, 3, 4, 5, 6, 7 } };
  expectFlatEnds(cylinder(1, 8), prism, 2, 4);
}

/// A cylinder of two faces, and a mesh that has one edge along 160 degrees of the circle between
/// them: the facets beside it lead from deep inside to the faces, and turn by a right angle from
/// all others.
TEST(CoarseParts, followACADEdgeDeepUnderIt)
{
  const auto at = [](double degrees, double z) -> Point3
  {
    const double angle = degrees * 3.14159265358979323846 / 180;
    return { std::cos(angle), std::sin(angle), z };
  };
  Mesh mesh;
  for (const double degrees : { 80, 130, 180, 230, 280 }) // 0 to 4, on the circle
  {
    mesh.points.push_back(at(degrees, 0));
  }
  for (const double side : { 1, -1 }) // from 5 and 13 on: over the edge, a ring, its middle
  {
    mesh.points.push_back(at(0, 0.3 * side));
    for (int k = 0; k < 6; ++k)
    {
      mesh.points.push_back(at(60 * k, side));
    }
    mesh.points.push_back({ 0, 0, side });
  }
  mesh.points.push_back({ -0.4, 0, 0 });
  mesh.ids.resize(mesh.points.size());
  std::iota(mesh.ids.begin(), mesh.ids.end(), GlobalId{ 0 });
  const Index inside = 21;
  const auto add = [&](Index a, Index b, Index c, bool isUpper) {
    mesh.tetrahedra.push_back({ a, isUpper ? b : c, isUpper ? c : b, inside });
  };
  for (const Index over : { 5, 13 })
  {
    const bool isUpper = over == 5;
    const std::array<Index, 7> loop{ over, 0, 1, 2, 3, 4, over };
    for (Index k = 0; k < 6; ++k)
    {
      const Index first = over + 1 + k;
      const Index next = over + 1 + (k + 1) % 6;
      add(loop[k + 1], loop[k], first, isUpper);
      add(loop[k + 1], first, next, isUpper);
      add(next, first, over + 7, isUpper);
    }
    add(0, 4, over, isUpper);
  }
  ASSERT_TRUE(isValid(mesh));
  const TemporaryFolder folder;
  const FilterRun filters(writeInto(folder, moved(longCylinder(1, 1), { 0, 0, -1 }), ".brep"));
  const auto fine = filters.refineUniformly(filters.project(toGrid(mesh)));
  EXPECT_EQ(fieldValue(fine, "UnprojectedVertices"), 0);
  EXPECT_EQ(fieldValue(fine, "InvalidCells"), 0);
  const Mesh cells = toMesh(fine);
  EXPECT_EQ(std::count_if(cells.points.begin(), cells.points.end(),
              [](const Point3& p)
              { return std::abs(p[2]) < 1e-12 && std::abs(std::hypot(p[0], p[1]) - 1) < 1e-12; }),
    10);
}

} // namespace
