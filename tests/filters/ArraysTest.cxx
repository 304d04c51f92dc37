// Arrays and tags that a mesh brings along, in a mesh of tetrahedra and tagged boundary triangles.

#include "DataSets.h"
#include "FilterRun.h"
#include "MeshChecks.h"
#include "TestMeshes.h"
#include "TestShapes.h"

#include <gtest/gtest.h>
#include <vtkAdaptToCAD.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace
{

using namespace cadrefine;

constexpr double radius = 2;

class TaggedBall : public testing::Test
{
protected:
  cadtest::TemporaryFolder folder;
  cadtest::FilterRun filters{ cadtest::writeInto(folder, cadtest::sphere(radius), ".step") };
  vtkSmartPointer<vtkUnstructuredGrid> coarse = makeMesh();

  /// 20 triangles with tags 0 ... 19, then 20 tetrahedra with tags 20 ... 39.
  static vtkSmartPointer<vtkUnstructuredGrid> makeMesh()
  {
    Mesh mesh = cadtest::ballMesh(radius, 0.03);
    mesh.triangles = cadtest::sphereMesh(radius, 0.03).triangles;
    auto grid = cadtest::toGrid(mesh);
    cadtest::addArrays(grid);
    return grid;
  }

  static std::set<double> valuesOf(vtkDataArray* array)
  {
    std::set<double> values;
    for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
    {
      values.insert(array->GetTuple1(i));
    }
    return values;
  }
};

const std::vector<const char*> errorsOfCells{ "GeometricError", "GeometricDistance", "ChordError",
  "NormalAngle" };
const std::vector<const char*> errorsOfMesh{ "GlobalGeometricError", "GeometricErrorDimension",
  "MaximumGeometricDistance", "MaximumChordError", "MaximumNormalAngle" };
const std::vector<const char*> qualities{ "CellValidity", "CellQuality" };

/// Which of these arrays there are.
std::vector<std::string> found(vtkFieldData* data, const std::vector<const char*>& names)
{
  std::vector<std::string> there;
  std::copy_if(names.begin(), names.end(), std::back_inserter(there),
    [&](const char* name) { return data->HasArray(name); });
  return there;
}

/// What was measured of the mesh before it changed does not hold any more.
TEST_F(TaggedBall, losesWhatWasMeasuredWhereItChanges)
{
  const auto judged = filters.run<vtkMeshValidity>(
    filters.measure(filters.project(coarse), 1), [](vtkMeshValidity*) {});
  const auto measured = filters.measure(judged, 1);
  for (const auto& data : { judged, measured })
  {
    EXPECT_EQ(found(data->GetCellData(), errorsOfCells).size(), errorsOfCells.size());
    EXPECT_EQ(found(data->GetFieldData(), errorsOfMesh).size(), errorsOfMesh.size());
    EXPECT_EQ(found(data->GetCellData(), qualities).size(), qualities.size());
  }
  for (const auto& changed : { filters.project(measured), filters.refineUniformly(measured),
         filters.refineWhereErrorExceeds(measured, 0),
         filters.run<vtkRefineWithCAD>(measured,
           [](vtkRefineWithCAD* filter)
           {
             filter->SetMarkingArray("CellQuality");
             filter->SetLevels(2);
           }) })
  {
    EXPECT_EQ(found(changed->GetCellData(), errorsOfCells), std::vector<std::string>());
    EXPECT_EQ(found(changed->GetFieldData(), errorsOfMesh), std::vector<std::string>());
    EXPECT_EQ(found(changed->GetCellData(), qualities), std::vector<std::string>());
    EXPECT_TRUE(changed->GetCellData()->HasArray("Tag"));
    EXPECT_EQ(cadtest::fieldValue(changed, "InvalidCells"), 0);
  }
}

/// Its own errors are those of the last step; an indicator serves all of them.
TEST_F(TaggedBall, hasTheErrorsOfTheLastStepAfterAnAdaptation)
{
  const auto judged = filters.run<vtkMeshValidity>(
    filters.measure(filters.project(coarse), 1), [](vtkMeshValidity*) {});
  const auto adapted = filters.run<vtkAdaptToCAD>(judged,
    [](vtkAdaptToCAD* filter)
    {
      filter->SetIndicatorArray("CellQuality");
      filter->SetMaximumSteps(2);
    });
  EXPECT_EQ(found(adapted->GetCellData(), qualities), std::vector<std::string>());
  const auto again = filters.measure(adapted, 0);
  EXPECT_EQ(cadtest::fieldValue(adapted, "GlobalGeometricError"),
    cadtest::fieldValue(again, "GlobalGeometricError"));
}

TEST_F(TaggedBall, keepsALinearFieldLinearUnderStraightRefinement)
{
  const auto data = filters.refineStraight(coarse, 3);
  vtkDataArray* linear = data->GetPointData()->GetArray("Linear");
  ASSERT_NE(linear, nullptr);
  ASSERT_EQ(linear->GetNumberOfTuples(), data->GetNumberOfPoints());
  for (vtkIdType p = 0; p < data->GetNumberOfPoints(); ++p)
  {
    EXPECT_NEAR(linear->GetTuple1(p), cadtest::linearAt(data->GetPoint(p)), 1e-13);
  }
}

TEST_F(TaggedBall, givesChildrenTheArraysOfTheirParents)
{
  const auto data = filters.refineUniformly(filters.project(coarse), 2);
  vtkDataArray* tag = data->GetCellData()->GetArray("Tag");
  vtkDataArray* colour = data->GetCellData()->GetArray("Colour");
  ASSERT_NE(tag, nullptr);
  ASSERT_NE(colour, nullptr);
  std::map<double, int> counts;
  for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c)
  {
    const double value = tag->GetTuple1(c);
    ++counts[value];
    EXPECT_EQ(value < 20 ? VTK_TRIANGLE : VTK_TETRA, data->GetCellType(c));
    EXPECT_EQ(colour->GetComponent(c, 0), 0.25 * value);
    EXPECT_EQ(colour->GetComponent(c, 2), -1);
  }
  ASSERT_EQ(counts.size(), 40u);
  for (const auto& [value, count] : counts)
  {
    EXPECT_EQ(count, value < 20 ? 16 : 64);
  }
}

/// Tag triangles must lie where the boundary of the tetrahedra lies, after refinement too.
TEST_F(TaggedBall, keepsTagTrianglesOnTheBoundary)
{
  auto data = filters.measure(filters.project(coarse), 1);
  for (int step = 0; step < 4; ++step)
  {
    data = filters.measure(filters.refineWhereErrorExceeds(data, 0.02), 1);
    const Mesh mesh = cadtest::toMesh(data);
    Mesh surface = mesh;
    surface.dimension = 2;
    EXPECT_EQ(mesh.triangles.size(), cadtest::countOuterSides(mesh));
    EXPECT_EQ(cadtest::countOuterSides(surface), 0u);
    EXPECT_NEAR(cadtest::volumeInside(surface), cadtest::measureOf(mesh), 1e-12);
  }
  EXPECT_GT(data->GetNumberOfCells(), 200);
}

/// A whole number is kept, never averaged: it stays one of those that were there.
TEST_F(TaggedBall, keepsWholeNumbersOfPoints)
{
  const auto data = filters.refineUniformly(filters.project(coarse), 2);
  vtkDataArray* region = data->GetPointData()->GetArray("Region");
  ASSERT_NE(region, nullptr);
  EXPECT_EQ(region->GetDataType(), VTK_INT);
  EXPECT_EQ(valuesOf(region), (std::set<double>{ 0, 1, 2, 3 }));
}

/// As readers of .vtk and .xdmf files make them.
TEST_F(TaggedBall, keepsArraysThatAreScalarsOrVectors)
{
  coarse->GetPointData()->SetActiveScalars("Linear");
  coarse->GetCellData()->SetActiveScalars("Tag");
  coarse->GetCellData()->SetActiveVectors("Colour");
  const auto data = filters.refineUniformly(filters.project(coarse), 1);
  EXPECT_TRUE(data->GetPointData()->HasArray("Linear"));
  ASSERT_NE(data->GetPointData()->GetScalars(), nullptr); // what projecting makes them
  EXPECT_STREQ(data->GetPointData()->GetScalars()->GetName(), "CADEntity");
  ASSERT_NE(data->GetCellData()->GetScalars(), nullptr);
  EXPECT_STREQ(data->GetCellData()->GetScalars()->GetName(), "Tag");
  EXPECT_EQ(valuesOf(data->GetCellData()->GetScalars()).size(), 40u);
  ASSERT_NE(data->GetCellData()->GetVectors(), nullptr);
  EXPECT_STREQ(data->GetCellData()->GetVectors()->GetName(), "Colour");
  EXPECT_NE(data->GetPointData()->GetGlobalIds(), nullptr);
}

TEST_F(TaggedBall, hasUniqueGlobalIds)
{
  for (const bool withIds : { false, true })
  {
    auto input = makeMesh();
    if (withIds)
    {
      cadtest::addGlobalIds(input);
    }
    const auto data = filters.refineUniformly(filters.project(input), 2);
    vtkDataArray* pointIds = data->GetPointData()->GetGlobalIds();
    vtkDataArray* cellIds = data->GetCellData()->GetGlobalIds();
    ASSERT_NE(pointIds, nullptr);
    ASSERT_NE(cellIds, nullptr);
    EXPECT_EQ(pointIds->GetName(), std::string(withIds ? "PointIds" : "GlobalPointIds"));
    EXPECT_EQ(valuesOf(pointIds).size(), static_cast<std::size_t>(data->GetNumberOfPoints()));
    EXPECT_EQ(valuesOf(cellIds).size(), static_cast<std::size_t>(data->GetNumberOfCells()));
  }
}

/// Old vertices keep their ids: a solver can find them again.
TEST_F(TaggedBall, keepsTheIdsOfOldVertices)
{
  cadtest::addGlobalIds(coarse);
  const auto data = filters.refineStraight(coarse);
  vtkDataArray* before = coarse->GetPointData()->GetGlobalIds();
  vtkDataArray* after = data->GetPointData()->GetGlobalIds();
  std::map<std::array<double, 3>, double> idAt;
  for (vtkIdType p = 0; p < data->GetNumberOfPoints(); ++p)
  {
    std::array<double, 3> point;
    data->GetPoint(p, point.data());
    idAt[point] = after->GetTuple1(p);
  }
  for (vtkIdType p = 0; p < coarse->GetNumberOfPoints(); ++p)
  {
    std::array<double, 3> point;
    coarse->GetPoint(p, point.data());
    EXPECT_EQ(idAt.at(point), before->GetTuple1(p));
  }
}

TEST_F(TaggedBall, marksByAnyCellArray)
{
  const auto data = filters.run<vtkRefineWithCAD>(filters.project(coarse),
    [](vtkRefineWithCAD* filter)
    {
      filter->SetMarkingArray("Tag");
      filter->SetThreshold(38.5); // the last tetrahedron alone
    });
  const Mesh mesh = cadtest::toMesh(data);
  EXPECT_GT(mesh.tetrahedra.size(), 20u);
  EXPECT_LT(mesh.tetrahedra.size(), 40u);
  EXPECT_TRUE(cadtest::isValid(mesh));
}

TEST(MeshValidity, findsTheInvertedTetrahedron)
{
  Mesh mesh = cadtest::cubeMesh(2, 0.1, 1);
  std::swap(mesh.tetrahedra[7][0], mesh.tetrahedra[7][1]);
  const cadtest::FilterRun filters(static_cast<vtkDataObject*>(nullptr));
  const auto data = filters.run<vtkMeshValidity>(cadtest::toGrid(mesh), [](vtkMeshValidity*) {});
  vtkDataArray* validity = data->GetCellData()->GetArray("CellValidity");
  vtkDataArray* quality = data->GetCellData()->GetArray("CellQuality");
  for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c)
  {
    EXPECT_EQ(validity->GetTuple1(c), c != 7);
    EXPECT_EQ(quality->GetTuple1(c) > 0, c != 7);
  }
  EXPECT_EQ(cadtest::fieldValue(data, "InvalidCells"), 1);
  EXPECT_EQ(cadtest::fieldValue(data, "MinimumQuality"), quality->GetTuple1(7));
}

TEST(MeshValidity, findsFlatCellsAndTrianglesThatTurnOver)
{
  const cadtest::FilterRun filters(static_cast<vtkDataObject*>(nullptr));
  const auto flat = cadtest::toGrid(
    cadtest::oneTetrahedron({ { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 } } }));
  EXPECT_EQ(cadtest::fieldValue(
              filters.run<vtkMeshValidity>(flat, [](vtkMeshValidity*) {}), "InvalidCells"),
    1);
  Mesh square = cadtest::squareMesh(3, 0.1, 1);
  std::swap(square.triangles[4][0], square.triangles[4][1]);
  const auto data =
    filters.run<vtkMeshValidity>(cadtest::toPolyData(square), [](vtkMeshValidity*) {});
  EXPECT_EQ(cadtest::fieldValue(data, "InvalidCells"), 1);
  EXPECT_EQ(data->GetCellData()->GetArray("CellValidity")->GetTuple1(4), 0);
}

TEST(MeshValidity, givesTheMeanRatio)
{
  const cadtest::FilterRun filters(static_cast<vtkDataObject*>(nullptr));
  const auto corner = cadtest::toGrid(
    cadtest::oneTetrahedron({ { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } }));
  const auto data = filters.run<vtkMeshValidity>(corner, [](vtkMeshValidity*) {});
  EXPECT_NEAR(data->GetCellData()->GetArray("CellQuality")->GetTuple1(0),
    12 * std::pow(0.5, 2.0 / 3.0) / 9, 1e-15);
}

/// Vertices off the CAD that make way for others get the values of where they come to. An array
/// without a name stays one.
TEST(VerticesInside, keepALinearFieldLinear)
{
  const cadtest::FilterRun filters(CADREFINE_DATA "/naca0012_blunt.igs");
  const auto coarse =
    filters.project(cadtest::readGrid(CADREFINE_DATA "/naca0012_blunt_coarse.vtu"));
  cadtest::addArrays(coarse);
  vtkNew<vtkDoubleArray> unnamed;
  unnamed->DeepCopy(coarse->GetPointData()->GetArray("Linear"));
  unnamed->SetName(nullptr);
  coarse->GetPointData()->AddArray(unnamed);
  const auto straight = filters.refineStraight(coarse);
  const auto fine = filters.run<vtkRefineWithCAD>(coarse,
    [](vtkRefineWithCAD* filter)
    {
      filter->SetMethod(vtkRefineWithCAD::UNIFORM_BISECTION);
      filter->SetOperations(vtkRefineWithCAD::CUT_ONLY);
    });
  ASSERT_EQ(straight->GetNumberOfPoints(), fine->GetNumberOfPoints());
  vtkDataArray* linear = fine->GetPointData()->GetArray("Linear");
  vtkDataArray* dimension = fine->GetPointData()->GetArray("CADDimension");
  int moved = 0;
  for (vtkIdType p = 0; p < fine->GetNumberOfPoints(); ++p)
  {
    std::array<double, 3> before{};
    straight->GetPoint(p, before.data());
    const std::array<double, 3> place{ fine->GetPoint(p)[0], fine->GetPoint(p)[1],
      fine->GetPoint(p)[2] };
    if (dimension->GetTuple1(p) < 0 && place != before)
    {
      ++moved;
      EXPECT_NEAR(linear->GetTuple1(p), cadtest::linearAt(place.data()), 1e-13);
    }
  }
  EXPECT_GT(moved, 0);
  EXPECT_EQ(fine->GetPointData()->GetNumberOfArrays(), coarse->GetPointData()->GetNumberOfArrays());
}

/// As programs write them; far from the origin, single precision is coarse.
TEST(ProjectedVertices, mayBeInSinglePrecision)
{
  const Vector3 far{ 1e5, 3e4, 0 };
  const cadtest::TemporaryFolder folder;
  const cadtest::FilterRun filters(
    cadtest::writeInto(folder, cadtest::moved(cadtest::sphere(radius), far), ".step"));
  Mesh ball = cadtest::ballMesh(radius, 0.03);
  for (Point3& point : ball.points)
  {
    point = point + far;
  }
  const auto projected = filters.project(cadtest::toGrid(ball));
  vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  for (vtkIdType p = 0; p < projected->GetNumberOfPoints(); ++p)
  {
    points->InsertNextPoint(projected->GetPoint(p));
  }
  projected->SetPoints(points);
  EXPECT_EQ(cadtest::fieldValue(filters.refineUniformly(projected), "InvalidCells"), 0);
}

} // namespace
