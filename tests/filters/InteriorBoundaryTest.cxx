// Two materials that share a CAD face, and meshes that are no manifolds.

#include "DataSets.h"
#include "FilterRun.h"
#include "MeshChecks.h"
#include "TestMeshes.h"
#include "TestShapes.h"

#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkCoarsenWithCAD.h>
#include <vtkDataArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkProjectOntoCAD.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

namespace
{

using namespace cadrefine;

constexpr double pi = 3.14159265358979323846;
constexpr double radius = 2;
constexpr int core = 1;
constexpr int around = 2;
constexpr int between = 10;

/// With the cell array Material: `core` for the first cells of the mesh's own dimension, `around`
/// for others, and `between` for the listed ones.
vtkSmartPointer<vtkPointSet> withMaterials(const Mesh& mesh, int coreCells)
{
  auto grid = cadtest::toGrid(mesh);
  vtkNew<vtkIntArray> materials;
  materials->SetName("Material");
  int cells = 0;
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
  {
    const bool listed = grid->GetCell(c)->GetCellDimension() < mesh.dimension;
    cells += !listed;
    materials->InsertNextValue(listed ? between : cells <= coreCells ? core : around);
  }
  grid->GetCellData()->AddArray(materials);
  return grid;
}

/// The cells of one material.
Mesh partOf(vtkPointSet* data, int material)
{
  Mesh mesh = cadtest::toMesh(data);
  Mesh part = mesh;
  part.tetrahedra.clear();
  part.triangles.clear();
  part.segments.clear();
  vtkDataArray* materials = data->GetCellData()->GetArray("Material");
  std::map<int, vtkIdType> next;
  for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c)
  {
    const int dimension = data->GetCell(c)->GetCellDimension();
    const vtkIdType place = next[dimension]++;
    if (materials->GetTuple1(c) != material)
    {
      continue;
    }
    if (dimension == 3)
    {
      part.tetrahedra.push_back(mesh.tetrahedra[place]);
    }
    else if (dimension == 2)
    {
      part.triangles.push_back(mesh.triangles[place]);
    }
    else
    {
      part.segments.push_back(mesh.segments[place]);
    }
  }
  return part;
}

bool isFarOutside(const std::vector<Point3>& side)
{
  return std::all_of(
    side.begin(), side.end(), [](const Point3& p) { return norm(p) > 1.5 * radius; });
}

/// A mesh inside another one, with what is between them on a sphere or a circle.
class InteriorBoundary : public testing::Test
{
protected:
  cadtest::TemporaryFolder folder;

  /// What holds after every step; the outer border stays, and with it the measure of the whole.
  static void expectSound(vtkPointSet* data, double wholeMeasure)
  {
    const Mesh mesh = cadtest::toMesh(data);
    EXPECT_TRUE(cadtest::isValid(mesh));
    EXPECT_TRUE(cadtest::hasNoHangingVertex(mesh));
    EXPECT_TRUE(cadtest::isWatertight(mesh, isFarOutside));
    EXPECT_EQ(cadtest::fieldValue(data, "UnprojectedVertices"), 0);
    const Mesh inside = partOf(data, core);
    const Mesh outside = partOf(data, around);
    EXPECT_NEAR(cadtest::measureOf(inside) + cadtest::measureOf(outside), wholeMeasure, 1e-11);
    EXPECT_TRUE(cadtest::isWatertight(inside,
      [](const std::vector<Point3>& side)
      {
        return std::all_of(side.begin(), side.end(),
          [](const Point3& p) { return std::abs(norm(p) - radius) < 1e-11; });
      }));
    EXPECT_TRUE(cadtest::isValid(outside));
  }
};

TEST_F(InteriorBoundary, ofTetrahedraFollowsTheSphere)
{
  const cadtest::FilterRun filters(cadtest::writeInto(folder, cadtest::sphere(radius), ".step"));
  const Mesh coarse = cadtest::ballInShellMesh(radius, 0.03);
  const double whole = cadtest::measureOf(coarse);
  auto data = filters.measure(filters.project(withMaterials(coarse, 20)), 4);
  expectSound(data, whole);
  double before = cadtest::fieldValue(data, "GlobalGeometricError");
  const double deficit =
    4.0 / 3.0 * pi * std::pow(radius, 3) - cadtest::measureOf(partOf(data, core));
  EXPECT_NEAR(before, deficit, 0.01 * deficit) << "each side of the core counts once";
  for (int level = 1; level <= 3; ++level)
  {
    data = filters.measure(filters.refineUniformly(data), 3);
    expectSound(data, whole);
    const Mesh interface = partOf(data, between);
    EXPECT_EQ(interface.triangles.size(), 20u << (2 * level));
    EXPECT_NEAR(cadtest::volumeInside(interface), cadtest::measureOf(partOf(data, core)), 1e-11);
    const double error = cadtest::fieldValue(data, "GlobalGeometricError");
    EXPECT_NEAR(std::log2(before / error), 2, 0.4);
    before = error;
  }
}

/// A level of coarsening undoes one of refinement on it, too.
TEST_F(InteriorBoundary, ofTetrahedraIsCoarsened)
{
  const cadtest::FilterRun filters(cadtest::writeInto(folder, cadtest::sphere(radius), ".step"));
  const Mesh coarse = cadtest::ballInShellMesh(radius, 0.03);
  const auto first = filters.refineUniformly(filters.project(withMaterials(coarse, 20)));
  const auto errorOf = [&](vtkPointSet* mesh)
  { return cadtest::fieldValue(filters.measure(mesh, 0), "GlobalGeometricError"); };
  const double target = errorOf(first);
  const auto fine = filters.refineUniformly(first);
  const auto back = filters.run<vtkCoarsenWithCAD>(
    fine, [&](vtkCoarsenWithCAD* filter) { filter->SetTargetError(target); });
  expectSound(back, cadtest::measureOf(coarse));
  EXPECT_LE(errorOf(back), target);
  const auto cells = static_cast<double>(cadtest::toMesh(first).tetrahedra.size());
  EXPECT_NEAR(static_cast<double>(cadtest::toMesh(back).tetrahedra.size()), cells, 0.1 * cells);
  EXPECT_LT(partOf(back, between).triangles.size(), partOf(fine, between).triangles.size() / 2);
}

TEST_F(InteriorBoundary, ofTetrahedraIsRefinedWhereItsErrorIsLarge)
{
  const cadtest::FilterRun filters(cadtest::writeInto(folder, cadtest::sphere(radius), ".step"));
  const Mesh coarse = cadtest::ballInShellMesh(radius, 0.03);
  auto data = filters.measure(filters.project(withMaterials(coarse, 20)), 2);
  const double first = cadtest::fieldValue(data, "GlobalGeometricError");
  for (int step = 0; step < 6; ++step)
  {
    data = filters.measure(filters.refineWhereErrorExceeds(data, 1e-3), 2);
    expectSound(data, cadtest::measureOf(coarse));
  }
  EXPECT_LT(cadtest::fieldValue(data, "GlobalGeometricError"), 0.3 * first);
}

TEST_F(InteriorBoundary, ofTrianglesFollowsTheCircle)
{
  const cadtest::FilterRun filters(cadtest::writeInto(folder, cadtest::circle(radius), ".brep"));
  const Mesh coarse = cadtest::discInRingMesh(radius, 0.02, 9);
  const double whole = cadtest::measureOf(coarse);
  auto data = filters.measure(filters.project(withMaterials(coarse, 9)), 4);
  double before = cadtest::fieldValue(data, "GlobalGeometricError");
  EXPECT_NEAR(before, pi * radius * radius - cadtest::measureOf(partOf(data, core)), 0.01 * before);
  for (int level = 1; level <= 3; ++level)
  {
    data = filters.measure(filters.refineUniformly(data), 3);
    expectSound(data, whole);
    EXPECT_EQ(partOf(data, between).segments.size(), 9u << level);
    const double error = cadtest::fieldValue(data, "GlobalGeometricError");
    EXPECT_NEAR(std::log2(before / error), 2, 0.1);
    before = error;
  }
}

/// What is not listed is no boundary.
TEST_F(InteriorBoundary, isLeftWhereItIsNotListed)
{
  const cadtest::FilterRun filters(cadtest::writeInto(folder, cadtest::sphere(radius), ".step"));
  Mesh coarse = cadtest::ballInShellMesh(radius, 0.03);
  coarse.triangles.clear();
  EXPECT_THROW(filters.project(cadtest::toGrid(coarse)), std::runtime_error);
}

/// A user who lists the materials' cells alone, as many programs write them, is told so.
TEST_F(InteriorBoundary, isMissedWhereMaterialsMeetOnTheCAD)
{
  const cadtest::FilterRun filters(cadtest::writeInto(
    folder, cadtest::together(cadtest::sphere(radius), cadtest::sphere(2 * radius)), ".brep"));
  const Mesh listed = cadtest::ballInShellMesh(radius, 0);
  Mesh cellsAlone = listed;
  cellsAlone.triangles.clear();
  const auto warnings = [&](vtkPointSet* mesh)
  { return filters.attempt<vtkProjectOntoCAD>(mesh, [](vtkProjectOntoCAD*) {}).warnings; };
  EXPECT_TRUE(warnings(withMaterials(listed, 20)).empty());
  EXPECT_TRUE(warnings(cadtest::toGrid(cellsAlone)).empty()) << "without materials";
  Mesh withLines = cellsAlone;
  for (const auto& triangle : listed.triangles)
  {
    withLines.segments.push_back({ triangle[0], triangle[1] });
  }
  EXPECT_TRUE(warnings(cadtest::toGrid(withLines)).empty()) << "lines tell no materials apart";
  const auto found = warnings(withMaterials(cellsAlone, 20));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found[0].find("the mesh lists no cells between them"), std::string::npos) << found[0];
}

class NoManifold : public testing::Test
{
protected:
  cadtest::TemporaryFolder folder;
  cadtest::FilterRun filters{ cadtest::writeInto(folder, cadtest::sphere(50), ".step") };

  static void expectSound(vtkPointSet* data, double measure, double tolerance)
  {
    const Mesh mesh = cadtest::toMesh(data);
    EXPECT_TRUE(cadtest::isValid(mesh));
    EXPECT_TRUE(cadtest::hasNoHangingVertex(mesh));
    EXPECT_NEAR(cadtest::measureOf(mesh), measure, tolerance);
  }
};

TEST_F(NoManifold, cubesAtAnEdge)
{
  const auto coarse = cadtest::toGrid(cadtest::cubesAtAnEdgeMesh(1));
  const auto uniform = filters.refineStraight(coarse, 3);
  expectSound(uniform, 2, 1e-12);
  EXPECT_EQ(uniform->GetNumberOfCells(), 12 * 512);
  EXPECT_EQ(uniform->GetNumberOfPoints(), 2 * 729 - 9) << "nine vertices along the common edge";
  const auto local = filters.run<vtkRefineWithCAD>(coarse,
    [](vtkRefineWithCAD* filter)
    {
      filter->ProjectNewVerticesOff();
      filter->SetLevels(7);
    });
  expectSound(local, 2, 1e-12);
}

TEST_F(NoManifold, sheetsAtAnEdge)
{
  const auto coarse = cadtest::toPolyData(cadtest::threeSheetsMesh(1));
  const auto uniform = filters.refineStraight(coarse, 3);
  expectSound(uniform, 3, 1e-12);
  EXPECT_EQ(uniform->GetNumberOfCells(), 6 * 64);
  EXPECT_EQ(uniform->GetNumberOfPoints(), 3 * 81 - 2 * 9);
}

/// The cubes as a solid: its border runs through each end of the common edge twice.
TEST_F(NoManifold, cubesAtAnEdgeOnTheirCAD)
{
  cadtest::TemporaryFolder folderOfCubes;
  const cadtest::FilterRun cubes(
    cadtest::writeInto(folderOfCubes, cadtest::cubesAtAnEdge(), ".brep"));
  auto data = cubes.project(cadtest::toGrid(cadtest::cubesAtAnEdgeMesh(1)));
  for (int level = 0; level < 2; ++level)
  {
    data = cubes.refineUniformly(data);
    expectSound(data, 2, 1e-12);
    EXPECT_EQ(cadtest::fieldValue(data, "UnprojectedVertices"), 0);
  }
}

} // namespace
