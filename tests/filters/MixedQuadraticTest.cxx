// Hexahedra, wedges, pyramids and quadrilaterals of second order: closed forms, and validity by
// sampling with VTK's shape functions.

#include "BlockMeshes.h"
#include "DataSets.h"
#include "MixedMeshes.h"
#include "QuadraticRuns.h"
#include "TestShapes.h"

#include <cadrefine/base/Vector3.h>

#include <gtest/gtest.h>
#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace
{

using namespace cadrefine;

constexpr double pi = 3.14159265358979323846;

using Data = cadtest::FilterRun::Data;

std::map<int, int> countTypes(vtkPointSet* data)
{
  std::map<int, int> count;
  for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c)
  {
    ++count[data->GetCellType(c)];
  }
  return count;
}

/// The largest distance of points that are classified.
double farthest(vtkPointSet* data, double (*distance)(const Point3&))
{
  vtkDataArray* dimensions = data->GetPointData()->GetArray("CADDimension");
  double largest = 0;
  for (vtkIdType p = 0; p < data->GetNumberOfPoints(); ++p)
  {
    Point3 point;
    data->GetPoint(p, point.data());
    if (dimensions->GetTuple1(p) >= 0)
    {
      largest = std::max(largest, distance(point));
    }
  }
  return largest;
}

struct Case
{
  std::string name;
  TopoDS_Shape (*shape)();
  cadtest::Grid (*mesh)();
  double size;
  double (*distance)(const Point3&);
  std::map<int, int> types; ///< Of the cells.
  bool documented = false;
};

double distanceToSphere(const Point3& p)
{
  return std::abs(norm(p) - 2);
}

/// Of height 3, on the sides z = 0 and z = 3 too.
double distanceToCylinder(const Point3& p)
{
  return std::min({ std::abs(std::hypot(p[0], p[1]) - 2), std::abs(p[2]), std::abs(p[2] - 3) });
}

double distanceToCircle(const Point3& p)
{
  return std::abs(std::hypot(p[0], p[1]) - 2);
}

TopoDS_Shape sphere()
{
  return cadtest::sphere(2);
}

TopoDS_Shape cylinder()
{
  return cadtest::cylinder(2, 3);
}

TopoDS_Shape circle()
{
  return cadtest::circle(2);
}

const Case cases[] = {
  { "Ball", sphere,
    [] {
      return cadtest::toGrid(cadtest::hexahedralBallMesh(2, 0.02, 2, { 0.6, 1 }));
    },
    32 * pi / 3, distanceToSphere, { { VTK_QUADRATIC_HEXAHEDRON, 56 } } },
  { "BallWithPyramids", sphere, [] { return cadtest::ballWithPyramids(2); }, 32 * pi / 3,
    distanceToSphere, { { VTK_QUADRATIC_HEXAHEDRON, 6 }, { VTK_QUADRATIC_PYRAMID, 6 } } },
  { "Cylinder", cylinder, [] { return cadtest::cylinderOfWedges(2, 3, 8, 2, false); }, 12 * pi,
    distanceToCylinder, { { VTK_QUADRATIC_WEDGE, 16 } } },
  { "DocumentedWedges", cylinder, [] { return cadtest::cylinderOfWedges(2, 3, 8, 2, true); },
    12 * pi, distanceToCylinder, { { VTK_QUADRATIC_WEDGE, 16 } }, true },
  { "Disc", circle, [] { return cadtest::discOfQuadrilaterals(2); }, 4 * pi, distanceToCircle,
    { { VTK_QUADRATIC_QUAD, 12 } } },
};

class MixedQuadratic : public testing::TestWithParam<Case>
{
protected:
  const Case& problem = GetParam();
  cadtest::TemporaryFolder folder;
  cadtest::FilterRun filters{ cadtest::writeInto(folder, problem.shape(), ".brep") };
};

INSTANTIATE_TEST_SUITE_P(Shapes, MixedQuadratic, testing::ValuesIn(cases),
  [](const auto& each) { return each.param.name; });

/// All cells are valid, by the filters and by sampling.
void expectValid(const cadtest::FilterRun& filters, vtkPointSet* data, bool documented = false)
{
  EXPECT_EQ(cadtest::fieldValue(data, "InvalidCells"), 0);
  EXPECT_GT(cadtest::smallestSample(data, documented), 0);
  const auto checked = filters.run<vtkMeshValidity>(data, [](vtkMeshValidity*) {});
  EXPECT_EQ(cadtest::fieldValue(checked, "InvalidCells"), 0);
}

/// The volume between the curved cells and the CAD falls at fourth order, and the filter finds it.
TEST_P(MixedQuadratic, volumeConvergesAtFourthOrder)
{
  const auto projected = filters.project(problem.mesh());
  EXPECT_EQ(countTypes(cadtest::refineToQuadratic(filters, projected, 0)), problem.types);
  double before = 0;
  for (int level = 0; level <= 2; ++level)
  {
    const auto data = cadtest::refineToQuadratic(filters, projected, level);
    expectValid(filters, data, problem.documented);
    EXPECT_EQ(cadtest::fieldValue(data, "UnprojectedVertices"), 0);
    EXPECT_LT(farthest(data, problem.distance), 1e-11);
    const double deficit = problem.size - cadtest::sizeOf(data);
    EXPECT_GT(deficit, 0);
    EXPECT_NEAR(cadtest::fieldValue(filters.measure(data, 4), "GlobalGeometricError"), deficit,
      0.01 * deficit);
    if (level > 0)
    {
      EXPECT_GT(std::log2(before / deficit), 3.8) << "level " << level;
    }
    before = deficit;
  }
}

/// By parts of its parameters it converges like 4^-depth to what it is at depth 5.
TEST_P(MixedQuadratic, errorConvergesWithTheDepth)
{
  const auto data = cadtest::refineToQuadratic(filters, filters.project(problem.mesh()), 1);
  const auto errorAt = [&](int depth)
  { return cadtest::fieldValue(filters.measure(data, depth), "GlobalGeometricError"); };
  const double most = errorAt(5);
  double before = most - errorAt(1);
  for (int depth = 2; depth <= 3; ++depth)
  {
    const double missing = most - errorAt(depth);
    EXPECT_NEAR(before / missing, 4.2, 0.5) << "depth " << depth;
    before = missing;
  }
}

/// Cells take along what they hold.
TEST_P(MixedQuadratic, densitiesKeepTheirIntegral)
{
  const auto projected = filters.project(problem.mesh());
  vtkNew<vtkDoubleArray> density;
  density->SetName("Density");
  for (vtkIdType c = 0; c < projected->GetNumberOfCells(); ++c)
  {
    density->InsertNextValue(1 + static_cast<double>(c % 3));
  }
  projected->GetCellData()->AddArray(density);
  const auto data = filters.run<vtkRefineWithCAD>(projected,
    [](vtkRefineWithCAD* filter)
    {
      filter->SetLevels(0);
      filter->QuadraticCellsOn();
      filter->AddConservedArray("Density");
    });
  const double before = cadtest::sizeOf(projected, "Density");
  EXPECT_GT(std::abs(cadtest::sizeOf(data) / cadtest::sizeOf(projected) - 1), 0.01);
  EXPECT_NEAR(cadtest::sizeOf(data, "Density"), before, 1e-12 * before);
}

/// Written and read again, without global ids, it is the same to the filters.
TEST_P(MixedQuadratic, isReadBack)
{
  const auto data = cadtest::refineToQuadratic(filters, filters.project(problem.mesh()), 1);
  vtkNew<vtkUnstructuredGrid> copy;
  copy->ShallowCopy(data);
  copy->GetPointData()->SetGlobalIds(nullptr);
  copy->GetCellData()->SetGlobalIds(nullptr);
  const std::string path = folder.file("mixed.vtu");
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputData(copy);
  writer->SetFileName(path.c_str());
  ASSERT_TRUE(writer->Write());
  const auto read = cadtest::readGrid(path);
  expectValid(filters, read, problem.documented);
  const auto before = filters.measure(data, 2);
  const auto after = filters.measure(read, 2);
  EXPECT_EQ(countTypes(after), countTypes(data));
  EXPECT_EQ(after->GetNumberOfPoints(), before->GetNumberOfPoints());
  EXPECT_EQ(cadtest::sizeOf(after), cadtest::sizeOf(data));
  for (const char* name : { "GlobalGeometricError", "MaximumGeometricDistance" })
  {
    EXPECT_EQ(cadtest::fieldValue(after, name), cadtest::fieldValue(before, name)) << name;
  }
}

/// Sides on the CAD as cells: those of a volume are the cells' own faces, with their nodes.
TEST_P(MixedQuadratic, boundaryCellsAreQuadraticToo)
{
  const auto data = cadtest::refineToQuadratic(filters, filters.project(problem.mesh()), 0);
  const auto withBoundary = filters.run<vtkCADGeometricError>(
    data, [](vtkCADGeometricError* filter) { filter->SetBoundaryCells(true); });
  using Points = std::set<vtkIdType>;
  const auto pointsOf = [](vtkCell* cell)
  { return Points(cell->GetPointIds()->begin(), cell->GetPointIds()->end()); };
  std::set<Points> sides;
  for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c)
  {
    vtkCell* cell = data->GetCell(c);
    const bool isSolid = cell->GetCellDimension() == 3;
    for (int f = 0; f < (isSolid ? cell->GetNumberOfFaces() : cell->GetNumberOfEdges()); ++f)
    {
      sides.insert(pointsOf(isSolid ? cell->GetFace(f) : cell->GetEdge(f)));
    }
  }
  vtkIdType found = 0;
  for (vtkIdType c = 0; c < withBoundary->GetNumberOfCells(); ++c)
  {
    found += sides.count(pointsOf(withBoundary->GetCell(c))) > 0;
  }
  EXPECT_EQ(found, withBoundary->GetNumberOfCells() - data->GetNumberOfCells());
  EXPECT_GT(found, 0);
}

/// A surface in space: quadrilaterals in an unstructured grid.
TEST(MixedQuadraticCells, ofASurfaceConvergeToTheSphere)
{
  cadtest::expectConvergenceToTheSphere(cadtest::sphereOfQuadrilaterals(2), VTK_QUADRATIC_QUAD);
}

/// Pyramids on the CAD keep straight edges: what they lack is counted and measured.
TEST(MixedQuadraticCells, pyramidsStayStraight)
{
  const cadtest::TemporaryFolder folder;
  const cadtest::FilterRun filters(cadtest::writeInto(folder, cadtest::sphere(2), ".step"));
  const auto projected = filters.project(cadtest::cubeOfPyramids(2));
  const auto data = cadtest::refineToQuadratic(filters, projected, 0);
  expectValid(filters, data);
  EXPECT_EQ(cadtest::fieldValue(data, "UnprojectedVertices"), 12); // the cube's edges
  EXPECT_NEAR(cadtest::sizeOf(data), cadtest::sizeOf(projected), 1e-13);
  const double deficit = 32 * pi / 3 - cadtest::sizeOf(data);
  EXPECT_NEAR(
    cadtest::fieldValue(filters.measure(data, 4), "GlobalGeometricError"), deficit, 0.01 * deficit);
}

/// Balls of all shapes, and layers thinner than the sphere is high over their facets: nodes stop on
/// the way, and no cell is ever invalid.
TEST(MixedQuadraticCells, stayValidWhereNodesCannotReachTheCAD)
{
  const cadtest::TemporaryFolder folder;
  const cadtest::FilterRun filters(cadtest::writeInto(folder, cadtest::sphere(2), ".step"));
  // Its thin layers go along.
  const Mesh shell = cadtest::hexahedralShellMesh(2, 0, 1, { 0.02, 0.1, 0.5 });
  const auto layers =
    cadtest::refineToQuadratic(filters, filters.project(cadtest::toGrid(shell)), 0);
  expectValid(filters, layers);
  EXPECT_EQ(cadtest::fieldValue(layers, "UnprojectedVertices"), 0);

  std::vector<Mesh> meshes;
  for (const unsigned seed : { 1, 2, 3 })
  {
    meshes.push_back(
      cadtest::randomlyMixedMesh(cadtest::hexahedralBallMesh(2, 0.02, 2, { 0.6, 1 }), seed));
  }
  for (const Mesh& mesh : meshes)
  {
    const auto data =
      cadtest::refineToQuadratic(filters, filters.project(cadtest::toGrid(mesh)), 0);
    expectValid(filters, data);
    EXPECT_GT(cadtest::fieldValue(data, "UnprojectedVertices"), 0);
    EXPECT_GT(
      cadtest::fieldValue(data, "CADVertices"), cadtest::fieldValue(data, "UnprojectedVertices"));
  }
}

TEST(MixedQuadraticCells, aFoldedNodeIsFound)
{
  const cadtest::TemporaryFolder folder;
  const cadtest::FilterRun filters(cadtest::writeInto(folder, cadtest::cylinder(2, 3), ".step"));
  const auto data = cadtest::refineToQuadratic(
    filters, filters.project(cadtest::cylinderOfWedges(2, 3, 8, 2, false)), 0);
  vtkIdList* nodes = data->GetCell(3)->GetPointIds();
  double end[3];
  data->GetPoint(nodes->GetId(0), end);
  data->GetPoints()->SetPoint(nodes->GetId(6), end);
  const auto checked = filters.run<vtkMeshValidity>(data, [](vtkMeshValidity*) {});
  EXPECT_EQ(checked->GetCellData()->GetArray("CellValidity")->GetTuple1(3), 0);
  EXPECT_EQ(checked->GetCellData()->GetArray("CellValidity")->GetTuple1(7), 1);
  EXPECT_LT(cadtest::smallestSample(data, false), 1e-14);
}

} // namespace
