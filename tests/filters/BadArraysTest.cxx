// Arrays that are named like ours and are others, and arrays that lie.

#include "BadMesh.h"
#include "DataSets.h"
#include "TestMeshes.h"

#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkPointData.h>
#include <vtkSOADataArrayTemplate.h>
#include <vtkSignedCharArray.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>

#include <limits>

namespace cadrefine
{

namespace
{

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

const std::vector<const char*> pointArrays{ "CADDimension", "CADEntity", "CADParameters",
  "CADDistance", "CADConflict" };
const std::vector<const char*> cellArrays{ "GeometricError", "GeometricDistance", "ChordError",
  "NormalAngle", "CellValidity", "CellQuality" };

class BadArrays : public BadMesh
{
protected:
  /// The ball after projection, on the last rank alone.
  vtkSmartPointer<vtkPointSet> projected() const
  {
    return filters.project(isLast() ? ball() : Grid::New());
  }

  template<class Array>
  static vtkSmartPointer<Array> make(const char* name, int components, vtkIdType count)
  {
    auto array = vtkSmartPointer<Array>::New();
    array->SetName(name);
    array->SetNumberOfComponents(components);
    array->SetNumberOfTuples(count);
    return array;
  }

  /// In place of the array, one of this type with the same values.
  template<class Array>
  static void convertArray(vtkPointSet* mesh, const char* name)
  {
    vtkDataArray* old = mesh->GetPointData()->GetArray(name);
    const auto array = make<Array>(name, old->GetNumberOfComponents(), 0);
    array->DeepCopy(old);
    mesh->GetPointData()->AddArray(array);
  }

  /// Error and refinement fail where the last rank's array has this value at point 4.
  void expectValueFails(const char* name, double value, const std::string& reason)
  {
    const auto mesh = projected();
    convertArray<vtkDoubleArray>(mesh, name);
    if (isLast())
    {
      mesh->GetPointData()->GetArray(name)->SetComponent(4, 0, value);
    }
    expectErrors(filtersOfProjectedMeshes(), mesh, reason);
  }
};

/// Arrays of the input of that name and any type make way for the results.
TEST_F(BadArrays, makeWayForResults)
{
  const Grid whole = ball();
  const Grid clean = ball();
  for (const char* name : pointArrays)
  {
    whole->GetPointData()->AddArray(make<vtkStringArray>(name, 3, 13));
  }
  for (const char* name : cellArrays)
  {
    const auto array = make<vtkIntArray>(name, 2, 20);
    array->FillValue(-7);
    whole->GetCellData()->AddArray(array);
  }
  for (const char* name : { "GlobalGeometricError", "InvalidCells", "UnprojectedVertices" })
  {
    whole->GetFieldData()->AddArray(make<vtkStringArray>(name, 1, 4));
  }
  const auto piece = allOn(0, whole);
  piece->GetFieldData()->PassData(whole->GetFieldData());
  const auto expected = filters.project(allOn(0, clean));
  const auto mesh = filters.project(piece);
  EXPECT_EQ(cadtest::fieldValue(mesh, "InvalidCells"), 0);
  for (const char* name : pointArrays)
  {
    vtkDataArray* array = mesh->GetPointData()->GetArray(name);
    vtkDataArray* right = expected->GetPointData()->GetArray(name);
    EXPECT_TRUE(array && right);
    EXPECT_TRUE(array && right && array->GetDataType() == right->GetDataType() &&
                array->GetNumberOfComponents() == right->GetNumberOfComponents());
  }
  const auto measured = filters.measure(mesh, 1);
  for (const char* name : { "GeometricError", "GeometricDistance", "ChordError", "NormalAngle" })
  {
    vtkDataArray* array = measured->GetCellData()->GetArray(name);
    EXPECT_TRUE(array && array->GetDataType() == VTK_DOUBLE && array->GetNumberOfComponents() == 1);
  }
  const auto judged = filters.run<vtkMeshValidity>(measured, [](vtkMeshValidity*) {});
  EXPECT_EQ(judged->GetCellData()->GetArray("CellValidity")->GetDataType(), VTK_SIGNED_CHAR);
  EXPECT_EQ(cadtest::fieldValue(filters.refineUniformly(measured), "InvalidCells"), 0);
}

TEST_F(BadArrays, cannotBeConservedWithoutRealNumbers)
{
  const auto conserve = [&](const std::string& name, const std::string& reason)
  {
    const auto mesh = projected();
    if (mesh->GetNumberOfCells() > 0)
    {
      mesh->GetCellData()->AddArray(make<vtkIntArray>("Counts", 1, mesh->GetNumberOfCells()));
      mesh->GetCellData()->AddArray(make<vtkStringArray>("Names", 1, mesh->GetNumberOfCells()));
      mesh->GetPointData()->AddArray(
        make<vtkDoubleArray>("OfPoints", 1, mesh->GetNumberOfPoints()));
    }
    const auto add = [&](vtkMeshAlgorithm* filter) { filter->AddConservedArray(name.c_str()); };
    expectError(filters.attempt<vtkProjectOntoCAD>(mesh, add), reason);
    expectError(filters.attempt<vtkRefineWithCAD>(mesh, add), reason);
    expectError(filters.attempt<vtkAdaptToCAD>(mesh, add), reason);
  };
  conserve("Counts", "the cell array Counts holds integers, not floating-point numbers");
  for (const char* name : { "Missing", "Names", "OfPoints" })
  {
    conserve(name, std::string("the mesh has no numeric cell array ") + name + ", so its integral");
  }
}

/// The values count, not the type.
TEST_F(BadArrays, ofOtherTypesOfNumbersAreRead)
{
  const auto mesh = projected();
  const auto expected = filters.refineUniformly(mesh);
  const auto errors = filters.measure(mesh, 1);
  convertArray<vtkDoubleArray>(mesh, "CADDimension");
  convertArray<vtkFloatArray>(mesh, "CADEntity");
  convertArray<vtkSOADataArrayTemplate<double>>(mesh, "CADParameters");
  convertArray<vtkSOADataArrayTemplate<double>>(mesh, "CADDistance");
  EXPECT_TRUE(cadtest::areSame(filters.refineUniformly(mesh), expected));
  EXPECT_EQ(cadtest::fieldValue(filters.measure(mesh, 1), "GlobalGeometricError"),
    cadtest::fieldValue(errors, "GlobalGeometricError"));
}

TEST_F(BadArrays, ofTextsAreRefused)
{
  for (const char* name : { "CADDimension", "CADEntity", "CADParameters", "CADDistance" })
  {
    const auto mesh = projected();
    if (isLast())
    {
      mesh->GetPointData()->AddArray(make<vtkStringArray>(name, 1, 13));
    }
    expectErrors(filtersOfProjectedMeshes(), mesh, name);
  }
}

TEST_F(BadArrays, withOtherNumbersOfComponentsAreRefused)
{
  for (const char* name : { "CADDimension", "CADEntity", "CADParameters", "CADDistance" })
  {
    const auto mesh = projected();
    if (isLast())
    {
      const auto array = make<vtkDoubleArray>(name, 3, 13);
      array->FillValue(0);
      mesh->GetPointData()->AddArray(array);
    }
    expectErrors(filtersOfProjectedMeshes(), mesh,
      std::string("the point array ") + name + " has 3 components instead of");
  }
}

/// Also arrays that are only carried along.
TEST_F(BadArrays, ofOtherLengthsAreRefused)
{
  for (const char* name : { "CADDimension", "CADDistance", "Velocity" })
  {
    for (const vtkIdType length : { 0, 12, 14 })
    {
      const auto mesh = projected();
      if (isLast())
      {
        mesh->GetPointData()->AddArray(make<vtkDoubleArray>(name, 1, length));
      }
      expectErrors(allFilters(), mesh,
        std::string("the point array ") + name + " has " + std::to_string(length) +
          " values for 13 points");
    }
  }
  const auto mesh = projected();
  if (isLast())
  {
    mesh->GetCellData()->AddArray(make<vtkStringArray>("Names", 1, 21));
  }
  expectErrors(allFilters(), mesh, "the cell array Names has 21 values for 20 cells");
}

TEST_F(BadArrays, entitiesThatAreNoWholeNumbers)
{
  const std::string reason =
    "that the CAD model does not have; were they made with another CAD file? (point 4)";
  for (const double bad : { 0.5, -0.5, -2.0, 255.0, nan })
  {
    expectValueFails("CADDimension", bad, reason);
  }
  for (const double bad : { 0.5, -1.0, 1e10, nan })
  {
    expectValueFails("CADEntity", bad, reason);
  }
}

TEST_F(BadArrays, placesThatAreNoNumbers)
{
  for (const double bad : { nan, -1.0 })
  {
    expectValueFails("CADDistance", bad, "the point array CADDistance has a value");
  }
  for (const double bad : { nan, std::numeric_limits<double>::infinity() })
  {
    expectValueFails("CADParameters", bad, "the point array CADParameters has a value");
  }
}

/// As of a mesh that was projected onto another CAD file, or has moved since.
TEST_F(BadArrays, placesWhereTheVertexIsNot)
{
  expectValueFails("CADParameters", 1.0, "away from their places on the CAD");
}

TEST_F(BadArrays, valuesThatMarkCells)
{
  const auto mesh = projected();
  if (isLast())
  {
    const auto array = make<vtkFloatArray>("Mark", 1, 20);
    array->FillValue(1);
    array->SetValue(7, static_cast<float>(nan));
    mesh->GetCellData()->AddArray(array);
    mesh->GetCellData()->AddArray(make<vtkStringArray>("Text", 1, 20));
  }
  const auto refineBy = [&](const char* name)
  {
    return filters.attempt<vtkRefineWithCAD>(
      mesh, [&](vtkRefineWithCAD* filter) { filter->SetMarkingArray(name); });
  };
  expectError(refineBy("Mark"), "the marking array Mark contains NaN");
  expectError(refineBy("Text"), "the mesh has no numeric cell array Text to mark cells by");
  expectError(refineBy("Nothing"), "the mesh has no numeric cell array Nothing");
  expectError(filters.attempt<vtkRefineWithCAD>(
                projected(), [](vtkRefineWithCAD* filter) { filter->SetChordTolerance(0.1); }),
    "the mesh has no cell array ChordError; compute it first with CAD Geometric Error; numeric "
    "cell arrays in the mesh: ");
  expectError(filters.attempt<vtkAdaptToCAD>(
                mesh, [](vtkAdaptToCAD* filter) { filter->SetIndicatorArray("eta"); }),
    "the mesh has no numeric cell array eta to mark cells by; numeric cell arrays in the mesh: ");
}

/// They go where interpolation takes them, and nowhere else.
TEST_F(BadArrays, valuesThatAreNoNumbersAreCarried)
{
  const Grid whole = ball();
  cadtest::addArrays(whole);
  cadtest::addGlobalIds(whole);
  whole->GetPointData()->GetArray("Linear")->SetTuple1(12, nan); // inside
  whole->GetCellData()->GetArray("Colour")->SetComponent(3, 1, nan);
  expectSame(filtersOfRawMeshes(), pieceOf(whole), whole);
  const auto fine = filters.refineUniformly(filters.project(pieceOf(whole)));
  vtkDataArray* linear = fine->GetPointData()->GetArray("Linear");
  std::int64_t count = 0;
  std::map<std::int64_t, int> holders;
  for (vtkIdType p = 0; p < fine->GetNumberOfPoints(); ++p)
  {
    count += linear->GetTuple1(p) != linear->GetTuple1(p);
  }
  EXPECT_GE(exchange.sum(count), 13); // the centre, and the middles of 12 edges
  EXPECT_EQ(cadtest::fieldValue(fine, "InvalidCells"), 0);
}

/// Arrays of the same name and another type on two ranks: those of the one do not reach the other.
TEST_F(BadArrays, withAnotherTypeOnAnotherRank)
{
  const Grid whole = ball();
  const auto piece = pieceOf(whole);
  const auto array = isLast() ? vtkSmartPointer<vtkDataArray>(make<vtkFloatArray>("Mixed", 2, 0))
                              : vtkSmartPointer<vtkDataArray>(make<vtkIntArray>("Mixed", 1, 0));
  array->SetNumberOfTuples(piece->GetNumberOfPoints());
  array->Fill(1);
  piece->GetPointData()->AddArray(array);
  const auto fine = filters.refineUniformly(filters.project(piece));
  EXPECT_EQ(cadtest::fieldValue(fine, "GlobalCells"), 160);
  EXPECT_EQ(cadtest::fieldValue(fine, "InvalidCells"), 0);
}

} // namespace

} // namespace cadrefine
