// A thousand updates of a pipeline, good and bad ones, leave no memory behind.

#include "DataSets.h"
#include "ParallelTest.h"
#include "Partition.h"
#include "Pipeline.h"
#include "TestShapes.h"

#include <vtkLogger.h>
#include <vtkUnstructuredGrid.h>

#include <array>
#include <limits>
#include <malloc.h>

namespace cadrefine
{
namespace
{

using cadtest::Pipeline;

/// What this process has allocated and not freed. Exact where glibc keeps nothing back for its
/// threads (GLIBC_TUNABLES=glibc.malloc.tcache_count=0).
std::int64_t bytesInUse()
{
  const struct mallinfo2 memory = mallinfo2();
  return static_cast<std::int64_t>(memory.uordblks + memory.hblkhd);
}

/// The settings of the pipeline come round again; those from here on are wrong.
constexpr int settings = 20;
constexpr int firstWrong = 15;
constexpr int wrongIndicator = 15;
constexpr int wrongFraction = 16;
constexpr int wrongMesh = 17;
constexpr int wrongArray = 18;
constexpr int wrongFile = 19;

class Leaks : public ParallelTest
{
protected:
  cadtest::TemporaryFolder folder;
  const std::array<std::string, 2> cadFiles = { cadtest::writeInto(
                                                  folder, cadtest::sphere(2), ".brep"),
    cadtest::writeInto(folder, cadtest::sphere(2.05), ".step") };
  bool isMeshWrong = false;

  Pipeline makePipeline()
  {
    const auto whole = cadtest::taggedBall();
    cadtest::addArrays(whole);
    const auto piece = cadtest::pieceOf(whole,
      cadtest::deal(cadtest::Dealing::Random, whole, exchange.size()), exchange.rank(), false);
    return Pipeline(piece, cadFiles[0], worldController(),
      [this](Pipeline& pipeline)
      {
        pipeline.series->setChange([this](vtkUnstructuredGrid* grid, int) { spoil(grid); });
        pipeline.refine->SetLevels(1);
        pipeline.adapt->SetMaximumSteps(1);
      });
  }

  /// On the last rank.
  void spoil(vtkUnstructuredGrid* grid) const
  {
    if (isMeshWrong && exchange.rank() == exchange.size() - 1)
    {
      grid->GetPoints()->SetPoint(0, std::numeric_limits<double>::quiet_NaN(), 0, 0);
    }
  }

  void setProperties(Pipeline& pipeline, int update)
  {
    const int setting = update % settings;
    isMeshWrong = setting == wrongMesh;
    pipeline.cad->SetFileName(
      setting == wrongFile ? "missing.step" : cadFiles[update / settings % 2].c_str());
    pipeline.project->SetMaximumDistance(setting % 5 == 1 ? 0.3 : 0);
    pipeline.measure->SetRecursionDepth(1 + setting / 4 % 2);
    pipeline.refine->SetMethod(setting % 6 == 2 ? vtkRefineWithCAD::UNIFORM_BISECTION
                                                : vtkRefineWithCAD::LONGEST_EDGE_BISECTION);
    pipeline.refine->SetMarking(
      setting % 4 == 0 ? vtkRefineWithCAD::BULK : vtkRefineWithCAD::THRESHOLD);
    pipeline.refine->SetFraction(setting == wrongFraction ? 0 : 0.5);
    pipeline.refine->SetMarkingArray(setting == wrongArray ? "Missing" : "GeometricError");
    pipeline.refine->SetQuadraticCells(setting % 6 == 4);
    pipeline.adapt->SetErrorMarking(vtkAdaptToCAD::THRESHOLD);
    pipeline.adapt->SetErrorThreshold(0.01 * (1 + setting % 3));
    pipeline.adapt->SetIndicatorArray(setting == wrongIndicator ? "Colour" : "");
    pipeline.series->Modified();
  }

  /// Of the chain of filters and the adaptation in turn.
  void update(Pipeline& pipeline, int number)
  {
    setProperties(pipeline, number);
    vtkMeshAlgorithm* filter = pipeline.adapt;
    if (number % 2 == 0)
    {
      filter = pipeline.validity;
    }
    const bool succeeded = filter->UpdateTimeStep(number % 5) != 0;
    EXPECT_EQ(succeeded, number % settings < firstWrong) << "update " << number;
  }
};

TEST_F(Leaks, noneOverAThousandUpdates)
{
  constexpr int updates = 1000;
  constexpr int settled = 200; // what is kept of the first ones (MPI, static objects) is there
  constexpr std::int64_t few = 4096; // 100 bytes for each round of the settings would be as much
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  Pipeline pipeline = makePipeline();
  std::int64_t before = 0;
  for (int number = 0; number < updates; ++number)
  {
    before = number == settled ? bytesInUse() : before;
    update(pipeline, number);
    if (number % settings == 0)
    {
      Pipeline another = makePipeline();
      update(another, number);
    }
  }
  const std::int64_t after = bytesInUse();
  RecordProperty("bytesAfter200", static_cast<int>(before));
  RecordProperty("bytesAfter1000", static_cast<int>(after));
  EXPECT_LT(after, before + few);
}

} // namespace
} // namespace cadrefine
