// Surfaces of real parts that gmsh has meshed coarsely: local operations bring the vertices onto
// the CAD that would stop on the way, and leave better triangles.

#include "DataSets.h"
#include "FilterRun.h"
#include "MeshChecks.h"
#include "TestMeshes.h"
#include "TestShapes.h"

#include <vtkCoarsenWithCAD.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace
{

using namespace cadrefine;

struct Part
{
  const char* name;
  const char* file;
  double leastQuality; ///< After two uniform levels.
};

void PrintTo(const Part& part, std::ostream* out)
{
  *out << part.name;
}

class SurfacePart : public testing::TestWithParam<Part>
{
protected:
  using Data = cadtest::FilterRun::Data;

  /// The mesh projected, and refined uniformly twice.
  std::vector<Data> run(int operations) const
  {
    std::vector<Data> steps{ filters.run<vtkProjectOntoCAD>(
      mesh, [&](vtkProjectOntoCAD* filter) { filter->SetOperations(operations); }) };
    for (int level = 0; level < 2; ++level)
    {
      steps.push_back(filters.run<vtkRefineWithCAD>(steps.back(),
        [&](vtkRefineWithCAD* filter)
        {
          filter->SetMethod(vtkRefineWithCAD::UNIFORM_BISECTION);
          filter->SetOperations(operations);
        }));
    }
    return steps;
  }

  Data mesh = cadtest::readGrid(CADREFINE_TRUTH "/" + std::string(GetParam().name) + ".vtu");
  cadtest::FilterRun filters{ std::string("/usr/share/opencascade/data/iges/") + GetParam().file };
};

TEST_P(SurfacePart, reachesTheCAD)
{
  const auto cut = run(vtkRefineWithCAD::CUT_ONLY);
  const auto all = run(vtkRefineWithCAD::ALL_OPERATIONS);
  EXPECT_GT(cadtest::fieldValue(cut.back(), "UnprojectedVertices"), 0);
  EXPECT_EQ(cadtest::fieldValue(all.front(), "UnprojectedVertices"), 0);
  EXPECT_EQ(cadtest::fieldValue(all.back(), "UnprojectedVertices"), 0);
  for (std::size_t step = 0; step < all.size(); ++step)
  {
    EXPECT_GE(cadtest::fieldValue(all[step], "MinimumQuality"),
      cadtest::fieldValue(cut[step], "MinimumQuality"));
    EXPECT_EQ(cadtest::fieldValue(all[step], "InvalidCells"), 0);
    EXPECT_TRUE(cadtest::hasNoHangingVertex(cadtest::toMesh(all[step])));
  }
  EXPECT_GE(cadtest::fieldValue(all.back(), "MinimumQuality"), GetParam().leastQuality);
}

/// No edge comes to have more triangles than any edge had, and holes stay holes.
TEST_P(SurfacePart, staysOneSurface)
{
  const auto countAt = [](vtkPointSet* data)
  {
    std::map<std::array<Index, 2>, int> edges;
    for (const auto& cell : cadtest::toMesh(data).triangles)
    {
      for (const auto& [i, j] : triangleEdges)
      {
        ++edges[{ std::min(cell[i], cell[j]), std::max(cell[i], cell[j]) }];
      }
    }
    std::map<int, int> counts;
    for (const auto& [ends, count] : edges)
    {
      ++counts[count];
    }
    return counts;
  };
  const auto before = countAt(mesh);
  const auto after = countAt(filters.project(mesh));
  for (const auto& [triangles, count] : after)
  {
    EXPECT_EQ(before.count(triangles), 1u) << count << " edges with " << triangles << " triangles";
    if (triangles > 2)
    {
      EXPECT_LE(count, before.at(triangles));
    }
  }
}

/// Cells as poly data, too, and nothing where the region is not.
TEST_P(SurfacePart, isWorkedOnInTheRegionAlone)
{
  Mesh triangles = cadtest::toMesh(mesh);
  double bounds[6];
  mesh->GetBounds(bounds);
  const double middle = 0.5 * (bounds[0] + bounds[1]);
  const auto whole = filters.project(cadtest::toPolyData(triangles));
  EXPECT_NE(vtkPolyData::SafeDownCast(whole), nullptr);
  EXPECT_EQ(cadtest::fieldValue(whole, "UnprojectedVertices"), 0);
  bounds[1] = middle;
  const auto half = filters.run<vtkProjectOntoCAD>(cadtest::toPolyData(triangles),
    [&](vtkProjectOntoCAD* filter)
    {
      filter->SetUseRegion(true);
      filter->SetRegion(bounds);
    });
  const auto beyond = [&](const Mesh& data)
  {
    std::vector<std::array<Point3, 3>> cells;
    for (const auto& [i, j, k] : data.triangles)
    {
      const std::array<Point3, 3> points{ data.points[i], data.points[j], data.points[k] };
      if (std::all_of(points.begin(), points.end(), [&](const Point3& p) { return p[0] > middle; }))
      {
        cells.push_back(points);
      }
    }
    std::sort(cells.begin(), cells.end());
    return cells;
  };
  const auto left = beyond(triangles);
  const auto kept = beyond(cadtest::toMesh(half));
  EXPECT_FALSE(left.empty());
  EXPECT_TRUE(std::includes(kept.begin(), kept.end(), left.begin(), left.end()));
}

/// Nothing tells on which surface the triangles are that a curve bounds.
TEST(SurfaceInACurve, staysAsItIs)
{
  const cadtest::TemporaryFolder folder;
  const cadtest::FilterRun filters(cadtest::writeInto(folder, cadtest::circle(1), ".step"));
  const auto disc =
    filters.refineUniformly(filters.project(cadtest::toGrid(cadtest::discMesh(1, 0.02, 12))), 3);
  for (vtkIdType p = 0; p < disc->GetNumberOfPoints(); ++p)
  {
    double point[3];
    disc->GetPoint(p, point);
    const double fromRim = 1 - point[0] * point[0] - point[1] * point[1];
    disc->GetPoints()->SetPoint(
      p, point[0], point[1], fromRim < 1e-9 ? 0 : fromRim * std::cos(20 * point[0]));
  }
  const auto trianglesOf = [](vtkPointSet* data) { return cadtest::toMesh(data).triangles; };
  const auto coarse = filters.run<vtkCoarsenWithCAD>(disc, [](vtkCoarsenWithCAD*) {});
  EXPECT_EQ(trianglesOf(coarse), trianglesOf(disc));
  const auto improved = filters.run<vtkProjectOntoCAD>(
    disc, [](vtkProjectOntoCAD* filter) { filter->SetMinimumQuality(0.9); });
  EXPECT_EQ(trianglesOf(improved), trianglesOf(disc));
}

INSTANTIATE_TEST_SUITE_P(Parts, SurfacePart,
  testing::Values(
    Part{ "hammer_surface", "hammer.iges", 0.1 }, Part{ "bearing_surface", "bearing.iges", 0.1 }),
  [](const auto& test) { return std::string(test.param.name); });

} // namespace
