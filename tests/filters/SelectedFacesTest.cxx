// The entries of the property Faces for what is selected in a view.

#include "DataSets.h"
#include "FilterRun.h"
#include "IgesCases.h"
#include "TestFiles.h"

#include <cadrefine/cad/model/CADModel.h>
#include <cadrefine/cad/model/EntitySelection.h>

#include <vtkCADModelCache.h>
#include <vtkCADSelectedFaces.h>
#include <vtkCellData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSignedCharArray.h>
#include <vtkStringArray.h>
#include <vtkTable.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace
{

using namespace cadrefine;
using Names = std::vector<std::string>;

/// Squares, one over the other, whose names are of all kinds.
struct SelectedFaces : testing::Test
{
  const Names labels{ "DECK", "RIB", "RIB", "A=B", "!X", "S*", "[S]", "" };
  cadtest::TemporaryFolder folder;
  cadtest::FilterRun filters{ fileOfSquares() };
  std::shared_ptr<const CADModel> model = vtkCADModelCache::Get(filters.cad());

  std::string fileOfSquares() const
  {
    cadtest::IgesWriter file;
    for (std::size_t i = 0; i < labels.size(); ++i)
    {
      cadtest::IgesAttributes attributes;
      attributes.label = labels[i];
      cadtest::addSquare(file, { 0, 0, static_cast<double>(i) }, attributes);
    }
    file.write(folder.file("squares.igs"));
    return folder.file("squares.igs");
  }

  /// Two triangles of the first square and of one at this height.
  static vtkSmartPointer<vtkPointSet> mesh(double height)
  {
    Mesh squares;
    squares.dimension = 2;
    squares.points = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 2, 0, height }, { 3, 0, height },
      { 3, 1, height } };
    squares.triangles = { { 0, 1, 2 }, { 3, 4, 5 } };
    return cadtest::toPolyData(squares);
  }

  Names entriesOf(vtkDataObject* selected, double heightOfMesh = 1) const
  {
    vtkNew<vtkCADSelectedFaces> finder;
    finder->SetController(nullptr);
    finder->SetInputDataObject(0, selected);
    finder->SetInputDataObject(1, filters.cad());
    finder->SetInputDataObject(2, mesh(heightOfMesh));
    const cadtest::Outcome outcome = cadtest::execute(finder);
    EXPECT_TRUE(outcome.succeeded) << testing::PrintToString(outcome.errors);
    auto* column = vtkStringArray::SafeDownCast(
      vtkTable::SafeDownCast(outcome.output)->GetColumnByName("Faces"));
    Names entries;
    std::string lines;
    for (vtkIdType row = 0; row < column->GetNumberOfValues(); ++row)
    {
      entries.push_back(column->GetValue(row));
      lines += column->GetValue(row) + "\n";
    }
    EXPECT_EQ(finder->GetFaces(), lines);
    EXPECT_EQ(finder->GetDimension(), heightOfMesh > 0 ? 2 : 1);
    return entries;
  }
};

/// Names that are no other face's and are read as names; otherwise numbers.
TEST_F(SelectedFaces, areNamesOrNumbers)
{
  const Names entries = entriesOf(filters.cad());
  ASSERT_EQ(entries.size(), labels.size());
  for (int face = 0; face < model->count(2); ++face)
  {
    SCOPED_TRACE(entries[face]);
    const bool isDeck = model->attributes({ 2, face }).name == "DECK";
    EXPECT_EQ(entries[face], isDeck ? "DECK" : std::to_string(face));
    const auto chosen = selectEntities(*model, 2, { entries[face] }, "Faces").chosen;
    EXPECT_EQ(std::count(chosen.begin(), chosen.end(), 1), 1);
    EXPECT_EQ(chosen[face], 1);
  }
}

/// A planar mesh is compared with edges.
TEST_F(SelectedFaces, areEdgesInThePlane)
{
  const Names entries = entriesOf(filters.cad(), 0);
  ASSERT_EQ(static_cast<int>(entries.size()), model->count(1));
  EXPECT_EQ(entries.back(), std::to_string(model->count(1) - 1));
}

/// Cells tell it; where they lie on no face, their points do.
TEST_F(SelectedFaces, areThoseOfCellsOrPoints)
{
  const auto selected = mesh(1);
  EXPECT_EQ(entriesOf(selected), Names());
  const auto write = [](vtkDataSetAttributes* to, const std::vector<EntityId>& entities)
  {
    vtkNew<vtkSignedCharArray> dimensions;
    vtkNew<vtkSignedCharArray> indices;
    dimensions->SetName("CADDimension");
    indices->SetName("CADEntity");
    for (const EntityId entity : entities)
    {
      dimensions->InsertNextValue(entity.dimension);
      indices->InsertNextValue(static_cast<signed char>(entity.index));
    }
    to->AddArray(dimensions);
    to->AddArray(indices);
  };
  write(selected->GetPointData(), { { 0, 1 }, { 1, 2 }, { 2, 3 }, {}, { 2, 6 }, { 2, 100 } });
  EXPECT_EQ(entriesOf(selected), Names({ "3", "6" }));
  write(selected->GetCellData(), { {}, { 1, 1 } });
  EXPECT_EQ(entriesOf(selected), Names({ "3", "6" }));
  write(selected->GetCellData(), { {}, { 2, 4 } });
  EXPECT_EQ(entriesOf(selected), Names({ "4" }));
}

} // namespace
