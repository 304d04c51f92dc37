// One rank runs out of memory, at any place: all ranks fail with the reason, and go on afterwards.

#include "DataSets.h"
#include "FailingAllocation.h"
#include "FilterRun.h"
#include "ParallelTest.h"
#include "Partition.h"
#include "TestShapes.h"

#include <vtkAdaptToCAD.h>
#include <vtkDemandDrivenPipeline.h>
#include <vtkInformation.h>
#include <vtkObjectFactory.h>

#include <functional>

namespace cadrefine
{

namespace
{

/// What a filter of the kind below does to this rank.
struct Fault
{
  std::int64_t allocation = cadtest::FailingAllocation::none;
  std::int64_t allocations = 0; ///< Made by the filter.
};
Fault fault;

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
    const cadtest::FailingAllocation failing(fault.allocation);
    const vtkTypeBool result = Filter::ProcessRequest(request, inputs, outputs);
    fault.allocations = cadtest::FailingAllocation::count();
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

  vtkSmartPointer<vtkPointSet> ownPiece() const
  {
    const auto whole = cadtest::taggedBall();
    return cadtest::pieceOf(whole, cadtest::deal(cadtest::Dealing::Random, whole, exchange.size()),
      exchange.rank(), false);
  }

  template<class Filter, class Configure>
  Run runOf(vtkSmartPointer<vtkPointSet> mesh, const Configure& configure) const
  {
    return [this, mesh, configure]
    { return filters.attempt<Faulty<Filter>>(mesh.Get(), configure); };
  }

  /// Lets `run` fail on a rank at its allocation of that number, if it makes so many.
  void runWithFault(const Run& run, int rank, std::int64_t allocation)
  {
    const bool mine = rank == exchange.rank();
    fault = { mine ? allocation : cadtest::FailingAllocation::none, 0 };
    const cadtest::Outcome outcome = run();
    const bool hit = exchange.any(mine && fault.allocations > allocation);
    EXPECT_NE(outcome.succeeded, hit) << "allocation " << allocation << " of rank " << rank;
    EXPECT_EQ(outcome.errors.size(), hit && exchange.rank() == 0 ? 1u : 0u);
    for (const std::string& error : outcome.errors)
    {
      EXPECT_NE(error.find("memory"), std::string::npos) << error;
    }
  }

  /// Faults on the first and the last rank, evenly over all that they allocate: where the run has
  /// many allocations, each at another place in the many places that are alike.
  void expectAllFailTogether(const Run& run)
  {
    constexpr std::int64_t faults = 40;
    fault = {};
    const auto reference = cadtest::gather(exchange, run().pointSet());
    const std::int64_t allocations = exchange.max(fault.allocations);
    RecordProperty("allocations", static_cast<int>(allocations));
    for (const int rank : { 0, exchange.size() - 1 })
    {
      for (std::int64_t k = 0; k < faults; ++k)
      {
        runWithFault(run, rank, k * allocations / faults + k % 7);
      }
    }
    fault = {};
    const auto again = cadtest::gather(exchange, run().pointSet());
    EXPECT_TRUE(again.points == reference.points);
    EXPECT_TRUE(again.cells == reference.cells);
  }
};

TEST_F(Faults, projection)
{
  expectAllFailTogether(runOf<vtkProjectOntoCAD>(ownPiece(), [](vtkProjectOntoCAD*) {}));
}

TEST_F(Faults, error)
{
  expectAllFailTogether(
    runOf<vtkCADGeometricError>(filters.project(ownPiece()), [](vtkCADGeometricError*) {}));
}

TEST_F(Faults, uniformRefinement)
{
  expectAllFailTogether(runOf<vtkRefineWithCAD>(filters.project(ownPiece()),
    [](vtkRefineWithCAD* filter) { filter->SetMethod(vtkRefineWithCAD::UNIFORM_BISECTION); }));
}

TEST_F(Faults, longestEdgeRefinement)
{
  expectAllFailTogether(runOf<vtkRefineWithCAD>(filters.measure(filters.project(ownPiece()), 1),
    [](vtkRefineWithCAD* filter)
    {
      filter->SetMarkingArray("GeometricError");
      filter->SetThreshold(1e-3);
    }));
}

TEST_F(Faults, quadraticCells)
{
  expectAllFailTogether(runOf<vtkRefineWithCAD>(filters.project(ownPiece()),
    [](vtkRefineWithCAD* filter)
    {
      filter->SetLevels(0);
      filter->QuadraticCellsOn();
    }));
}

TEST_F(Faults, adaptation)
{
  expectAllFailTogether(
    runOf<vtkAdaptToCAD>(ownPiece(), [](vtkAdaptToCAD* filter) { filter->SetMaximumSteps(2); }));
}

TEST_F(Faults, validity)
{
  expectAllFailTogether(runOf<vtkMeshValidity>(ownPiece(), [](vtkMeshValidity*) {}));
}

TEST_F(Faults, reading)
{
  const auto run = [this]
  {
    vtkNew<Faulty<vtkCADReader>> reader;
    reader->SetController(worldController());
    reader->SetFileName(cadFile.c_str());
    return cadtest::execute(reader);
  };
  fault = {};
  EXPECT_TRUE(run().succeeded);
  const std::int64_t allocations = exchange.max(fault.allocations);
  for (const int rank : { 0, exchange.size() - 1 })
  {
    for (const std::int64_t part : { 1, 2, 3, 4 })
    {
      runWithFault(run, rank, part * allocations / 5);
    }
  }
  fault = {};
  EXPECT_TRUE(run().succeeded);
}

} // namespace

} // namespace cadrefine
