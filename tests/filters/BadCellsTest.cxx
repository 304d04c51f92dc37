// Bad points and cells: a right result, or one error on all ranks that names the point or cell.

#include "BadMesh.h"
#include "DataSets.h"
#include "MeshChecks.h"
#include "TestMeshes.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTypeInt32Array.h>
#include <vtkTypeInt64Array.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace cadrefine
{

namespace
{

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

class BadCells : public BadMesh
{
protected:
  /// The ball, on the last rank alone.
  Grid ballOnLastRank() const { return isLast() ? ball() : Grid::New(); }

  /// That, with one more cell.
  Grid withCell(int type, const std::vector<vtkIdType>& points) const
  {
    Grid grid = ballOnLastRank();
    if (isLast())
    {
      grid->InsertNextCell(type, static_cast<vtkIdType>(points.size()), points.data());
    }
    return grid;
  }
};

TEST_F(BadCells, coordinatesThatAreNotFinite)
{
  for (const double bad : { nan, infinity, -infinity })
  {
    const Grid grid = ballOnLastRank();
    if (isLast())
    {
      grid->GetPoints()->SetPoint(5, 1, bad, 0);
    }
    expectErrors(allFilters(), grid, "not finite (point 5)");
  }
}

TEST_F(BadCells, coordinatesTooLargeForVolumes)
{
  expectLimitOfCoordinates(ballOnLastRank());
}

TEST_F(BadCells, pointsThatAreNotUsed)
{
  Grid whole = ball();
  cadtest::addArrays(whole);
  const auto piece = pieceOf(whole);
  piece->GetPoints()->InsertNextPoint(nan, infinity, 0);
  piece->GetPoints()->InsertNextPoint(1e300, 0, 0);
  for (int a = 0; a < piece->GetPointData()->GetNumberOfArrays(); ++a)
  {
    piece->GetPointData()->GetArray(a)->InsertNextTuple1(7);
    piece->GetPointData()->GetArray(a)->InsertNextTuple1(8);
  }
  expectSame(filtersOfRawMeshes(), piece, whole);
}

/// Without global ids: every cell has points of its own, at the same places.
TEST_F(BadCells, repeatedPointsAreOne)
{
  const Grid whole = ball();
  const Mesh mesh = cadtest::ballMesh(2, 0.03);
  Mesh apart = mesh;
  apart.points.clear();
  apart.tetrahedra.clear();
  for (const auto& cell : mesh.tetrahedra)
  {
    auto& corners = apart.tetrahedra.emplace_back();
    for (std::size_t k = 0; k < 4; ++k)
    {
      corners[k] = static_cast<Index>(apart.points.size());
      apart.points.push_back(mesh.points[cell[k]]);
    }
  }
  const Grid cells = cadtest::toGrid(apart);
  expectSame(filtersOfRawMeshes(), pieceOf(cells), whole);
}

TEST_F(BadCells, cellsThatNameAPointTwice)
{
  expectErrors(allFilters(), withCell(VTK_TETRA, { 0, 1, 2, 1 }),
    "cell 20 of the mesh has repeated or coincident points");
  expectErrors(allFilters(), withCell(VTK_TRIANGLE, { 3, 3, 2 }),
    "cell 20 of the mesh has repeated or coincident points");
}

TEST_F(BadCells, cellsThatNamePointsThatAreNotThere)
{
  const std::string reason = "refers to point 13, but there are 13 points";
  expectErrors(allFilters(), withCell(VTK_TETRA, { 0, 1, 2, 13 }), reason);
  expectErrors(
    allFilters(), withCell(VTK_TRIANGLE, { 0, -1, 2 }), "cell 20 of the mesh refers to point -1");
  expectErrors(allFilters(), withCell(VTK_TETRA, { 0, 1, 2, vtkIdType{ 1 } << 40 }),
    "refers to point 1099511627776");
}

TEST_F(BadCells, cellsWithTooFewOrTooManyPoints)
{
  expectErrors(allFilters(), withCell(VTK_TETRA, { 0, 1, 2 }),
    "cell 20 of the mesh has 3 points instead of 4");
  expectErrors(allFilters(), withCell(VTK_TRIANGLE, { 0, 1, 2, 3 }),
    "cell 20 of the mesh has 4 points instead of 3");
}

TEST_F(BadCells, listsOfCellsThatContradictThemselves)
{
  const Grid grid = ballOnLastRank();
  if (isLast())
  {
    grid->GetCells()->GetOffsetsArray64()->SetValue(3, 1000);
  }
  expectErrors(allFilters(), grid, "do not match its connectivity");
}

TEST_F(BadCells, otherTypesOfCells)
{
  expectErrors(allFilters(), withCell(VTK_BIQUADRATIC_QUAD, { 0, 1, 2, 3, 4, 5, 6, 7, 8 }),
    "biquadraticquad (cell 20)");
  expectErrors(allFilters(), withCell(VTK_PENTAGONAL_PRISM, { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9 }),
    "pentagonalprism (cell 20)");
  expectErrors(allFilters(), withCell(VTK_POLY_LINE, { 0, 1, 2 }), "polyline (cell 20)");
  expectErrors(allFilters(), withCell(VTK_LAGRANGE_TRIANGLE, { 0, 1, 2, 3, 4, 5 }),
    "lagrangetriangle (cell 20)");
}

TEST_F(BadCells, polyhedra)
{
  const Grid grid = ballOnLastRank();
  if (isLast())
  {
    const vtkIdType faces[] = { 3, 0, 1, 2, 3, 0, 1, 3, 3, 0, 2, 3, 3, 1, 2, 3 };
    const vtkIdType points[] = { 0, 1, 2, 3 };
    grid->InsertNextCell(VTK_POLYHEDRON, 4, points, 4, faces);
  }
  expectErrors(allFilters(), grid, "polyhedron (cell 20)");
}

/// Also where one rank has the one kind and another the other.
TEST_F(BadCells, quadraticAndLinearCellsTogether)
{
  const Grid grid = withCell(VTK_QUADRATIC_TETRA, { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9 });
  const std::string neither = "mixes linear and quadratic cells";
  expectError(filters.attempt<vtkMeshValidity>(grid, [](vtkMeshValidity*) {}), neither);
  expectError(filters.attempt<vtkCADGeometricError>(grid, [](vtkCADGeometricError*) {}), neither);
  expectErrors(filtersOfRawMeshes(), Grid::New(), "no points");
}

/// Triangles, lines and vertices beside the tetrahedra are tags.
TEST_F(BadCells, cellsOfAllDimensionsTogether)
{
  const auto whole = cadtest::taggedBall();
  expectSame(filtersOfRawMeshes(), pieceOf(whole), whole);
}

TEST_F(BadCells, cellsThatAreListedTwice)
{
  const Grid grid = ballOnLastRank();
  if (isLast())
  {
    vtkNew<vtkIdList> points;
    grid->GetCellPoints(7, points);
    std::swap(*points->begin(), *(points->begin() + 2)); // another order
    grid->InsertNextCell(VTK_TETRA, points);
  }
  const std::string reason = "the mesh has duplicate cells: 7 and 20 of rank ";
  expectErrors(allFilters(), grid, reason + std::to_string(exchange.size() - 1));
  cadtest::addGlobalIds(grid);
  expectErrors(allFilters(), grid, reason);
}

TEST_F(BadCells, trianglesThatAreListedTwice)
{
  vtkSmartPointer<vtkPolyData> surface = cadtest::toPolyData(cadtest::sphereMesh(2, 0.03));
  vtkNew<vtkIdList> points;
  surface->GetCellPoints(4, points);
  surface->InsertNextCell(VTK_TRIANGLE, points);
  expectErrors(allFilters(), isLast() ? surface : vtkSmartPointer<vtkPolyData>::New(),
    "the mesh has duplicate cells: 4 and 20");
}

/// As where bodies that touch are meshed one by one, and each lists its triangles, lines and
/// vertices: all of them are kept, and cut. It is the order in which they are listed that counts.
TEST_F(BadCells, tagsThatAreListedTwice)
{
  const Grid whole = vtkUnstructuredGrid::SafeDownCast(cadtest::taggedBall());
  const vtkIdType once = whole->GetNumberOfCells();
  for (vtkIdType c = 0; c < once; ++c)
  {
    if (whole->GetCell(c)->GetCellDimension() < 3)
    {
      vtkNew<vtkIdList> points;
      whole->GetCellPoints(c, points);
      std::reverse(points->begin(), points->end());
      whole->InsertNextCell(whole->GetCellType(c), points);
    }
  }
  const vtkNew<vtkTypeInt32Array> bodies;
  bodies->SetName("Body");
  for (vtkIdType c = 0; c < whole->GetNumberOfCells(); ++c)
  {
    bodies->InsertNextValue(c < once ? 1 : 2);
  }
  whole->GetCellData()->AddArray(bodies);
  // A piece on several ranks has all of those that are listed again, or none.
  vtkSmartPointer<vtkPointSet> piece = whole;
  if (exchange.size() > 1)
  {
    piece = pieceOf(whole);
  }
  expectSame(filtersOfRawMeshes(), piece, whole);

  const auto refined = filters.refineUniformly(filters.project(piece));
  std::array<std::int64_t, 2> triangles{};
  for (vtkIdType c = 0; c < refined->GetNumberOfCells(); ++c)
  {
    if (refined->GetCellType(c) == VTK_TRIANGLE)
    {
      ++triangles.at(static_cast<int>(refined->GetCellData()->GetArray("Body")->GetTuple1(c)) - 1);
    }
  }
  EXPECT_EQ(exchange.sum(triangles[0]), 4 * 20);
  EXPECT_EQ(exchange.sum(triangles[1]), 4 * 20);
}

/// Said, counted, mended where it can be, and the same on any number of ranks.
TEST_F(BadCells, invertedAndFlatCells)
{
  const cadtest::FilterRun alone(filters.cad());
  Mesh mesh = cadtest::toMesh(alone.refineStraight(ball()));
  const auto isInner = [&](Index v) { return norm(mesh.points[v]) < 1.2; };
  const auto flat = std::find_if(mesh.tetrahedra.begin(), mesh.tetrahedra.end(),
    [&](const auto& cell) { return isInner(cell[0]); });
  ASSERT_NE(flat, mesh.tetrahedra.end());
  const auto& [a, b, c, d] = *flat;
  mesh.points[a] = (1.0 / 3) * (mesh.points[b] + mesh.points[c] + mesh.points[d]);
  std::swap(mesh.tetrahedra[90][0], mesh.tetrahedra[90][1]);
  const auto whole = cadtest::toGrid(mesh);
  const auto piece = pieceOf(whole);
  const double bad = cadtest::fieldValue(
    filters.run<vtkMeshValidity>(piece, [](vtkMeshValidity*) {}), "InvalidCells");
  EXPECT_GE(bad, 2);
  const auto outcome = filters.attempt<vtkProjectOntoCAD>(piece, [](vtkProjectOntoCAD*) {});
  EXPECT_EQ(outcome.warnings.size(), exchange.rank() == 0 ? 1u : 0u);
  EXPECT_LE(cadtest::fieldValue(outcome.pointSet(), "InvalidCells"), bad);
  EXPECT_GT(cadtest::fieldValue(outcome.pointSet(), "CADVertices"), 0);
  expectSame(filtersOfRawMeshes(), piece, whole);
}

/// Moving vertices would make valid cells of it, but no ball.
TEST_F(BadCells, allCellsInverted)
{
  Mesh mesh = cadtest::ballMesh(2, 0.03);
  const auto turn = [](Mesh which)
  {
    for (auto& cell : which.tetrahedra)
    {
      std::swap(cell[0], cell[1]);
    }
    return cadtest::toGrid(which);
  };
  const auto whole = turn(mesh);
  const std::string reason = "more than half of the cells are inverted or degenerate (20 of 20)";
  expectErrors({ allFilters()[0], allFilters()[1] }, pieceOf(whole), reason);
  const auto judged = filters.run<vtkMeshValidity>(pieceOf(whole), [](vtkMeshValidity*) {});
  EXPECT_EQ(cadtest::fieldValue(judged, "InvalidCells"), 20);

  const auto projected = filters.project(pieceOf(cadtest::toGrid(mesh)));
  vtkNew<vtkIdList> points;
  auto* cells = vtkUnstructuredGrid::SafeDownCast(projected)->GetCells();
  for (vtkIdType c = 0; c < cells->GetNumberOfCells(); ++c)
  {
    cells->GetCellAtId(c, points);
    std::swap(*points->begin(), *(points->begin() + 1));
    cells->ReplaceCellAtId(c, points);
  }
  expectError(filters.attempt<vtkRefineWithCAD>(projected, [](vtkRefineWithCAD*) {}), reason);
  EXPECT_EQ(cadtest::fieldValue(filters.refineStraight(projected), "InvalidCells"), 160);
}

TEST_F(BadCells, pointsInFloat)
{
  const Grid whole = ball();
  vtkNew<vtkPoints> floats;
  floats->SetDataTypeToFloat();
  vtkNew<vtkPoints> doubles;
  doubles->SetDataTypeToDouble();
  for (vtkIdType p = 0; p < whole->GetNumberOfPoints(); ++p)
  {
    floats->InsertNextPoint(whole->GetPoint(p));
    doubles->InsertNextPoint(floats->GetPoint(p));
  }
  const Grid single = Grid::New();
  single->DeepCopy(whole);
  single->SetPoints(floats);
  whole->SetPoints(doubles);
  expectSame(filtersOfRawMeshes(), isLast() ? single : Grid::New(), whole);
  const auto output = filters.project(isLast() ? single : Grid::New());
  EXPECT_EQ(output->GetPoints()->GetDataType(), VTK_DOUBLE);
}

/// Cells that are listed with numbers of 32 and of 64 bits.
TEST_F(BadCells, numbersOf32And64Bits)
{
  const Grid whole = ball();
  const Grid narrow = ball();
  narrow->GetCells()->ConvertTo32BitStorage();
  const Grid wide = ball();
  wide->GetCells()->ConvertTo64BitStorage();
  EXPECT_FALSE(narrow->GetCells()->IsStorage64Bit());
  expectSame(filtersOfRawMeshes(), isLast() ? narrow : Grid::New(), whole);
  expectSame(filtersOfRawMeshes(), isLast() ? wide : Grid::New(), whole);
}

TEST_F(BadCells, noCells)
{
  expectErrors(allFilters(), Grid::New(), "no points");
  Grid points = Grid::New();
  points->SetPoints(ball()->GetPoints());
  expectError(
    filters.attempt<vtkAdaptToCAD>(points, [](vtkAdaptToCAD*) {}), "no cells of area or volume");
  EXPECT_EQ(cadtest::fieldValue(
              filters.run<vtkMeshValidity>(points, [](vtkMeshValidity*) {}), "InvalidCells"),
    0);
  points = Grid::New();
  points->SetPoints(ball()->GetPoints());
  points->InsertNextCell(VTK_EMPTY_CELL, 0, nullptr);
  expectErrors(allFilters(), points, "all cells of the mesh are empty");
}

/// Every rank has the same points: they are the same points.
TEST_F(BadCells, pointsOnly)
{
  Grid points = Grid::New();
  points->SetPoints(ball()->GetPoints());
  const auto projected = filters.project(points);
  EXPECT_EQ(cadtest::fieldValue(projected, "GlobalVertices"), 13);
  EXPECT_EQ(cadtest::fieldValue(projected, "CADVertices"), 13);
}

TEST_F(BadCells, everythingOnOneRank)
{
  const auto whole = cadtest::taggedBall();
  cadtest::addArrays(whole);
  cadtest::addGlobalIds(whole);
  for (const int rank : { 0, exchange.size() - 1 })
  {
    expectSame(filtersOfRawMeshes(), allOn(rank, whole), whole);
  }
}

/// What a rank without cells has besides nothing: no arrays, no points, or another class.
TEST_F(BadCells, ranksWithoutAnything)
{
  const auto whole = cadtest::taggedBall();
  cadtest::addArrays(whole);
  cadtest::addGlobalIds(whole);
  const vtkSmartPointer<vtkPointSet> piece = allOn(exchange.size() - 1, whole);
  const auto nothing = vtkSmartPointer<vtkUnstructuredGrid>::New();
  expectSame(filtersOfRawMeshes(), isLast() ? piece.Get() : nothing.Get(), whole);
}

/// As in a coordinate plane, also in single precision; out of every plane no side of it is known.
TEST_F(BadCells, planeMeshesOutsideTheCoordinatePlanes)
{
  const auto tilt = [](const Point3& p) {
    return Point3{ p[0], 0.8 * p[1] - 0.6 * p[2], 0.6 * p[1] + 0.8 * p[2] };
  };
  Mesh mesh = cadtest::squareMesh(4, 0.1, 1);
  std::swap(mesh.triangles[5][0], mesh.triangles[5][1]);
  const auto invalidOf = [&](const Mesh& which)
  {
    const auto whole = cadtest::toPolyData(which);
    return cadtest::fieldValue(
      filters.run<vtkMeshValidity>(pieceOf(whole), [](vtkMeshValidity*) {}), "InvalidCells");
  };
  EXPECT_EQ(invalidOf(mesh), 1);
  std::transform(mesh.points.begin(), mesh.points.end(), mesh.points.begin(), tilt);
  EXPECT_EQ(invalidOf(mesh), 1);
  for (Point3& point : mesh.points)
  {
    std::transform(point.begin(), point.end(), point.begin(),
      [](double x) { return static_cast<double>(static_cast<float>(x)); });
  }
  EXPECT_EQ(invalidOf(mesh), 1);
  mesh.points[0][2] += 1e-3;
  EXPECT_EQ(invalidOf(mesh), 0);
}

} // namespace

} // namespace cadrefine
