// A CAD file that changes between two updates.

#include "DataSets.h"
#include "FilterRun.h"
#include "ParallelTest.h"
#include "Partition.h"
#include "TestShapes.h"

#include <vtkCallbackCommand.h>

#include <algorithm>
#include <filesystem>

namespace cadrefine
{

namespace
{

/// A reader and a filter behind it. The mesh lies on the CAD at first.
class ChangedFile : public ParallelTest
{
protected:
  void SetUp() override
  {
    reader->SetController(worldController());
    reader->SetFileName(file.c_str());
    const auto whole = cadtest::taggedBall();
    filter->SetController(worldController());
    filter->SetInputDataObject(
      0, cadtest::pieceOf(whole, cadtest::deal(cadtest::Dealing::Random, whole, exchange.size()),
           exchange.rank(), false));
    filter->SetCADConnection(reader->GetOutputPort());
    vtkNew<vtkCallbackCommand> counter;
    counter->SetCallback(
      [](vtkObject*, unsigned long, void* count, void*) { ++*static_cast<int*>(count); });
    counter->SetClientData(&reads);
    reader->AddObserver(vtkCommand::StartEvent, counter);
    EXPECT_NEAR(updatedRadius(), 2, tolerance);
  }

  /// The largest distance of a point from the origin.
  double updatedRadius()
  {
    filter->Update();
    double largest = 0;
    vtkPointSet* const piece = vtkPointSet::SafeDownCast(filter->GetOutput());
    for (vtkIdType p = 0; p < piece->GetNumberOfPoints(); ++p)
    {
      Vector3 point;
      piece->GetPoint(p, point.data());
      largest = std::max(largest, norm(point));
    }
    return exchange.max(largest);
  }

  /// Puts a sphere into the place of the file that is there, as programs do that save safely.
  void replaceFile(double radius)
  {
    const std::string made = cadtest::writeInto(other, cadtest::sphere(radius), ".step");
    std::filesystem::rename(made, file);
    exchange.any(false); // all ranks have done so
  }

  static constexpr double tolerance = 1e-9;

  bool isAlone() const { return exchange.size() == 1; }

  cadtest::TemporaryFolder folder;
  cadtest::TemporaryFolder other;
  std::string file = cadtest::writeInto(folder, cadtest::sphere(2), ".step");
  vtkNew<vtkCADReader> reader;
  vtkNew<vtkProjectOntoCAD> filter;
  int reads = 0;
};

TEST_F(ChangedFile, isReadAnewByAnUpdateOfOneProcess)
{
  replaceFile(2.1);
  EXPECT_NEAR(updatedRadius(), isAlone() ? 2.1 : 2, tolerance);
  EXPECT_EQ(reads, isAlone() ? 2 : 1);
  EXPECT_NEAR(updatedRadius(), isAlone() ? 2.1 : 2, tolerance);
  EXPECT_EQ(reads, isAlone() ? 2 : 1) << "it has not changed again";
}

TEST_F(ChangedFile, isReadAnewWhereAllRanksAreTold)
{
  replaceFile(2.1);
  reader->Modified();
  EXPECT_NEAR(updatedRadius(), 2.1, tolerance);
  EXPECT_NEAR(updatedRadius(), 2.1, tolerance);
  EXPECT_EQ(reads, 2);
}

TEST_F(ChangedFile, thatIsGoneIsAnError)
{
  std::filesystem::remove(file);
  exchange.any(false);
  reader->Modified();
  const cadtest::Outcome outcome = cadtest::execute(reader);
  EXPECT_FALSE(outcome.succeeded);
  EXPECT_EQ(outcome.errors.size(), exchange.rank() == 0 ? 1u : 0u);
  EXPECT_EQ(reader->GetOutput()->GetNumberOfPartitionedDataSets(), 0u);
  replaceFile(2.1);
  reader->Modified();
  EXPECT_NEAR(updatedRadius(), 2.1, tolerance);
}

} // namespace

} // namespace cadrefine
