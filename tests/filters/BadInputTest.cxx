// Input that cannot be used: one clear error, on all ranks, and no output.

#include "DataSets.h"
#include "FilterRun.h"
#include "ParallelTest.h"
#include "TestMeshes.h"
#include "TestShapes.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkIntArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <limits>

namespace cadrefine
{

namespace
{

using Grid = vtkSmartPointer<vtkUnstructuredGrid>;

/// The last rank alone gets the bad input, the others (if there are any) good input.
class BadInput : public ParallelTest
{
protected:
  cadtest::TemporaryFolder folder;
  cadtest::FilterRun filters{ cadtest::writeInto(folder, cadtest::sphere(2), ".step"),
    worldController() };

  bool isLast() const { return exchange.rank() == exchange.size() - 1; }

  static Grid ball() { return cadtest::toGrid(cadtest::ballMesh(2, 0.03)); }

  /// A ball on each rank, with nothing in common; the last rank's lies on the CAD.
  Grid goodMesh() const
  {
    Grid grid = ball();
    for (vtkIdType p = 0; p < grid->GetNumberOfPoints(); ++p)
    {
      double point[3];
      grid->GetPoint(p, point);
      point[0] += 10 * (exchange.size() - 1 - exchange.rank());
      grid->GetPoints()->SetPoint(p, point);
    }
    return grid;
  }

  void expectFailure(const cadtest::Outcome& outcome, const std::string& reason)
  {
    EXPECT_FALSE(outcome.succeeded);
    EXPECT_EQ(outcome.pointSet()->GetNumberOfPoints(), 0);
    EXPECT_EQ(outcome.pointSet()->GetNumberOfCells(), 0);
    EXPECT_EQ(outcome.errors.size(), exchange.rank() == 0 ? 1u : 0u);
    if (exchange.rank() == 0 && outcome.errors.size() == 1)
    {
      EXPECT_NE(outcome.errors[0].find(reason), std::string::npos) << outcome.errors[0];
    }
  }

  void expectProjectionFails(vtkPointSet* mesh, const std::string& reason)
  {
    expectFailure(filters.attempt<vtkProjectOntoCAD>(mesh, [](vtkProjectOntoCAD*) {}), reason);
  }

  template<class Filter>
  void expectProjectedMeshFails(
    vtkPointSet* mesh, const std::string& reason, void (*configure)(Filter*) = [](Filter*) {})
  {
    expectFailure(filters.attempt<Filter>(mesh, configure), reason);
  }

  /// The mesh with this cell in place of all others, on the last rank.
  Grid withCell(int type, std::initializer_list<vtkIdType> points) const
  {
    Grid grid = goodMesh();
    if (isLast())
    {
      const std::vector<vtkIdType> ids(points);
      grid->Allocate(1);
      grid->InsertNextCell(type, static_cast<vtkIdType>(ids.size()), ids.data());
    }
    return grid;
  }
};

TEST_F(BadInput, emptyRegion)
{
  const auto outcome = filters.attempt<vtkProjectOntoCAD>(goodMesh(),
    [](vtkProjectOntoCAD* filter)
    {
      filter->UseRegionOn();
      filter->SetRegion(1, -1, 1, -1, 1, -1);
    });
  expectFailure(outcome, "region is empty");
}

TEST_F(BadInput, quadraticTetrahedra)
{
  expectProjectionFails(
    withCell(VTK_QUADRATIC_TETRA, { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9 }), "quadratictetra");
}

TEST_F(BadInput, pointsWithoutCellsThatUseThem)
{
  Grid grid = goodMesh();
  grid->Allocate(1);
  const auto outcome = filters.attempt<vtkCADGeometricError>(grid, [](vtkCADGeometricError*) {});
  expectFailure(outcome, "");
}

TEST_F(BadInput, linesOnly)
{
  Mesh mesh = cadtest::oneTriangle({ { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } } });
  mesh.triangles.clear();
  mesh.segments = { { 0, 1 }, { 1, 2 } };
  expectProjectionFails(cadtest::toGrid(mesh), "lines");
}

TEST_F(BadInput, withoutClassification)
{
  expectProjectedMeshFails<vtkCADGeometricError>(goodMesh(), "CADDimension");
  expectProjectedMeshFails<vtkRefineWithCAD>(goodMesh(), "CADDimension");
}

TEST_F(BadInput, withOneClassificationArrayMissing)
{
  for (const char* name : { "CADDimension", "CADEntity", "CADParameters", "CADDistance" })
  {
    const auto mesh = filters.project(goodMesh());
    if (isLast())
    {
      mesh->GetPointData()->RemoveArray(name);
    }
    expectProjectedMeshFails<vtkCADGeometricError>(mesh, name);
    expectProjectedMeshFails<vtkRefineWithCAD>(mesh, name);
  }
}

TEST_F(BadInput, entityThatTheModelDoesNotHave)
{
  for (const char* name : { "CADDimension", "CADEntity" })
  {
    for (const int bad : { 3, 100, 1000000 })
    {
      const auto mesh = filters.project(goodMesh());
      vtkNew<vtkIntArray> array;
      array->DeepCopy(mesh->GetPointData()->GetArray(name));
      if (isLast())
      {
        array->SetValue(0, bad);
      }
      mesh->GetPointData()->AddArray(array);
      expectProjectedMeshFails<vtkCADGeometricError>(mesh, "another CAD file");
      expectProjectedMeshFails<vtkRefineWithCAD>(mesh, "another CAD file");
    }
  }
}

/// Arrays of real numbers can hold anything.
TEST_F(BadInput, entityThatIsNoNumber)
{
  for (const char* name : { "CADDimension", "CADEntity" })
  {
    const auto mesh = filters.project(goodMesh());
    vtkNew<vtkDoubleArray> array;
    array->DeepCopy(mesh->GetPointData()->GetArray(name));
    array->SetValue(0, isLast() ? std::numeric_limits<double>::quiet_NaN() : array->GetValue(0));
    mesh->GetPointData()->AddArray(array);
    expectProjectedMeshFails<vtkRefineWithCAD>(mesh, "another CAD file");
  }
}

/// A distance from the CAD without an entity to go to is not used.
TEST_F(BadInput, distanceWithoutAnEntityIsIgnored)
{
  const auto mesh = filters.project(goodMesh());
  vtkDataArray* distances = mesh->GetPointData()->GetArray("CADDistance");
  vtkDataArray* dimensions = mesh->GetPointData()->GetArray("CADDimension");
  for (vtkIdType p = 0; p < mesh->GetNumberOfPoints(); ++p)
  {
    distances->SetTuple1(p, dimensions->GetTuple1(p) < 0 ? 0.5 : distances->GetTuple1(p));
  }
  const auto fine = filters.refineUniformly(mesh);
  EXPECT_EQ(cadtest::fieldValue(fine, "UnprojectedVertices"), 0);
}

TEST_F(BadInput, noMarkingArrayOfThatName)
{
  expectProjectedMeshFails<vtkRefineWithCAD>(filters.project(goodMesh()), "Nonsense",
    [](vtkRefineWithCAD* filter) { filter->SetMarkingArray("Nonsense"); });
}

TEST_F(BadInput, markingArrayWithThreeComponents)
{
  Grid grid = goodMesh();
  cadtest::addArrays(grid);
  expectProjectedMeshFails<vtkRefineWithCAD>(filters.project(grid), "3 components",
    [](vtkRefineWithCAD* filter) { filter->SetMarkingArray("Colour"); });
}

TEST_F(BadInput, pointsAloneCannotBeRefined)
{
  vtkNew<vtkUnstructuredGrid> points;
  points->SetPoints(goodMesh()->GetPoints());
  const auto projected = filters.project(points);
  expectProjectedMeshFails<vtkRefineWithCAD>(projected, "no cells of area or volume");
  expectProjectedMeshFails<vtkCADGeometricError>(projected, "no cells of area or volume");
}

TEST_F(BadInput, cadInputWithoutModel)
{
  vtkNew<vtkPartitionedDataSetCollection> nothing;
  const cadtest::FilterRun without(isLast() ? nothing.Get() : filters.cad(), worldController());
  expectFailure(without.attempt<vtkProjectOntoCAD>(goodMesh(), [](vtkProjectOntoCAD*) {}),
    "output of a CAD Reader");
}

TEST_F(BadInput, noCADIsChosen)
{
  expectFailure(filters.attempt<vtkProjectOntoCAD>(goodMesh(),
                  [](vtkProjectOntoCAD* filter) { filter->SetInputConnection(1, nullptr); }),
    "no CAD model is chosen: open the .step, .iges or .brep file");
}

TEST_F(BadInput, theCADOfTheProjectionNeedNotBeChosenAgain)
{
  vtkNew<vtkProjectOntoCAD> project;
  project->SetController(worldController());
  project->SetInputDataObject(0, goodMesh());
  project->SetInputDataObject(1, filters.cad());
  const auto outcome = filters.attempt<vtkCADGeometricError>(goodMesh(),
    [&](vtkCADGeometricError* filter)
    {
      filter->SetInputConnection(0, project->GetOutputPort());
      filter->SetInputConnection(1, nullptr);
    });
  ASSERT_TRUE(outcome.succeeded) << testing::PrintToString(outcome.errors);
  EXPECT_EQ(cadtest::fieldValue(outcome.pointSet(), "GlobalGeometricError"),
    cadtest::fieldValue(filters.measure(filters.project(goodMesh()), 1), "GlobalGeometricError"));
}

TEST_F(BadInput, readerWithoutAFile)
{
  for (const char* name : { "", "/nowhere/nothing.igs" })
  {
    vtkNew<vtkCADReader> reader;
    reader->SetController(worldController());
    reader->SetFileName(name);
    const cadtest::Outcome outcome = cadtest::execute(reader);
    EXPECT_FALSE(outcome.succeeded);
    EXPECT_EQ(outcome.errors.size(), exchange.rank() == 0 ? 1u : 0u);
  }
}

/// The same input is fine where nothing is bad.
TEST_F(BadInput, isNotEverything)
{
  const auto mesh = filters.project(goodMesh());
  EXPECT_EQ(cadtest::fieldValue(filters.refineUniformly(mesh), "InvalidCells"), 0);
}

} // namespace

} // namespace cadrefine
