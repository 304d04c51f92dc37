// Global ids and ghosts that lie, and pieces that do not match.

#include "BadMesh.h"
#include "DataSets.h"
#include "MeshChecks.h"
#include "TestMeshes.h"

#include <vtkBitArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkLongLongArray.h>
#include <vtkPointData.h>
#include <vtkSignedCharArray.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnsignedLongLongArray.h>

#include <cstring>
#include <limits>
#include <map>

namespace cadrefine
{

namespace
{

class BadIds : public BadMesh
{
protected:
  /// Gives points ids, the value of `idOf` of their number.
  template<class Array, class IdOf>
  static void setPointIds(vtkPointSet* mesh, const IdOf& idOf)
  {
    vtkNew<Array> ids;
    ids->SetName("Ids");
    for (vtkIdType p = 0; p < mesh->GetNumberOfPoints(); ++p)
    {
      ids->InsertNextValue(idOf(p));
    }
    mesh->GetPointData()->SetGlobalIds(ids);
  }

  /// The ball on the last rank alone, with these ids.
  template<class Array, class IdOf>
  Grid ballWithIds(const IdOf& idOf) const
  {
    Grid grid = isLast() ? ball() : Grid::New();
    setPointIds<Array>(grid, idOf);
    return grid;
  }

  /// Two cubes of side 1 beside each other, the one on the first rank and the other on the last; on
  /// one rank both. Points by coordinates, that of `move` moved by `by`.
  Grid cubeOfRank(Index move = -1, double by = 0) const
  {
    Mesh mesh = cadtest::cubeMesh(2, 0, 1);
    if (exchange.rank() == 0 || isLast())
    {
      for (Point3& point : mesh.points)
      {
        point[0] += isLast() ? 1 : 0;
      }
      if (move >= 0 && exchange.rank() == 0)
      {
        mesh.points[static_cast<std::size_t>(move)][1] += by;
      }
      return cadtest::toGrid(mesh);
    }
    return Grid::New();
  }

  vtkSmartPointer<vtkUnsignedCharArray> ghosts(vtkIdType count, unsigned char value) const
  {
    auto array = vtkSmartPointer<vtkUnsignedCharArray>::New();
    array->SetName(vtkDataSetAttributes::GhostArrayName());
    array->SetNumberOfValues(count);
    array->FillValue(value);
    return array;
  }

  /// Ids of points and cells of all ranks, with the number of times that they occur.
  std::map<std::int64_t, int> idsOf(vtkDataArray* array)
  {
    std::vector<std::vector<std::int64_t>> toFirst(exchange.size());
    auto* ids = vtkIdTypeArray::SafeDownCast(array);
    EXPECT_NE(ids, nullptr);
    if (ids)
    {
      toFirst[0].assign(ids->Begin(), ids->End());
    }
    std::map<std::int64_t, int> counts;
    for (const auto& list : exchange.allToAll(toFirst))
    {
      for (const std::int64_t id : list)
      {
        ++counts[id];
      }
    }
    return counts;
  }
};

TEST_F(BadIds, missingOnOneRank)
{
  const Grid whole = ball();
  const auto piece = pieceOf(whole);
  if (isLast())
  {
    cadtest::addGlobalIds(piece);
  }
  // alone, that rank has ids of all
  expectSame(filtersOfRawMeshes(), piece, exchange.size() > 1 ? whole.Get() : piece.Get());
}

TEST_F(BadIds, negative)
{
  const auto grid =
    ballWithIds<vtkIdTypeArray>([](vtkIdType p) { return p == 4 ? vtkIdType{ -1 } : p; });
  expectErrors(allFilters(), grid, "point 4 of the mesh has -1 as global id (array Ids)");
  const Grid cells = isLast() ? ball() : Grid::New();
  vtkNew<vtkIntArray> ids;
  ids->SetName("CellIds");
  for (vtkIdType c = 0; c < cells->GetNumberOfCells(); ++c)
  {
    ids->InsertNextValue(static_cast<int>(3 - c));
  }
  cells->GetCellData()->SetGlobalIds(ids);
  expectErrors(allFilters(), cells, "cell 4 of the mesh has -1 as global id (array CellIds)");
}

TEST_F(BadIds, ofPointsThatAreNotUsedDoNotMatter)
{
  const Grid grid = isLast() ? ball() : Grid::New();
  if (isLast())
  {
    grid->GetPoints()->InsertNextPoint(0.1, 0.2, 0.3);
  }
  setPointIds<vtkIdTypeArray>(grid, [](vtkIdType p) { return p == 13 ? vtkIdType{ -1 } : p; });
  EXPECT_EQ(cadtest::fieldValue(filters.project(grid), "GlobalVertices"), 13);
}

TEST_F(BadIds, thatAreNoWholeNumbers)
{
  for (const double bad : { 0.5, std::numeric_limits<double>::quiet_NaN(),
         std::numeric_limits<double>::infinity(), -2.0, 1e19 })
  {
    const auto grid = ballWithIds<vtkDoubleArray>(
      [&](vtkIdType p) { return p == 4 ? bad : static_cast<double>(p); });
    expectErrors(allFilters(), grid, "point 4 of the mesh has ");
  }
  const auto grid =
    ballWithIds<vtkUnsignedLongLongArray>([](vtkIdType p) { return ~0ULL - (p == 4 ? 0 : p); });
  expectErrors(allFilters(), grid, "point 0 of the mesh has 18446744073709551615 as global id");
}

/// Whole numbers in arrays of any type are ids like others.
TEST_F(BadIds, inFloatArrays)
{
  const auto grid =
    ballWithIds<vtkFloatArray>([](vtkIdType p) { return static_cast<float>(3 * p + 1); });
  const Grid whole = ball();
  setPointIds<vtkIdTypeArray>(whole, [](vtkIdType p) { return 3 * p + 1; });
  expectSame(filtersOfRawMeshes(), grid, whole);
}

/// Too large for single precision: several points have the same.
TEST_F(BadIds, inFloatArraysThatCannotHoldThem)
{
  const auto grid =
    ballWithIds<vtkFloatArray>([](vtkIdType p) { return static_cast<float>((1 << 24) + p); });
  expectErrors(
    allFilters(), grid, "the points 0 and 1 of the mesh have the same global id, 16777216");
}

TEST_F(BadIds, doubledOnARank)
{
  const auto grid = ballWithIds<vtkIdTypeArray>([](vtkIdType p) { return p == 4 ? 2 : p; });
  expectErrors(allFilters(), grid, "the points 2 and 4 of the mesh have the same global id, 2");
}

/// Each rank counts its points from 0. Points in the box round another piece, and outside.
TEST_F(BadIds, doubledOnTwoRanks)
{
  const Grid grid = cubeOfRank();
  setPointIds<vtkIdTypeArray>(grid, [](vtkIdType p) { return p; });
  if (exchange.size() > 1)
  {
    expectErrors(allFilters(), grid, "have the global id 0: (0, 0, 0) on rank 0 and (1, 0, 0)");
  }
  setPointIds<vtkIdTypeArray>(
    grid, [&](vtkIdType p) { return p == 0 ? 1000 : p + 100 * exchange.rank(); });
  if (exchange.size() > 1)
  {
    expectErrors(
      allFilters(), grid, "two points of the mesh have the global id 1000: (0, 0, 0) on rank 0");
  }
}

TEST_F(BadIds, ofCellsDoubled)
{
  const Grid whole = ball();
  cadtest::addGlobalIds(whole);
  whole->GetCellData()->GetGlobalIds()->SetTuple(
    19, whole->GetCellData()->GetGlobalIds()->GetTuple(0));
  const auto piece = pieceOf(whole);
  const auto projected = filters.project(piece);
  const auto outcome = filters.attempt<vtkRefineWithCAD>(projected, [](vtkRefineWithCAD*) {});
  expectError(outcome, "the same global id (5); the corners of one are (");
  expectErrors({ allFilters()[1] }, piece, "the same global id (5)");
}

/// Every bit of them is kept, also where cells go to other ranks and where cells are cut.
TEST_F(BadIds, beyond53Bits)
{
  constexpr vtkIdType first = (vtkIdType{ 1 } << 61) + 1;
  const auto withIds = [&](vtkPointSet* mesh)
  {
    setPointIds<vtkIdTypeArray>(mesh, [&](vtkIdType p) { return first + p; });
    vtkNew<vtkIdTypeArray> ids;
    ids->SetName("CellIds");
    for (vtkIdType c = 0; c < mesh->GetNumberOfCells(); ++c)
    {
      ids->InsertNextValue(first + c);
    }
    mesh->GetCellData()->SetGlobalIds(ids);
  };
  const Grid grid = isLast() ? ball() : Grid::New();
  withIds(grid);
  const auto projected = filters.project(grid);
  EXPECT_EQ(
    idsOf(projected->GetCellData()->GetGlobalIds()).size(), exchange.rank() == 0 ? 20u : 0u);
  const auto fine = filters.refineUniformly(projected);
  const auto ids = idsOf(fine->GetPointData()->GetGlobalIds());
  if (exchange.rank() == 0)
  {
    EXPECT_EQ(ids.size(), 55u); // 13 points and 42 edges
    for (vtkIdType p = 0; p < 55; ++p)
    {
      EXPECT_EQ(ids.count(first + p), 1u) << p;
    }
  }
}

TEST_F(BadIds, tooLarge)
{
  const auto grid = ballWithIds<vtkIdTypeArray>(
    [](vtkIdType p) { return std::numeric_limits<vtkIdType>::max() - 20 + p; });
  expectErrors(allFilters(), grid, "as global id (array Ids); global ids are whole numbers from 0");
}

/// Arrays of any type come to other ranks as they are.
TEST_F(BadIds, arraysKeepTheirTypesAndBitsOnOtherRanks)
{
  constexpr long long large = (1LL << 60) + 1;
  const Grid grid = isLast() ? ball() : Grid::New();
  vtkNew<vtkSignedCharArray> signs;
  signs->SetName("Signs");
  vtkNew<vtkLongLongArray> numbers;
  numbers->SetName("Numbers");
  vtkNew<vtkStringArray> texts;
  texts->SetName("Texts");
  vtkNew<vtkBitArray> bits;
  bits->SetName("Bits");
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
  {
    signs->InsertNextValue(static_cast<signed char>(-c));
    numbers->InsertNextValue(large + c);
    texts->InsertNextValue("cell " + std::to_string(c));
    bits->InsertNextValue(c % 3 == 0);
  }
  if (isLast())
  {
    grid->GetCellData()->SetScalars(signs);
    for (vtkAbstractArray* array : std::initializer_list<vtkAbstractArray*>{ numbers, texts, bits })
    {
      grid->GetCellData()->AddArray(array);
    }
  }
  const auto fine = filters.run<vtkRefineWithCAD>(grid,
    [](vtkRefineWithCAD* filter)
    {
      filter->SetMethod(vtkRefineWithCAD::UNIFORM_BISECTION);
      filter->ProjectNewVerticesOff();
    });
  EXPECT_GT(fine->GetNumberOfCells(), 0) << "cells are shared out";
  auto* newSigns = vtkSignedCharArray::SafeDownCast(fine->GetCellData()->GetScalars());
  auto* newNumbers = vtkLongLongArray::SafeDownCast(fine->GetCellData()->GetArray("Numbers"));
  auto* newTexts = vtkStringArray::SafeDownCast(fine->GetCellData()->GetAbstractArray("Texts"));
  auto* newBits = vtkBitArray::SafeDownCast(fine->GetCellData()->GetArray("Bits"));
  EXPECT_TRUE(newSigns);
  EXPECT_TRUE(newNumbers);
  EXPECT_TRUE(newTexts);
  EXPECT_TRUE(newBits);
  for (vtkIdType c = 0;
       newSigns && newNumbers && newTexts && newBits && c < fine->GetNumberOfCells(); ++c)
  {
    const int parent = -newSigns->GetValue(c);
    EXPECT_EQ(newNumbers->GetValue(c), large + parent);
    EXPECT_EQ(newTexts->GetValue(c), "cell " + std::to_string(parent));
    EXPECT_EQ(newBits->GetValue(c), parent % 3 == 0);
  }
}

/// Points with the same id at other places on two ranks; without ids they are two points, and what
/// is between them is boundary, on any number of ranks.
TEST_F(BadIds, piecesThatDoNotMatch)
{
  const auto withIds = [&](const Grid& grid)
  {
    const Grid straight = cubeOfRank();
    setPointIds<vtkIdTypeArray>(grid,
      [&](vtkIdType p)
      {
        const double* x = straight->GetPoint(p);
        return static_cast<vtkIdType>(2 * x[0] + 10 * x[1] + 100 * x[2]);
      });
    return grid;
  };
  const Index onInterface = 2 + 3 * 1 + 9 * 1; // (1, 0.5, 0.5)
  const Grid apart = cubeOfRank(onInterface, 1e-12);
  const double vertices = cadtest::fieldValue(
    filters.run<vtkMeshValidity>(apart, [](vtkMeshValidity*) {}), "GlobalVertices");
  EXPECT_EQ(vertices, exchange.size() > 1 ? 46 : 27);
  if (exchange.size() > 1)
  {
    expectErrors(allFilters(), withIds(apart),
      "pieces of the mesh do not match: the point with global id 57 is at (1, ");
    EXPECT_EQ(cadtest::fieldValue(
                filters.run<vtkMeshValidity>(withIds(cubeOfRank()), [](vtkMeshValidity*) {}),
                "GlobalVertices"),
      45);
  }
}

TEST_F(BadIds, allCellsAreGhosts)
{
  const Grid grid = ball();
  grid->GetCellData()->AddArray(ghosts(20, vtkDataSetAttributes::DUPLICATECELL));
  expectErrors(allFilters(), grid, "all cells of the mesh are empty, or marked as ghosts");
  const Grid whole = ball();
  expectSame(filtersOfRawMeshes(), isLast() ? whole : grid, whole);
}

/// Cells that no other rank has: they are left out all the same.
TEST_F(BadIds, ghostsThatDoNotExistElsewhere)
{
  const Grid grid = isLast() ? ball() : Grid::New();
  Mesh mesh = cadtest::ballMesh(2, 0.03);
  const auto array = ghosts(grid->GetNumberOfCells(), 0);
  if (isLast())
  {
    array->SetValue(3, vtkDataSetAttributes::DUPLICATECELL);
    array->SetValue(7, vtkDataSetAttributes::HIDDENCELL);
    array->SetValue(11, vtkDataSetAttributes::REFINEDCELL);
    array->SetValue(12, vtkDataSetAttributes::HIGHCONNECTIVITYCELL); // a mere property
  }
  grid->GetCellData()->AddArray(array);
  for (const std::ptrdiff_t cell : { 11, 7, 3 })
  {
    mesh.tetrahedra.erase(mesh.tetrahedra.begin() + cell);
  }
  expectSame(filtersOfRawMeshes(), grid, cadtest::toGrid(mesh));
}

TEST_F(BadIds, ghostPointsDoNotCount)
{
  const Grid whole = ball();
  const auto piece = pieceOf(whole);
  piece->GetPointData()->AddArray(
    ghosts(piece->GetNumberOfPoints(), vtkDataSetAttributes::DUPLICATEPOINT));
  expectSame(filtersOfRawMeshes(), piece, whole);
}

TEST_F(BadIds, ghostArraysOfAnotherTypeOrLength)
{
  const Grid grid = isLast() ? ball() : Grid::New();
  vtkNew<vtkIntArray> numbers;
  numbers->SetName(vtkDataSetAttributes::GhostArrayName());
  numbers->SetNumberOfValues(grid->GetNumberOfCells());
  numbers->FillValue(0);
  grid->GetCellData()->AddArray(numbers);
  expectErrors(allFilters(), grid, "the cell array vtkGhostType");
  grid->GetCellData()->RemoveArray(vtkDataSetAttributes::GhostArrayName());
  if (isLast())
  {
    grid->GetCellData()->AddArray(ghosts(19, 0));
  }
  expectErrors(allFilters(), grid, "the cell array vtkGhostType has 19 values for 20 cells");
}

/// Cells on two ranks that neither marks, deep enough that their points are inside both pieces.
TEST_F(BadIds, ghostsThatAreNotMarked)
{
  if (exchange.size() == 1)
  {
    GTEST_SKIP() << "one piece cannot overlap";
  }
  const Mesh cube = cadtest::cubeMesh(4, 0, 1);
  for (const double depth : { 0.25, 0.5, 1.0 })
  {
    Mesh mesh = cube;
    mesh.tetrahedra.clear();
    for (const auto& cell : cube.tetrahedra)
    {
      double low = 1;
      double high = 0;
      for (const Index v : cell)
      {
        low = std::min(low, cube.points[v][0]);
        high = std::max(high, cube.points[v][0]);
      }
      if ((exchange.rank() == 0 && high <= depth) || (isLast() && low >= 0))
      {
        mesh.tetrahedra.push_back(cell);
      }
    }
    const auto grid = cadtest::toGrid(mesh);
    const auto outcome = filters.attempt<vtkProjectOntoCAD>(grid, [](vtkProjectOntoCAD*) {});
    expectError(outcome, "on all but one");
    cadtest::addGlobalIds(grid); // by the numbers of points, which are the same on all ranks
    expectErrors(filtersOfRawMeshes(), grid, "a cell that several ranks hold must be marked");
  }
}

} // namespace

} // namespace cadrefine
