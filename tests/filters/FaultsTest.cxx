// One rank fails, at any place: all ranks fail with the reason, and go on afterwards.

#include "DataSets.h"
#include "FilterRun.h"
#include "InjectedFault.h"
#include "ParallelTest.h"
#include "Partition.h"
#include "TestShapes.h"
#include "Watchdog.h"

#include <vtkAdaptToCAD.h>
#include <vtkCADModelCache.h>
#include <vtkCallbackCommand.h>
#include <vtkDemandDrivenPipeline.h>
#include <vtkInformation.h>
#include <vtkObjectFactory.h>
#include <vtkSMPTools.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <map>
#include <set>

namespace cadrefine
{

namespace
{

using cadtest::FaultKind;
using cadtest::InjectedFault;
using Place = InjectedFault::Place;

/// The allocations of a filter on this rank by what it was doing, as it tells its progress.
class Stages
{
public:
  /// From here on. What step it is and what is counted in a text does not matter.
  void begin(const std::string& text)
  {
    end();
    const std::size_t colon = text.rfind(": ");
    open_ = colon == std::string::npos ? text : text.substr(colon + 2);
    open_ = open_.substr(0, open_.find_first_of("0123456789"));
    open_.erase(open_.find_last_not_of(' ') + 1);
    begin_ = InjectedFault::allocations();
  }

  void end()
  {
    const std::int64_t count = InjectedFault::allocations() - begin_;
    if (!open_.empty() && count > 0)
    {
      ranges_[open_].push_back({ begin_, count });
    }
    open_.clear();
  }

  std::set<std::string> names() const
  {
    std::set<std::string> result;
    for (const auto& entry : ranges_)
    {
      result.insert(entry.first);
    }
    return result;
  }

  int count() const { return static_cast<int>(ranges_.size()); }

  /// The allocation after this part of those of the stage; none where there are fewer stages.
  std::int64_t allocation(int stage, double part) const
  {
    if (stage >= count())
    {
      return InjectedFault::none;
    }
    const auto& ranges = std::next(ranges_.begin(), stage)->second;
    std::int64_t total = 0;
    for (const Range& range : ranges)
    {
      total += range.count;
    }
    auto left = static_cast<std::int64_t>(part * static_cast<double>(total));
    auto range = ranges.begin();
    for (; left >= range->count; ++range)
    {
      left -= range->count;
    }
    return range->begin + left;
  }

private:
  struct Range
  {
    std::int64_t begin;
    std::int64_t count;
  };
  std::map<std::string, std::vector<Range>> ranges_;
  std::string open_;
  std::int64_t begin_ = 0;
};

/// What a filter of the kind below meets on this rank, and what it did.
struct Fault
{
  FaultKind kind = FaultKind::Memory;
  std::int64_t allocation = InjectedFault::none;
  Stages stages;
};
Fault fault;

void beginStage(vtkObject* filter, unsigned long, void*, void*)
{
  const char* const text = vtkAlgorithm::SafeDownCast(filter)->GetProgressText();
  fault.stages.begin(text ? text : "");
}

/// A filter whose work on its data meets the fault.
template<class Filter>
class Faulty : public Filter
{
public:
  static Faulty* New() { VTK_STANDARD_NEW_BODY(Faulty); }

  vtkTypeBool ProcessRequest(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override
  {
    if (!request->Has(vtkDemandDrivenPipeline::REQUEST_DATA()))
    {
      return Filter::ProcessRequest(request, inputs, outputs);
    }
    vtkNew<vtkCallbackCommand> listener;
    listener->SetCallback(beginStage);
    const unsigned long tag = this->AddObserver(vtkCommand::ProgressEvent, listener);
    const auto library = reinterpret_cast<const void*>(&vtkCADModelCache::New);
    const InjectedFault injected(library, fault.kind, fault.allocation);
    const vtkTypeBool result = Filter::ProcessRequest(request, inputs, outputs);
    fault.stages.end();
    this->RemoveObserver(tag);
    return result;
  }
};

class Faults : public ParallelTest
{
protected:
  using Run = std::function<cadtest::Outcome()>;

  cadtest::TemporaryFolder folder;
  std::string cadFile = cadtest::writeInto(folder, cadtest::sphere(2), ".step");
  cadtest::FilterRun filters{ cadFile, worldController() };
  std::set<Place> places; ///< Where faults struck on this rank.

  vtkSmartPointer<vtkPointSet> ownPiece() const
  {
    const auto whole = cadtest::taggedBall();
    return cadtest::pieceOf(whole, cadtest::deal(cadtest::Dealing::Random, whole, exchange.size()),
      exchange.rank(), false);
  }

  template<class Filter, class Configure>
  Run runOf(const vtkSmartPointer<vtkPointSet>& mesh, const Configure& configure) const
  {
    return [this, mesh, configure]
    { return filters.attempt<Faulty<Filter>>(mesh.Get(), configure); };
  }

  /// Lets `run` fail on this rank, unless `allocation` is none. What ranks do who wait is
  /// computing.
  void runWithFault(const Run& run, FaultKind kind, std::int64_t allocation)
  {
    constexpr int mostSeconds = 10;
    const cadtest::Watchdog watchdog(mostSeconds);
    fault = { kind, allocation, {} };
    const cadtest::Outcome outcome = run();
    places.insert(InjectedFault::place());
    const bool hit = exchange.any(InjectedFault::place() != Place::Nowhere);
    const bool inReader = exchange.any(InjectedFault::place() == Place::OtherProcess);
    // A CAD file is read again without the step or the entity that failed, which a warning tells.
    const bool mended = inReader && outcome.succeeded;
    EXPECT_NE(outcome.succeeded && !mended, hit) << "allocation " << allocation;
    const auto& told = mended ? outcome.warnings : outcome.errors;
    EXPECT_EQ(outcome.errors.size() + (mended ? outcome.warnings.size() : 0),
      hit && exchange.rank() == 0 ? 1u : 0u);
    for (const std::string& text : told)
    {
      EXPECT_NE(text.find(cadtest::traceOf(kind)), std::string::npos) << text;
    }
  }

  /// Faults of all kinds on the first and the last rank at each stage, evenly over all that
  /// it allocates; rank 0 must have the `wanted` stages. Returns what the run gives without them,
  /// before or after.
  cadtest::Outcome failEverywhere(const Run& run, const std::set<std::string>& wanted)
  {
    constexpr int faults = 24;
    constexpr std::array kinds{ FaultKind::Memory, FaultKind::Exception, FaultKind::OpenCascade };
    fault = {};
    cadtest::Outcome reference = run();
    const Stages stages = fault.stages;
    const auto names = stages.names();
    EXPECT_TRUE(exchange.rank() > 0 ||
                std::includes(names.begin(), names.end(), wanted.begin(), wanted.end()))
      << testing::PrintToString(names);
    const auto stageCount = static_cast<int>(exchange.max(std::int64_t{ stages.count() }));
    const int rounds = std::max(1, faults / (3 * std::max(1, stageCount)));
    for (const int rank : std::set<int>{ 0, exchange.size() - 1 })
    {
      for (int k = 0; k < 3 * rounds * stageCount; ++k)
      {
        const int stage = k % stageCount;
        const int step = k / stageCount;
        const double part = (step + 0.5) / (3 * rounds);
        runWithFault(run, kinds[static_cast<std::size_t>(step + stage) % 3],
          rank == exchange.rank() ? stages.allocation(stage, part) : InjectedFault::none);
      }
    }
    fault = {};
    EXPECT_TRUE(run().succeeded);
    return reference;
  }

  /// With the stage that is there on several ranks only.
  std::set<std::string> withBalance(std::set<std::string> stages) const
  {
    if (exchange.size() > 1)
    {
      stages.insert("redistributing cells over the ranks");
    }
    return stages;
  }

  void expectAllFailTogether(const Run& run, const std::set<std::string>& wanted)
  {
    const auto reference = cadtest::gather(exchange, failEverywhere(run, wanted).pointSet());
    const auto again = cadtest::gather(exchange, run().pointSet());
    EXPECT_TRUE(again.points == reference.points);
    EXPECT_TRUE(again.cells == reference.cells);
  }
};

TEST_F(Faults, projection)
{
  expectAllFailTogether(runOf<vtkProjectOntoCAD>(ownPiece(), [](vtkProjectOntoCAD*) {}),
    { "finding the boundary", "finding the CAD faces of", "finding the CAD edges of", "projecting",
      "moving vertices onto the CAD" });
}

TEST_F(Faults, error)
{
  expectAllFailTogether(
    runOf<vtkCADGeometricError>(filters.project(ownPiece()), [](vtkCADGeometricError*) {}),
    { "reading the mesh", "projecting", "measuring facets" });
}

TEST_F(Faults, uniformRefinement)
{
  expectAllFailTogether(
    runOf<vtkRefineWithCAD>(filters.project(ownPiece()),
      [](vtkRefineWithCAD* filter) { filter->SetMethod(vtkRefineWithCAD::UNIFORM_BISECTION); }),
    withBalance({ "marking cells", "splitting cells", "projecting", "moving vertices onto the CAD",
      "smoothing cells" }));
}

TEST_F(Faults, longestEdgeRefinement)
{
  expectAllFailTogether(runOf<vtkRefineWithCAD>(filters.measure(filters.project(ownPiece()), 1),
                          [](vtkRefineWithCAD* filter)
                          {
                            filter->SetMarkingArray("GeometricError");
                            filter->SetThreshold(1e-3);
                          }),
    withBalance({ "marking cells", "splitting cells", "projecting", "moving vertices onto the CAD",
      "smoothing cells" }));
}

TEST_F(Faults, quadraticCells)
{
  expectAllFailTogether(runOf<vtkRefineWithCAD>(filters.project(ownPiece()),
                          [](vtkRefineWithCAD* filter)
                          {
                            filter->SetLevels(0);
                            filter->QuadraticCellsOn();
                          }),
    { "reading the mesh", "projecting" });
}

TEST_F(Faults, adaptation)
{
  expectAllFailTogether(
    runOf<vtkAdaptToCAD>(ownPiece(), [](vtkAdaptToCAD* filter) { filter->SetMaximumSteps(1); }),
    withBalance({ "finding the boundary", "projecting", "measuring facets", "marking cells",
      "splitting cells", "smoothing cells" }));
}

/// With all of its steps, each of which is told of on the last rank.
TEST_F(Faults, observedAdaptation)
{
  vtkNew<vtkCallbackCommand> observer;
  observer->SetCallback(
    [](vtkObject* filter, unsigned long, void*, void*)
    {
      auto* output = vtkAlgorithm::SafeDownCast(filter)->GetOutputDataObject(0);
      EXPECT_NE(vtkPointSet::SafeDownCast(output), nullptr);
    });
  expectAllFailTogether(runOf<vtkAdaptToCAD>(ownPiece(),
                          [this, &observer](vtkAdaptToCAD* filter)
                          {
                            filter->SetUniformSteps(1);
                            filter->SetMaximumSteps(1);
                            filter->QuadraticCellsOn();
                            if (exchange.rank() == exchange.size() - 1)
                            {
                              filter->AddObserver(vtkAdaptToCAD::StepEvent, observer);
                            }
                          }),
    withBalance({ "marking cells", "splitting cells" }));
}

TEST_F(Faults, validity)
{
  expectAllFailTogether(runOf<vtkMeshValidity>(ownPiece(), [](vtkMeshValidity*) {}),
    { "reading the mesh", "checking cells" });
}

/// Rank 0 reads by a program of its own, then all draw, each by one.
TEST_F(Faults, reading)
{
  setenv("CADREFINE_READER", CADREFINE_FAULTY_READER, 1);
  failEverywhere(
    [this]
    {
      vtkNew<Faulty<vtkCADReader>> reader;
      reader->SetController(worldController());
      reader->SetFileName(cadFile.c_str());
      return cadtest::execute(reader);
    },
    { "reading the CAD file", "drawing the CAD" });
  unsetenv("CADREFINE_READER");
  EXPECT_TRUE(exchange.any(places.count(Place::OtherProcess) > 0));
}

/// The loops that are shared out over threads, where they are long enough.
TEST_F(Faults, threads)
{
  if (exchange.size() > 1)
  {
    GTEST_SKIP() << "pieces are too small";
  }
  const auto mesh = filters.refineUniformly(filters.project(ownPiece()));
  vtkSMPTools::LocalScope(vtkSMPTools::Config{ 2, "STDThread", false },
    [&]
    {
      expectAllFailTogether(runOf<vtkProjectOntoCAD>(mesh, [](vtkProjectOntoCAD*) {}), {});
      expectAllFailTogether(
        runOf<vtkCADGeometricError>(filters.project(mesh), [](vtkCADGeometricError*) {}), {});
    });
  EXPECT_TRUE(exchange.any(places.count(Place::OtherThread) > 0));
}

} // namespace

} // namespace cadrefine
