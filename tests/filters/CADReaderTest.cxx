// What the reader tells of a file beside its geometry: names, colours, and field data.

#include "IgesCases.h"
#include "TestFiles.h"
#include "vtkCADReader.h"

#include <vtkCallbackCommand.h>
#include <vtkCellData.h>
#include <vtkCommand.h>
#include <vtkDataSet.h>
#include <vtkDoubleArray.h>
#include <vtkExecutive.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPartitionedDataSet.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace
{

using namespace cadtest;

/// Two squares 0.001 apart, one of them red and named; a blanked line; a sphere, which is not read.
IgesWriter sample()
{
  IgesWriter file;
  IgesAttributes look;
  look.label = "DECK";
  look.colour = 2;
  addSquare(file, { 0, 0, 0 }, look);
  addSquare(file, { 1.001, 0, 0 }, {});
  IgesAttributes hidden;
  hidden.blanked = true;
  addLine(file, { 0, 3, 0 }, { 1, 3, 0 }, hidden);
  file.add(158, igesValues(1.0, 0.0, 0.0, 0.0));
  return file;
}

struct ReadOutcome
{
  vtkSmartPointer<vtkPartitionedDataSetCollection> output;
  std::string warning;

  vtkFieldData* fields() const { return output->GetFieldData(); }
  vtkCellData* cells(unsigned int part) const
  {
    return output->GetPartitionedDataSet(part)->GetPartition(0)->GetCellData();
  }
  std::string text(const char* name) const
  {
    auto* array = vtkStringArray::SafeDownCast(fields()->GetAbstractArray(name));
    return array && array->GetNumberOfValues() == 1 ? array->GetValue(0) : "";
  }
};

class CADReader : public testing::Test
{
protected:
  static void keepWarning(vtkObject*, unsigned long, void* client, void* text)
  {
    *static_cast<std::string*>(client) += static_cast<const char*>(text);
  }

  ReadOutcome read(const IgesWriter& file, bool drawing = true) const
  {
    ReadOutcome result;
    file.write(folder.file("file.igs"));
    vtkNew<vtkCADReader> reader;
    reader->SetController(nullptr);
    reader->SetFileName(folder.file("file.igs").c_str());
    reader->SetDrawing(drawing);
    vtkNew<vtkCallbackCommand> observer;
    observer->SetCallback(keepWarning);
    observer->SetClientData(&result.warning);
    reader->AddObserver(vtkCommand::WarningEvent, observer);
    EXPECT_NE(reader->GetExecutive()->Update(0), 0);
    result.output = vtkPartitionedDataSetCollection::SafeDownCast(reader->GetOutputDataObject(0));
    return result;
  }

  TemporaryFolder folder;
};

TEST_F(CADReader, showsNamesAndColours)
{
  const ReadOutcome result = this->read(sample());
  vtkCellData* const faces = result.cells(0);
  auto* const names = vtkStringArray::SafeDownCast(faces->GetAbstractArray("Name"));
  auto* const colours = vtkUnsignedCharArray::SafeDownCast(faces->GetAbstractArray("Color"));
  auto* const entities = faces->GetArray("CADEntity");
  ASSERT_TRUE(names && colours && entities);
  ASSERT_EQ(colours->GetNumberOfComponents(), 3);
  ASSERT_EQ(names->GetNumberOfValues(), entities->GetNumberOfTuples());
  int red = 0;
  for (vtkIdType cell = 0; cell < names->GetNumberOfValues(); ++cell)
  {
    const bool named = names->GetValue(cell) == "DECK";
    EXPECT_EQ(colours->GetValue(3 * cell), 255);
    EXPECT_EQ(colours->GetValue(3 * cell + 1), named ? 0 : 255);
    red += named ? 1 : 0;
  }
  EXPECT_EQ(2 * red, names->GetNumberOfValues());
  EXPECT_FALSE(result.cells(1)->GetAbstractArray("Name")) << "no edge has one";
}

TEST_F(CADReader, listsWhatIsNotInTheModel)
{
  const ReadOutcome result = this->read(sample());
  EXPECT_EQ(result.text("CADUnit"), "mm");
  EXPECT_EQ(result.text("CADUnread").find("DE 11: IGES 158 (sphere): "), 0u)
    << result.text("CADUnread");
  EXPECT_EQ(result.text("CADLeftOut"), "DE 9: IGES 110 (line): blanked");
  EXPECT_NE(result.warning.find("IGES 158"), std::string::npos) << result.warning;
  EXPECT_NE(result.warning.find("blanked"), std::string::npos) << result.warning;
}

TEST_F(CADReader, listsGaps)
{
  const ReadOutcome result = this->read(sample());
  auto* const gaps = result.fields()->GetArray("CADGaps");
  ASSERT_TRUE(gaps);
  ASSERT_EQ(gaps->GetNumberOfTuples(), 1);
  EXPECT_NEAR(gaps->GetComponent(0, 0), 1e-3, 1e-9);
  EXPECT_NEAR(gaps->GetComponent(0, 1), 1, 1.1e-3);
  EXPECT_NE(result.warning.find("1 gaps wider"), std::string::npos) << result.warning;
  auto* const tolerance = result.fields()->GetArray("CADSewingTolerance");
  ASSERT_TRUE(tolerance);
  EXPECT_GT(tolerance->GetComponent(0, 0), 0);
  EXPECT_LT(tolerance->GetComponent(0, 0), 1e-3);
}

TEST_F(CADReader, drawsNothingWhereNothingIsAskedFor)
{
  const ReadOutcome drawn = this->read(sample());
  const ReadOutcome bare = this->read(sample(), false);
  const auto bytesOf = [](const ReadOutcome& outcome)
  { return vtkUnsignedCharArray::SafeDownCast(outcome.fields()->GetArray("CADModel")); };
  ASSERT_TRUE(bytesOf(drawn) && bytesOf(bare));
  const vtkIdType size = bytesOf(drawn)->GetNumberOfValues();
  ASSERT_EQ(bytesOf(bare)->GetNumberOfValues(), size);
  EXPECT_TRUE(std::equal(
    bytesOf(drawn)->GetPointer(0), bytesOf(drawn)->GetPointer(size), bytesOf(bare)->GetPointer(0)));
  const auto textOf = [](const ReadOutcome& outcome)
  { return outcome.warning.substr(outcome.warning.find('\n', outcome.warning.find("): ")) + 1); };
  EXPECT_EQ(textOf(bare), textOf(drawn)); // before that stands the filter's address
  for (unsigned int part = 0; part < 3; ++part)
  {
    EXPECT_GT(drawn.cells(part)->GetNumberOfTuples(), 0);
    EXPECT_EQ(bare.cells(part)->GetNumberOfTuples(), 0);
    EXPECT_TRUE(bare.cells(part)->GetArray("CADEntity"));
  }
}

TEST_F(CADReader, isSilentWhereAllIsWell)
{
  IgesWriter file;
  addSquare(file, { 0, 0, 0 }, {});
  const ReadOutcome result = this->read(file);
  EXPECT_EQ(result.warning, "");
  EXPECT_FALSE(result.cells(0)->GetAbstractArray("Name"));
  EXPECT_FALSE(result.cells(0)->GetAbstractArray("Color"));
  EXPECT_EQ(result.fields()->GetArray("CADGaps")->GetNumberOfTuples(), 0);
}

} // namespace
