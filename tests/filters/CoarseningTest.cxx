// Coarsen With CAD: refinement is undone, and the boundary stays on the CAD.

#include "DataSets.h"
#include "FilterRun.h"
#include "MeshChecks.h"
#include "MixedMeshes.h"
#include "TestShapes.h"

#include <cadrefine/mesh/Quality.h>

#include <vtkAdaptToCAD.h>
#include <vtkCellData.h>
#include <vtkCoarsenWithCAD.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace
{

using namespace cadrefine;
using cadtest::fieldValue;
using cadtest::FilterRun;

struct Case
{
  std::string name;
  std::string mesh;
  std::string cad;
  double share = 0; ///< Of the first mesh's cells, by which the last one may differ.
};

void PrintTo(const Case& tested, std::ostream* out)
{
  *out << tested.name;
}

FilterRun::Data coarsen(const FilterRun& filters, vtkPointSet* mesh, int levels, double targetError,
  double maximumDistance = 0)
{
  return filters.run<vtkCoarsenWithCAD>(mesh,
    [&](vtkCoarsenWithCAD* filter)
    {
      filter->SetLevels(levels);
      filter->SetTargetError(targetError);
      filter->SetMaximumDistance(maximumDistance);
    });
}

class Coarsening : public testing::TestWithParam<Case>
{
protected:
  FilterRun filters{ CADREFINE_DATA "/" + GetParam().cad };
  FilterRun::Data coarse = filters.project(cadtest::readGrid(CADREFINE_DATA "/" + GetParam().mesh));
  double errorOf(vtkPointSet* mesh) const
  {
    return fieldValue(filters.measure(mesh, 0), "GlobalGeometricError");
  }
};

TEST_P(Coarsening, undoesUniformRefinement)
{
  const double target = errorOf(coarse);
  const double size = cadtest::measureOf(cadtest::toMesh(coarse));
  const auto fine = filters.refineUniformly(coarse);
  const auto back = coarsen(filters, fine, 1, target);
  EXPECT_NEAR(fieldValue(back, "GlobalCells"), fieldValue(coarse, "GlobalCells"),
    GetParam().share * fieldValue(coarse, "GlobalCells"));
  EXPECT_LE(errorOf(back), target);
  EXPECT_NEAR(cadtest::measureOf(cadtest::toMesh(back)), size, 2 * target);
  EXPECT_EQ(fieldValue(back, "UnprojectedVertices"), 0);
  EXPECT_EQ(fieldValue(back, "InvalidCells"), 0);
  EXPECT_GE(fieldValue(back, "MinimumQuality"), 0.1);
  EXPECT_TRUE(cadtest::hasNoHangingVertex(cadtest::toMesh(back)));
}

/// Without a target the boundary on curved CAD stays as near as it is.
TEST_P(Coarsening, keepsTheDistanceWithoutATarget)
{
  const auto fine = filters.refineUniformly(coarse);
  const auto back = coarsen(filters, fine, 1, 0);
  EXPECT_LT(fieldValue(back, "GlobalCells"), 0.9 * fieldValue(fine, "GlobalCells"));
  EXPECT_LE(fieldValue(filters.measure(back, 1), "MaximumGeometricDistance"),
    1.0001 * fieldValue(filters.measure(fine, 1), "MaximumGeometricDistance"));
}

/// The aeroplane and half of the box round it.
class CoarseningAeroplane : public testing::Test
{
protected:
  /// An indicator that is the largest x of each cell.
  void SetUp() override { cadtest::addLargestX(mesh, "Indicator"); }

  FilterRun filters{ CADREFINE_DATA "/aeroplane.igs" };
  FilterRun::Data mesh = filters.project(cadtest::readGrid(CADREFINE_DATA "/aeroplane_coarse.vtu"));
};

/// Vertices that local operations bring onto the CAD are not reported as off it.
TEST_F(CoarseningAeroplane, beginsWithAllVerticesOnTheCAD)
{
  EXPECT_EQ(fieldValue(mesh, "UnprojectedVertices"), 0);
  EXPECT_EQ(fieldValue(mesh, "VerticesOffCAD"), 0);
}

TEST_F(CoarseningAeroplane, keepsVerticesOfMarkedCells)
{
  constexpr double threshold = 0.3;
  const auto coarse = filters.run<vtkCoarsenWithCAD>(mesh,
    [&](vtkCoarsenWithCAD* filter)
    {
      filter->SetMarkingArray("Indicator");
      filter->SetThreshold(threshold);
      filter->SetMaximumDistance(0.01);
      filter->SetOperations(vtkCoarsenWithCAD::ALL_OPERATIONS);
    });
  std::map<double, std::array<double, 3>> points; // by id
  vtkDataArray* ids = coarse->GetPointData()->GetGlobalIds();
  for (vtkIdType p = 0; p < coarse->GetNumberOfPoints(); ++p)
  {
    coarse->GetPoint(p, points[ids->GetTuple1(p)].data());
  }
  int marked = 0;
  vtkDataArray* oldIds = mesh->GetPointData()->GetGlobalIds();
  const Mesh cells = cadtest::toMesh(mesh);
  std::set<Index> kept;
  for (std::size_t c = 0; c < cells.tetrahedra.size(); ++c)
  {
    const auto& corners = cells.tetrahedra[c];
    if (std::any_of(
          corners.begin(), corners.end(), [&](Index v) { return cells.points[v][0] >= threshold; }))
    {
      kept.insert(corners.begin(), corners.end());
      ++marked;
    }
  }
  for (const Index vertex : kept)
  {
    EXPECT_EQ(points.count(oldIds->GetTuple1(vertex)), 1U) << vertex;
  }
  EXPECT_GT(marked, 1000);
  EXPECT_LT(coarse->GetNumberOfPoints(), mesh->GetNumberOfPoints() - 100);
}

/// The box round the aeroplane is flat, and not on the CAD.
TEST_F(CoarseningAeroplane, keepsTheShapeOfTheWalls)
{
  const auto fine = filters.refineUniformly(mesh);
  const auto coarse = coarsen(filters, fine, 1, 0, 0.01);
  const auto areaOnBox = [](vtkPointSet* data, std::size_t& count)
  {
    std::array<double, 6> box{};
    data->GetBounds(box.data());
    const Mesh all = cadtest::toMesh(data);
    double area = 0;
    std::map<std::set<Index>, std::array<Index, 3>> sides;
    for (const auto& cell : all.tetrahedra)
    {
      for (const auto& face : tetrahedronFaces)
      {
        const std::array<Index, 3> corners{ cell[face[0]], cell[face[1]], cell[face[2]] };
        const std::set<Index> key(corners.begin(), corners.end());
        if (!sides.emplace(key, corners).second)
        {
          sides.erase(key);
        }
      }
    }
    for (const auto& [key, corners] : sides)
    {
      for (int k = 0; k < 6; ++k)
      {
        if (std::all_of(corners.begin(), corners.end(),
              [&, at = k](Index v) { return all.points[v][at / 2] == box[at]; }))
        {
          area += 0.5 * norm(twofoldAreaVector(
                          all.points[corners[0]], all.points[corners[1]], all.points[corners[2]]));
          ++count;
        }
      }
    }
    return area;
  };
  std::size_t fineCount = 0;
  std::size_t coarseCount = 0;
  const double area = areaOnBox(fine, fineCount);
  EXPECT_NEAR(areaOnBox(coarse, coarseCount), area, 1e-12 * area);
  EXPECT_LT(coarseCount, fineCount / 3);
}

TEST_F(CoarseningAeroplane, leavesTheMeshWhereItMayOnlyCut)
{
  const auto outcome = filters.attempt<vtkCoarsenWithCAD>(
    mesh, [](vtkCoarsenWithCAD* filter) { filter->SetOperations(vtkCoarsenWithCAD::CUT_ONLY); });
  ASSERT_TRUE(outcome.succeeded);
  EXPECT_EQ(outcome.pointSet()->GetNumberOfPoints(), mesh->GetNumberOfPoints());
  ASSERT_EQ(outcome.warnings.size(), 1U);
  EXPECT_NE(outcome.warnings[0].find("Cut only"), std::string::npos);
}

TEST(CoarseningHexahedra, isAnErrorWithoutSimplices)
{
  const cadtest::TemporaryFolder folder;
  const FilterRun filters(cadtest::writeInto(folder, cadtest::sphere(2), ".brep"));
  const auto outcome = filters.attempt<vtkCoarsenWithCAD>(
    filters.project(cadtest::toGrid(cadtest::hexahedralBallMesh(2, 0.02, 1, { 1 }))),
    [](vtkCoarsenWithCAD*) {});
  EXPECT_FALSE(outcome.succeeded);
  ASSERT_EQ(outcome.errors.size(), 1U);
  EXPECT_NE(outcome.errors[0].find("can be coarsened, and the mesh has none"), std::string::npos)
    << outcome.errors[0];
}

/// Straight boundary that is not in the CAD, in the plane.
TEST(CoarseningWalls, keepsTheirShape)
{
  const FilterRun filters(CADREFINE_DATA "/three_arcs.igs");
  const auto start = filters.project(cadtest::readGrid(CADREFINE_DATA "/three_arcs_coarse.vtu"));
  const auto adapted = filters.run<vtkAdaptToCAD>(start,
    [](vtkAdaptToCAD* filter)
    {
      filter->SetStartProjected(true);
      filter->SetMaximumSteps(3);
      filter->SetCoarseningFraction(0.1);
    });
  const auto errorOf = [&](vtkPointSet* mesh)
  { return fieldValue(filters.measure(mesh, 0), "GlobalGeometricError"); };
  EXPECT_NEAR(cadtest::measureOf(cadtest::toMesh(adapted)),
    cadtest::measureOf(cadtest::toMesh(start)), errorOf(start) + errorOf(adapted));
}

/// Steps that mark no cell, so that the boundary is measured and then coarsened as it is.
TEST(CoarseningAlone, measuresWhatItMakes)
{
  const FilterRun filters(CADREFINE_DATA "/cylinder.brep");
  const auto coarsened =
    filters.run<vtkAdaptToCAD>(cadtest::readGrid(CADREFINE_DATA "/cylinder_coarse.vtu"),
      [](vtkAdaptToCAD* filter)
      {
        filter->SetMaximumSteps(3);
        filter->SetErrorMarking(vtkAdaptToCAD::OFF);
        filter->SetNormalAngle(170);
        filter->SetTargetError(1e-3);
        filter->SetCoarseningFraction(0.9);
      });
  EXPECT_EQ(fieldValue(coarsened, "GlobalGeometricError"),
    fieldValue(filters.measure(coarsened, 0), "GlobalGeometricError"));
}

/// Also where the uniform steps end below the target.
TEST(CoarseningAlone, followsUniformSteps)
{
  const FilterRun filters(CADREFINE_DATA "/cylinder.brep");
  const auto start = filters.project(cadtest::readGrid(CADREFINE_DATA "/cylinder_coarse.vtu"));
  const double target = fieldValue(filters.measure(start, 0), "GlobalGeometricError");
  const auto coarsened = filters.run<vtkAdaptToCAD>(start,
    [&](vtkAdaptToCAD* filter)
    {
      filter->SetStartProjected(true);
      filter->SetUniformSteps(1);
      filter->SetMaximumSteps(1);
      filter->SetErrorMarking(vtkAdaptToCAD::OFF);
      filter->SetNormalAngle(170);
      filter->SetTargetError(target);
      filter->SetCoarseningFraction(0.9);
    });
  EXPECT_LT(fieldValue(coarsened, "GlobalCells"),
    0.5 * fieldValue(filters.refineUniformly(start), "GlobalCells"));
}

/// The rims of the plane ends count, too: there, chords are in the CAD's faces, off its edges.
TEST(CoarseningRims, keepTheirDistance)
{
  const FilterRun filters(CADREFINE_DATA "/cylinder.brep");
  const auto start = filters.project(cadtest::readGrid(CADREFINE_DATA "/cylinder_coarse.vtu"));
  const auto chordErrorOf = [&](vtkPointSet* mesh)
  { return fieldValue(filters.measure(mesh, 0), "MaximumChordError"); };
  const double before = chordErrorOf(start);
  for (const double distance : { 0.0, 0.04 * before, 1.2 * before })
  {
    const auto coarsened = coarsen(filters, start, 1, 0, distance);
    EXPECT_LT(fieldValue(coarsened, "GlobalCells"), fieldValue(start, "GlobalCells"));
    EXPECT_LE(chordErrorOf(coarsened), std::max(distance, (1 + 1e-6) * before)) << distance;
  }
}

/// An array that numbers the cells of a mesh numbers parents once these are refined.
TEST(CoarseningNumbered, isWhatItIsWithoutNumbers)
{
  const FilterRun filters(CADREFINE_DATA "/cylinder.brep");
  const auto coarse = cadtest::readGrid(CADREFINE_DATA "/cylinder_coarse.vtu");
  vtkNew<vtkIntArray> numbers;
  numbers->SetName("Number");
  for (vtkIdType c = 0; c < coarse->GetNumberOfCells(); ++c)
  {
    numbers->InsertNextValue(static_cast<int>(c));
  }
  const auto refineAndCoarsen = [&]
  {
    const auto projected = filters.project(coarse);
    const double target = fieldValue(filters.measure(projected, 0), "GlobalGeometricError");
    const auto fine = filters.refineUniformly(filters.refineUniformly(projected));
    return fieldValue(coarsen(filters, fine, 2, target), "GlobalCells");
  };
  const double expected = refineAndCoarsen();
  coarse->GetCellData()->AddArray(numbers);
  EXPECT_EQ(refineAndCoarsen(), expected);
}

/// A solver's indicator that moves through the mesh: fine there, coarse behind it.
TEST(CoarseningFront, keepsTheNumberOfCells)
{
  const FilterRun filters(CADREFINE_DATA "/naca0012_sharp.igs");
  FilterRun::Data mesh = filters.refineUniformly(
    filters.project(cadtest::readGrid(CADREFINE_DATA "/naca0012_coarse.vtu")));
  const double target = fieldValue(filters.measure(mesh, 0), "GlobalGeometricError");
  const double area = cadtest::measureOf(cadtest::toMesh(mesh));
  std::vector<double> cells;
  for (int step = 0; step < 20; ++step)
  {
    const double front = 0.2 + 1.6 * step / 19;
    vtkNew<vtkDoubleArray> indicator;
    indicator->SetName("Indicator");
    for (vtkIdType c = 0; c < mesh->GetNumberOfCells(); ++c)
    {
      std::array<double, 6> bounds{};
      mesh->GetCellBounds(c, bounds.data());
      const double size = std::max(bounds[1] - bounds[0], bounds[3] - bounds[2]);
      const double distance = 0.5 * (bounds[0] + bounds[1]) - front;
      indicator->InsertNextValue(size * std::exp(-8 * distance * distance));
    }
    mesh->GetCellData()->AddArray(indicator);
    mesh = filters.run<vtkAdaptToCAD>(mesh,
      [&](vtkAdaptToCAD* filter)
      {
        filter->SetStartProjected(true);
        filter->SetMaximumSteps(1);
        filter->SetErrorMarking(vtkAdaptToCAD::OFF);
        filter->SetIndicatorArray("Indicator");
        filter->SetIndicatorThreshold(0.3);
        filter->SetCutFacets(false);
        filter->SetCoarseningFraction(0.25);
        filter->SetTargetError(target);
      });
    EXPECT_LE(fieldValue(mesh, "GlobalGeometricError"), target) << step;
    EXPECT_NEAR(cadtest::measureOf(cadtest::toMesh(mesh)), area, 2 * target) << step;
    EXPECT_EQ(fieldValue(mesh, "InvalidCells"), 0) << step;
    cells.push_back(fieldValue(mesh, "GlobalCells"));
  }
  // It takes some steps until cells are as small as they have to be.
  const auto [least, most] = std::minmax_element(cells.begin() + 8, cells.end());
  EXPECT_LT(*most, 1.1 * *least);
  EXPECT_GT(*least, 4 * cells.front());
}

// The first mesh of the wing is 228 cells.
INSTANTIATE_TEST_SUITE_P(Cases, Coarsening,
  testing::Values(Case{ "Cylinder", "cylinder_coarse.vtu", "cylinder.brep", 0.05 },
    Case{ "Wing", "naca0012_coarse.vtu", "naca0012_sharp.igs", 0.05 },
    Case{ "BluntWing", "naca0012_blunt_coarse.vtu", "naca0012_blunt.igs", 0.05 },
    Case{ "Aeroplane", "aeroplane_coarse.vtu", "aeroplane.igs", 0.05 }),
  [](const auto& tested) { return tested.param.name; });

} // namespace
