// The geometric error of quadrilateral facets against closed forms, and the validity of cells that
// are not simplices.

#include "DataSets.h"
#include "FilterRun.h"
#include "MeshChecks.h"
#include "MixedMeshes.h"
#include "TestShapes.h"

#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace
{

using namespace cadrefine;

constexpr double pi = 3.14159265358979323846;

/// Quadrilaterals become hexahedra, triangles wedges.
Mesh extruded(const Mesh& flat, double height)
{
  Mesh mesh;
  mesh.points = flat.points;
  const auto count = static_cast<Index>(flat.points.size());
  for (const Point3& point : flat.points)
  {
    mesh.points.push_back(point + Vector3{ 0, 0, height });
  }
  mesh.ids.resize(mesh.points.size());
  for (const auto& [a, b, c, d] : flat.quadrilaterals)
  {
    mesh.hexahedra.push_back({ a, b, c, d, a + count, b + count, c + count, d + count });
  }
  for (const auto& [a, b, c] : flat.triangles)
  {
    mesh.wedges.push_back({ a, b, c, a + count, b + count, c + count });
  }
  return mesh;
}

class MixedError : public testing::Test
{
protected:
  cadtest::TemporaryFolder folder;

  cadtest::FilterRun on(const TopoDS_Shape& shape) const
  {
    return cadtest::FilterRun(cadtest::writeInto(folder, shape, ".brep"));
  }
};

TEST_F(MixedError, ofAPipeIsThatOfItsPolygons)
{
  const int corners = 12;
  const auto filters = on(cadtest::pipe(2, 6, 1));
  auto mesh = filters.project(
    cadtest::toGrid(extruded(cadtest::quadrilateralRingMesh(2, 0.005, corners, { 0.3, 1 }), 1)));
  const int depth = 3;
  const double found = 1 - std::pow(4, -depth); // of the gap under arcs, by that recursion
  for (int level = 0; level < 3; ++level)
  {
    const int n = corners << level;
    const double gap = pi - 0.5 * n * std::sin(2 * pi / n); // of the polygon in the unit circle
    const auto measured = filters.measure(mesh, depth);
    EXPECT_NEAR(
      cadtest::fieldValue(measured, "GlobalGeometricError"), found * 40 * gap, 0.001 * 40 * gap)
      << level;
    EXPECT_NEAR(
      cadtest::fieldValue(measured, "MaximumGeometricDistance"), 6 * (1 - std::cos(pi / n)), 1e-9)
      << level;
    const Mesh now = cadtest::toMesh(mesh);
    EXPECT_TRUE(cadtest::isValid(now));
    EXPECT_NEAR(cadtest::measureOf(now), (36 - 4) * (pi - gap), 1e-9);
    mesh = filters.refineUniformly(mesh);
  }
}

TEST_F(MixedError, ofABallIsItsMissingVolumeAndFallsByFour)
{
  const auto filters = on(cadtest::sphere(2));
  auto mesh = filters.project(cadtest::toGrid(cadtest::hexahedralBallMesh(2, 0.01, 2, { 1 })));
  double before = 0;
  for (int level = 0; level < 3; ++level)
  {
    const double missing = 32 * pi / 3 - cadtest::measureOf(cadtest::toMesh(mesh));
    const double error = cadtest::fieldValue(filters.measure(mesh, 3), "GlobalGeometricError");
    EXPECT_NEAR(error, missing, 0.02 * missing) << level;
    if (level > 1)
    {
      EXPECT_GT(before / error, 3.6) << level;
      EXPECT_LT(before / error, 4.2) << level;
    }
    before = error;
    mesh = filters.refineUniformly(mesh);
  }
}

/// One cell of any type, at these points.
vtkSmartPointer<vtkUnstructuredGrid> oneCell(int type, const std::vector<Point3>& corners)
{
  Mesh mesh;
  mesh.points = corners;
  auto grid = cadtest::toGrid(mesh);
  std::vector<vtkIdType> points;
  for (std::size_t k = 0; k < corners.size(); ++k)
  {
    points.push_back(static_cast<vtkIdType>(k));
  }
  grid->InsertNextCell(type, static_cast<vtkIdType>(points.size()), points.data());
  return grid;
}

struct Found
{
  double validity;
  double quality;
  double invalidCells;
};

Found validityOf(int type, const std::vector<Point3>& corners)
{
  const cadtest::FilterRun filters(nullptr);
  const auto mesh = filters.run<vtkMeshValidity>(oneCell(type, corners), [](vtkMeshValidity*) {});
  return { mesh->GetCellData()->GetArray("CellValidity")->GetTuple1(0),
    mesh->GetCellData()->GetArray("CellQuality")->GetTuple1(0),
    cadtest::fieldValue(mesh, "InvalidCells") };
}

const std::vector<Point3> cube{ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 },
  { 1, 0, 1 }, { 1, 1, 1 }, { 0, 1, 1 } };
const std::vector<Point3> prism{ { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, std::sqrt(0.75), 0 }, { 0, 0, 1 },
  { 1, 0, 1 }, { 0.5, std::sqrt(0.75), 1 } };
const std::vector<Point3> pyramid{ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 },
  { 0.5, 0.5, std::sqrt(0.5) } };
const std::vector<Point3> square{ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } };

TEST(MixedValidity, idealCellsHaveQualityOne)
{
  for (const auto& [type, corners] : { std::pair(VTK_HEXAHEDRON, cube), std::pair(VTK_WEDGE, prism),
         std::pair(VTK_PYRAMID, pyramid), std::pair(VTK_QUAD, square) })
  {
    const Found found = validityOf(type, corners);
    EXPECT_EQ(found.validity, 1) << type;
    EXPECT_NEAR(found.quality, 1, 1e-14) << type;
    EXPECT_EQ(found.invalidCells, 0) << type;
  }
}

TEST(MixedValidity, invertedCellsAreNotValid)
{
  for (const auto& [type, corners] :
    { std::pair(VTK_HEXAHEDRON, cube), std::pair(VTK_PYRAMID, pyramid) })
  {
    auto inverted = corners;
    for (Point3& point : inverted)
    {
      point[2] = -point[2];
    }
    const Found found = validityOf(type, inverted);
    EXPECT_EQ(found.validity, 0) << type;
    EXPECT_LT(found.quality, 0) << type;
    EXPECT_EQ(found.invalidCells, 1) << type;
  }
  // A wedge alone is valid either way round: nothing tells which order its file has.
  auto other = prism;
  std::rotate(other.begin(), other.begin() + 3, other.end());
  EXPECT_EQ(validityOf(VTK_WEDGE, other).validity, 1);
  // One that is twisted is not.
  std::swap(other[0], other[1]);
  EXPECT_EQ(validityOf(VTK_WEDGE, other).validity, 0);
}

/// Its upper side is turned by half a turn and stretched: all corners are positive, but it folds
/// between.
TEST(MixedValidity, foldedHexahedronWithPositiveCornersHasQualityZero)
{
  std::vector<Point3> folded = cube;
  for (int k = 0; k < 4; ++k)
  {
    folded[4 + k] = { 0.5 - (cube[k][0] - 0.5), 0.5 - 4 * (cube[k][1] - 0.5), 1 };
  }
  const Found found = validityOf(VTK_HEXAHEDRON, folded);
  EXPECT_EQ(found.validity, 0);
  EXPECT_EQ(found.quality, 0);
  EXPECT_EQ(found.invalidCells, 1);
}

TEST(MixedValidity, foldedQuadrilateralsAreNotValid)
{
  std::vector<Point3> bow = square;
  std::swap(bow[1], bow[2]);
  EXPECT_EQ(validityOf(VTK_QUAD, bow).validity, 0);
  std::vector<Point3> dart = square;
  dart[2] = { 0.3, 0.3, 0 };
  EXPECT_EQ(validityOf(VTK_QUAD, dart).validity, 0);
  EXPECT_LT(validityOf(VTK_QUAD, dart).quality, 0);
}

} // namespace
