// Meshes of second order: their mid nodes lie on the CAD, their cells are valid, and their distance
// from the CAD falls at third order.

#include "CurvedFacets.h"
#include "DataSets.h"
#include "QuadraticRuns.h"
#include "TestMeshes.h"
#include "TestShapes.h"

#include <gtest/gtest.h>
#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace
{

using namespace cadrefine;

constexpr double pi = 3.14159265358979323846;

/// A solid with its coarse mesh and its closed forms.
struct Solid
{
  std::string name;
  TopoDS_Shape shape;
  vtkSmartPointer<vtkPointSet> mesh;
  double volume;
  double (*distance)(const Point3&);
};

double distanceToSphere(const Point3& p)
{
  return std::abs(norm(p) - 2);
}

double distanceToTorus(const Point3& p)
{
  return std::abs(std::hypot(std::hypot(p[0], p[1]) - 3, p[2]) - 1);
}

Solid ball()
{
  return { "Ball", cadtest::sphere(2), cadtest::toGrid(cadtest::ballMesh(2, 0.03)), 32 * pi / 3,
    distanceToSphere };
}

Solid solidTorus()
{
  return { "Torus", cadtest::torus(3, 1), cadtest::toGrid(cadtest::torusMesh(3, 1, 12, 6)),
    6 * pi * pi, distanceToTorus };
}

/// With a tetrahedron that has two facets on the sphere: some mid nodes stop on the way.
Solid coarseBall()
{
  return { "CoarseBall", cadtest::sphere(2), cadtest::readGrid(CADREFINE_DATA "/ball_coarse.vtu"),
    32 * pi / 3, distanceToSphere };
}

double largestValue(vtkDataArray* array)
{
  double largest = 0;
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    largest = std::max(largest, array->GetTuple1(i));
  }
  return largest;
}

/// All cells are of second order and valid, by the filter and by sampling; what has stopped on the
/// way is counted.
void expectSound(const cadtest::FilterRun& filters, vtkPointSet* data)
{
  EXPECT_EQ(cadtest::fieldValue(data, "InvalidCells"), 0);
  const auto checked = filters.run<vtkMeshValidity>(data, [](vtkMeshValidity*) {});
  EXPECT_EQ(cadtest::fieldValue(checked, "InvalidCells"), 0);
  EXPECT_GT(cadtest::smallestJacobian(data), 0);
  vtkDataArray* distances = data->GetPointData()->GetArray("CADDistance");
  std::int64_t off = 0;
  for (vtkIdType p = 0; p < distances->GetNumberOfTuples(); ++p)
  {
    off += distances->GetTuple1(p) > 0;
  }
  EXPECT_EQ(cadtest::fieldValue(data, "UnprojectedVertices"), off);
}

class QuadraticSolid : public testing::TestWithParam<Solid (*)()>
{
protected:
  Solid solid = GetParam()();
  cadtest::TemporaryFolder folder;
  cadtest::FilterRun filters{ cadtest::writeInto(folder, solid.shape, ".step") };
};

INSTANTIATE_TEST_SUITE_P(Solids, QuadraticSolid, testing::Values(ball, solidTorus),
  [](const auto& solid) { return solid.param().name; });

TEST_P(QuadraticSolid, distanceFallsAtThirdOrderOverThreeLevels)
{
  const auto projected = filters.project(solid.mesh);
  double distanceBefore = 0;
  double deficitBefore = 0;
  for (int level = 1; level <= 3; ++level)
  {
    const auto data = cadtest::refineToQuadratic(filters, projected, level);
    expectSound(filters, data);
    EXPECT_EQ(cadtest::fieldValue(data, "UnprojectedVertices"), 0);
    const auto facets = cadtest::outerFacets(data);
    for (const auto& nodes : facets)
    {
      for (const Point3& node : nodes)
      {
        EXPECT_LE(solid.distance(node), 1e-11);
      }
    }
    const double distance = cadtest::largestOn(facets, solid.distance);
    const double deficit = solid.volume - cadtest::volumeInside(facets);
    EXPECT_GT(deficit, 0);
    if (level > 1)
    {
      EXPECT_GT(std::log2(distanceBefore / distance), 2.8) << "level " << level;
      EXPECT_GT(std::log2(deficitBefore / deficit), 3.8) << "level " << level;
    }
    distanceBefore = distance;
    deficitBefore = deficit;
  }
}

/// The error is the volume between the curved facets and the CAD, to which it converges like
/// 4^-depth; its distance is the largest that dense sampling finds.
TEST_P(QuadraticSolid, errorIsTheVolumeBetween)
{
  const auto data = cadtest::refineToQuadratic(filters, filters.project(solid.mesh), 1);
  const auto facets = cadtest::outerFacets(data);
  const double volume = cadtest::integralOver(facets, solid.distance);
  double before = 0;
  for (int depth = 1; depth <= 4; ++depth)
  {
    const auto measured = filters.measure(data, depth);
    EXPECT_EQ(measured->GetNumberOfPoints(), data->GetNumberOfPoints());
    EXPECT_EQ(measured->GetCellType(0), VTK_QUADRATIC_TETRA);
    const double missing = volume - cadtest::fieldValue(measured, "GlobalGeometricError");
    EXPECT_GT(missing, -0.002 * volume);
    EXPECT_LT(missing, depth == 1 ? 0.35 * volume : 0.35 * before) << "depth " << depth;
    before = std::max(missing, 0.01 * volume);
    const double farthest = cadtest::largestOn(facets, solid.distance);
    EXPECT_NEAR(
      cadtest::fieldValue(measured, "MaximumGeometricDistance"), farthest, 0.1 * farthest);
    EXPECT_EQ(cadtest::fieldValue(measured, "MaximumGeometricDistance"),
      largestValue(measured->GetCellData()->GetArray("GeometricDistance")));
  }
  if (solid.name == "Ball") // All facets lie inside.
  {
    const double deficit = solid.volume - cadtest::volumeInside(facets);
    EXPECT_NEAR(cadtest::fieldValue(filters.measure(data, 4), "GlobalGeometricError"), deficit,
      0.006 * deficit);
  }
}

/// The points of a mesh that lie on the CAD, in an order of their own.
std::set<Point3> pointsOnCAD(vtkPointSet* data)
{
  std::set<Point3> points;
  vtkDataArray* dimensions = data->GetPointData()->GetArray("CADDimension");
  for (vtkIdType p = 0; p < data->GetNumberOfPoints(); ++p)
  {
    Point3 point;
    data->GetPoint(p, point.data());
    if (dimensions->GetTuple1(p) >= 0)
    {
      points.insert(point);
    }
  }
  return points;
}

/// Levels 0 gives the mesh as it is its mid nodes: where one more level has its vertices.
TEST_P(QuadraticSolid, nodesOnTheCADAreTheVerticesOfTheNextLevel)
{
  const auto projected = filters.project(solid.mesh);
  const auto data = cadtest::refineToQuadratic(filters, projected, 0);
  expectSound(filters, data);
  EXPECT_EQ(data->GetNumberOfCells(), solid.mesh->GetNumberOfCells());
  const auto next = filters.refineUniformly(projected);
  EXPECT_EQ(data->GetNumberOfPoints(), next->GetNumberOfPoints());
  EXPECT_EQ(pointsOnCAD(data), pointsOnCAD(next));
}

/// The error is that of the straight cells. (On the torus, whose facets cross it, the error of
/// first order lets the volumes on both sides of a facet cancel, that of second order those of its
/// parts.)
TEST_P(QuadraticSolid, straightRefinementLeavesNodesInTheMiddle)
{
  const auto projected = filters.project(solid.mesh);
  const auto data = filters.run<vtkRefineWithCAD>(projected,
    [](vtkRefineWithCAD* filter)
    {
      filter->SetLevels(0);
      filter->ProjectNewVerticesOff();
      filter->QuadraticCellsOn();
    });
  EXPECT_NEAR(cadtest::smallestJacobian(data), 1, 1e-9);
  const double straight =
    cadtest::fieldValue(filters.measure(projected, 6), "GlobalGeometricError");
  EXPECT_NEAR(cadtest::fieldValue(filters.measure(data, 5), "GlobalGeometricError"), straight,
    (solid.name == "Ball" ? 0.002 : 0.03) * straight);
}

/// Tetrahedra with three edges on the sphere at a corner are flat there in the limit, and one whose
/// edges alone lie on the sphere is thinner than the sphere is high over them.
TEST(QuadraticCells, stayValidWhereNodesCannotReachTheCAD)
{
  const Solid solid = coarseBall();
  const cadtest::TemporaryFolder folder;
  const cadtest::FilterRun filters(cadtest::writeInto(folder, solid.shape, ".step"));
  constexpr int cutOnly = vtkRefineWithCAD::CUT_ONLY;
  auto projected = filters.moveOntoCAD(solid.mesh);
  double off = 0;
  for (int level = 0; level <= 2; ++level)
  {
    const auto data = cadtest::refineToQuadratic(filters, projected, level, cutOnly);
    expectSound(filters, data);
    off += cadtest::fieldValue(data, "UnprojectedVertices");
    EXPECT_LE(cadtest::fieldValue(data, "UnprojectedVertices"),
      level == 0 ? 20 : 0.002 * cadtest::fieldValue(data, "CADVertices"));
    EXPECT_NEAR(cadtest::fieldValue(filters.measure(data, 2), "MaximumGeometricDistance"),
      std::max(largestValue(data->GetPointData()->GetArray("CADDistance")),
        cadtest::largestOn(cadtest::outerFacets(data), solid.distance)),
      0.1 * cadtest::largestOn(cadtest::outerFacets(data), solid.distance));
  }
  EXPECT_GT(off, 0);

  const auto changed = filters.project(solid.mesh);
  for (int level = 0; level <= 2; ++level)
  {
    const auto data = cadtest::refineToQuadratic(filters, changed, level);
    expectSound(filters, data);
    EXPECT_EQ(cadtest::fieldValue(data, "UnprojectedVertices"), 0);
  }
}

/// A circle: the deficit of parabolas falls at fourth order, and the filter finds it.
TEST(QuadraticCells, inThePlaneConvergeToTheCircle)
{
  const cadtest::TemporaryFolder folder;
  const cadtest::FilterRun filters(cadtest::writeInto(folder, cadtest::circle(2), ".brep"));
  const auto projected = filters.project(cadtest::toGrid(cadtest::discMesh(2, 0.02, 9)));
  double before = 0;
  for (int level = 1; level <= 3; ++level)
  {
    const auto data = cadtest::refineToQuadratic(filters, projected, level);
    expectSound(filters, data);
    EXPECT_EQ(data->GetCellType(0), VTK_QUADRATIC_TRIANGLE);
    EXPECT_EQ(cadtest::fieldValue(data, "UnprojectedVertices"), 0);
    const auto measured = filters.measure(data, 5);
    const double deficit = 4 * pi - cadtest::areaOf(data);
    EXPECT_EQ(cadtest::fieldValue(measured, "GeometricErrorDimension"), 2);
    EXPECT_NEAR(cadtest::fieldValue(measured, "GlobalGeometricError"), deficit, 0.01 * deficit);
    if (level > 1)
    {
      EXPECT_GT(std::log2(before / deficit), 3.8) << "level " << level;
    }
    before = deficit;
  }
}

/// Three arcs that meet in corners, a square round them: nodes lie on their own arc.
TEST(QuadraticCells, inThePlaneFollowThreeArcs)
{
  const cadtest::FilterRun filters(CADREFINE_DATA "/three_arcs.igs");
  const auto projected =
    filters.project(cadtest::readGrid(CADREFINE_DATA "/three_arcs_coarse.vtu"));
  double before = 0;
  for (int level = 1; level <= 3; ++level)
  {
    const auto data = cadtest::refineToQuadratic(filters, projected, level);
    expectSound(filters, data);
    EXPECT_EQ(cadtest::fieldValue(data, "UnprojectedVertices"), 0);
    const double distance =
      cadtest::fieldValue(filters.measure(data, 3), "MaximumGeometricDistance");
    if (level > 1)
    {
      EXPECT_GT(std::log2(before / distance), 2.8) << "level " << level;
    }
    before = distance;
  }
}

/// A surface in space: triangles in an unstructured grid.
TEST(QuadraticCells, ofASurfaceConvergeToTheSphere)
{
  cadtest::expectConvergenceToTheSphere(
    cadtest::toGrid(cadtest::sphereMesh(2, 0.03)), VTK_QUADRATIC_TRIANGLE);
}

/// A ball with tags on its surface, and arrays.
class QuadraticArrays : public testing::Test
{
protected:
  cadtest::TemporaryFolder folder;
  cadtest::FilterRun filters{ cadtest::writeInto(folder, cadtest::sphere(2), ".step") };
  vtkSmartPointer<vtkUnstructuredGrid> mesh = makeMesh();
  cadtest::FilterRun::Data projected = filters.project(mesh);
  cadtest::FilterRun::Data data = cadtest::refineToQuadratic(filters, projected, 1);

  static vtkSmartPointer<vtkUnstructuredGrid> makeMesh()
  {
    Mesh ball = cadtest::ballMesh(2, 0.03);
    ball.triangles = cadtest::sphereMesh(2, 0.03).triangles;
    ball.segments = { { ball.triangles[0][0], ball.triangles[0][1] } };
    ball.vertices = { { 3 } };
    auto grid = cadtest::toGrid(ball);
    cadtest::addArrays(grid);
    return grid;
  }
};

TEST_F(QuadraticArrays, cellsOfLowerDimensionShareTheNodes)
{
  std::set<std::set<vtkIdType>> faces;
  std::map<int, int> count;
  for (vtkIdType c = data->GetNumberOfCells() - 1; c >= 0; --c)
  {
    vtkCell* cell = data->GetCell(c);
    ++count[cell->GetCellType()];
    const auto pointsOf = [](vtkCell* each)
    { return std::set<vtkIdType>(each->GetPointIds()->begin(), each->GetPointIds()->end()); };
    for (int f = 0; f < cell->GetNumberOfFaces(); ++f)
    {
      faces.insert(pointsOf(cell->GetFace(f)));
    }
    if (cell->GetCellType() == VTK_QUADRATIC_TRIANGLE)
    {
      EXPECT_EQ(faces.count(pointsOf(cell)), 1u);
    }
  }
  const std::map<int, int> expected{ { VTK_VERTEX, 1 }, { VTK_QUADRATIC_EDGE, 2 },
    { VTK_QUADRATIC_TRIANGLE, 80 }, { VTK_QUADRATIC_TETRA, 160 } };
  EXPECT_EQ(count, expected);
}

TEST_F(QuadraticArrays, areInterpolatedToNodesAndKeptForCells)
{
  const auto linear = filters.refineUniformly(projected);
  vtkDataArray* tags = data->GetCellData()->GetArray("Tag");
  ASSERT_EQ(tags->GetNumberOfTuples(), data->GetNumberOfCells());
  for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c)
  {
    EXPECT_EQ(tags->GetTuple1(c), linear->GetCellData()->GetArray("Tag")->GetTuple1(c));
  }
  vtkDataArray* values = data->GetPointData()->GetArray("Linear");
  std::set<double> ids;
  for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c)
  {
    vtkCell* cell = data->GetCell(c);
    for (int e = 0; cell->GetCellDimension() == 3 && e < cell->GetNumberOfEdges(); ++e)
    {
      vtkIdList* nodes = cell->GetEdge(e)->GetPointIds();
      EXPECT_NEAR(values->GetTuple1(nodes->GetId(2)),
        (values->GetTuple1(nodes->GetId(0)) + values->GetTuple1(nodes->GetId(1))) / 2, 1e-13);
    }
  }
  for (vtkIdType p = 0; p < data->GetNumberOfPoints(); ++p)
  {
    ids.insert(data->GetPointData()->GetGlobalIds()->GetTuple1(p));
  }
  EXPECT_EQ(ids.size(), static_cast<std::size_t>(data->GetNumberOfPoints()));
  EXPECT_EQ(cadtest::fieldValue(data, "GlobalVertices"), data->GetNumberOfPoints());
}

/// Written and read again, also without global ids, it is the same to the filters.
TEST_F(QuadraticArrays, areReadBack)
{
  vtkNew<vtkUnstructuredGrid> copy;
  copy->ShallowCopy(data);
  copy->GetPointData()->SetGlobalIds(nullptr);
  copy->GetCellData()->SetGlobalIds(nullptr);
  const std::string path = folder.file("quadratic.vtu");
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputData(copy);
  writer->SetFileName(path.c_str());
  writer->SetDataModeToBinary();
  ASSERT_TRUE(writer->Write());
  const auto read = cadtest::readGrid(path);
  const auto before = filters.measure(data, 2);
  const auto after = filters.measure(read, 2);
  EXPECT_EQ(after->GetNumberOfPoints(), before->GetNumberOfPoints());
  for (const char* name : { "GlobalGeometricError", "MaximumGeometricDistance" })
  {
    EXPECT_GT(cadtest::fieldValue(before, name), 0);
    EXPECT_EQ(cadtest::fieldValue(after, name), cadtest::fieldValue(before, name)) << name;
  }
  const auto checked = filters.run<vtkMeshValidity>(read, [](vtkMeshValidity*) {});
  EXPECT_EQ(cadtest::fieldValue(checked, "GlobalVertices"), data->GetNumberOfPoints());
}

TEST_F(QuadraticArrays, aFoldedNodeIsFound)
{
  vtkIdType cell = data->GetNumberOfCells() - 1;
  const vtkIdType node = data->GetCell(cell)->GetPointId(4);
  const vtkIdType end = data->GetCell(cell)->GetPointId(0);
  double point[3];
  data->GetPoint(end, point);
  data->GetPoints()->SetPoint(node, point);
  const auto checked = filters.run<vtkMeshValidity>(data, [](vtkMeshValidity*) {});
  EXPECT_GT(cadtest::fieldValue(checked, "InvalidCells"), 0);
  EXPECT_EQ(checked->GetCellData()->GetArray("CellValidity")->GetTuple1(cell), 0);
  EXPECT_GT(checked->GetCellData()->GetArray("CellQuality")->GetTuple1(cell), 0);
}

/// Such a mesh is refused where it cannot be used, and told what to do.
class QuadraticRefused : public QuadraticArrays
{
protected:
  template<class Filter>
  void expectFailure(
    vtkPointSet* input, const std::string& reason, void (*configure)(Filter*) = [](Filter*) {})
  {
    const auto outcome = filters.attempt<Filter>(input, configure);
    EXPECT_FALSE(outcome.succeeded);
    ASSERT_EQ(outcome.errors.size(), 1u);
    EXPECT_NE(outcome.errors[0].find(reason), std::string::npos) << outcome.errors[0];
  }
};

TEST_F(QuadraticRefused, byRefinementAndProjection)
{
  expectFailure<vtkRefineWithCAD>(data, "choose Quadratic Cells in the last step");
  expectFailure<vtkProjectOntoCAD>(data, "choose Quadratic Cells in the last step");
}

TEST_F(QuadraticRefused, asPolyData)
{
  const auto surface = filters.project(cadtest::toPolyData(cadtest::sphereMesh(2, 0.03)));
  expectFailure<vtkRefineWithCAD>(surface, "poly data cannot hold quadratic cells",
    [](vtkRefineWithCAD* filter) { filter->QuadraticCellsOn(); });
}

TEST_F(QuadraticRefused, withCellsOfFirstOrder)
{
  const vtkIdType line[2] = { 0, 1 };
  vtkUnstructuredGrid::SafeDownCast(data)->InsertNextCell(VTK_LINE, 2, line);
  data->GetCellData()->Initialize();
  expectFailure<vtkMeshValidity>(data, "mixes linear and quadratic cells");
}

TEST_F(QuadraticRefused, withTwoNodesOnAnEdge)
{
  vtkIdList* nodes = data->GetCell(data->GetNumberOfCells() - 1)->GetPointIds();
  const vtkIdType edge[3] = { nodes->GetId(0), nodes->GetId(1), nodes->GetId(9) };
  vtkUnstructuredGrid::SafeDownCast(data)->InsertNextCell(VTK_QUADRATIC_EDGE, 3, edge);
  data->GetCellData()->Initialize();
  expectFailure<vtkMeshValidity>(data, "different mid-edge nodes on an edge");
}

} // namespace
