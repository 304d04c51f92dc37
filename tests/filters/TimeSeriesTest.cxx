// Time series: what was made of a geometry is kept as long as the geometry stays, and only then.

#include "DataSets.h"
#include "FilterRun.h"
#include "ParallelTest.h"
#include "Partition.h"
#include "Pipeline.h"
#include "SpoiltCube.h"
#include "TestMeshes.h"
#include "TestShapes.h"

#include <vtkCallbackCommand.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkPointData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkUnstructuredGrid.h>

#include <functional>
#include <limits>

namespace cadrefine
{
namespace
{

constexpr double radius = 2;

vtkSmartPointer<vtkPointSet> taggedBall()
{
  Mesh mesh = cadtest::ballMesh(radius, 0.05);
  mesh.triangles = cadtest::sphereMesh(radius, 0.05).triangles;
  auto grid = cadtest::toGrid(mesh);
  cadtest::addArrays(grid);
  return grid;
}

/// A cell array that marks the cells whose Tag is below `limit`.
void addIndicator(vtkUnstructuredGrid* grid, double limit)
{
  vtkDataArray* tags = grid->GetCellData()->GetArray("Tag");
  vtkNew<vtkDoubleArray> indicator;
  indicator->SetName("Indicator");
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
  {
    indicator->InsertNextValue(tags->GetTuple1(c) < limit ? 1 : 0);
  }
  grid->GetCellData()->AddArray(indicator);
}

void stretch(vtkUnstructuredGrid* grid, double factor)
{
  for (vtkIdType p = 0; p < grid->GetNumberOfPoints(); ++p)
  {
    double x[3];
    grid->GetPoint(p, x);
    x[0] *= factor;
    grid->GetPoints()->SetPoint(p, x);
  }
}

using cadtest::Pipeline;

/// The series is dealt out at random, so that refining moves cells between ranks.
class TimeSeries : public ParallelTest
{
protected:
  using Setup = Pipeline::Setup;

  cadtest::TemporaryFolder folder;
  std::string cadFile = cadtest::writeInto(folder, cadtest::sphere(radius), ".brep");
  vtkSmartPointer<vtkPointSet> whole = taggedBall();

  vtkSmartPointer<vtkPointSet> piece(bool ghosts = false) const
  {
    return cadtest::pieceOf(whole, cadtest::deal(cadtest::Dealing::Random, whole, exchange.size()),
      exchange.rank(), ghosts);
  }

  Pipeline makePipeline(const Setup& setup = [](Pipeline&) {}) const
  {
    return Pipeline(piece(), cadFile, worldController(), setup);
  }

  static bool update(vtkMeshAlgorithm* filter, int step)
  {
    return filter->UpdateTimeStep(step) != 0;
  }

  /// Whether the last run took the kept result.
  static bool isReused(vtkMeshAlgorithm* filter)
  {
    const std::string text = filter->GetRunStatistics();
    const bool isReused = text.find("\"geometry reused\": 1") != std::string::npos;
    EXPECT_NE(isReused, text.find("\"geometry reused\": 0") != std::string::npos) << text;
    return isReused;
  }

  static vtkPointSet* meshOf(vtkMeshAlgorithm* filter)
  {
    return vtkPointSet::SafeDownCast(filter->GetOutputDataObject(0));
  }

  static vtkTable* tableOf(vtkAdaptToCAD* filter)
  {
    return vtkTable::SafeDownCast(filter->GetOutputDataObject(1));
  }

  /// Of this rank.
  static void expectSame(vtkPointSet* mesh, vtkPointSet* expected)
  {
    RankExchange alone(nullptr);
    const cadtest::CanonicalMesh own = cadtest::gather(alone, mesh);
    const cadtest::CanonicalMesh other = cadtest::gather(alone, expected);
    EXPECT_TRUE(own.points == other.points);
    EXPECT_TRUE(own.cells == other.cells);
    EXPECT_EQ(own.contradictions, 0);
    EXPECT_EQ(mesh->GetNumberOfPoints(), expected->GetNumberOfPoints());
    EXPECT_EQ(cadtest::differentFields(mesh, expected), std::vector<std::string>());
  }

  /// The outputs are those of filters that have seen this step alone.
  void expectAsFresh(
    const Pipeline& pipeline, int step, const Setup& setup = [](Pipeline&) {})
  {
    const Pipeline fresh = makePipeline(setup);
    const auto expected = fresh.filters();
    const auto filters = pipeline.filters();
    for (std::size_t f = 0; f < filters.size(); ++f)
    {
      SCOPED_TRACE(filters[f]->GetClassName());
      ASSERT_TRUE(update(expected[f], step));
      EXPECT_FALSE(isReused(expected[f]));
      expectSame(meshOf(filters[f]), meshOf(expected[f]));
      EXPECT_EQ(cadtest::fieldValue(meshOf(filters[f]), "Step"), step);
    }
  }

  /// Whether each of the filters reused its geometry at this step; all must run.
  static std::vector<bool> run(const Pipeline& pipeline, int step)
  {
    std::vector<bool> reused;
    for (vtkMeshAlgorithm* filter : pipeline.filters())
    {
      EXPECT_TRUE(update(filter, step));
      reused.push_back(isReused(filter));
    }
    return reused;
  }
};

const std::vector<bool> none(5, false);
const std::vector<bool> all(5, true);

TEST_F(TimeSeries, takesTheFieldsAlongOnTheSameMesh)
{
  const Pipeline pipeline = makePipeline();
  EXPECT_EQ(run(pipeline, 0), none);
  std::vector<vtkMTimeType> times;
  for (vtkMeshAlgorithm* filter : pipeline.filters())
  {
    times.push_back(vtkUnstructuredGrid::SafeDownCast(meshOf(filter))->GetMeshMTime());
  }
  const auto timeOfCAD = [&] { return pipeline.cad->GetOutputDataObject(0)->GetUpdateTime(); };
  const vtkMTimeType read = timeOfCAD();
  for (const int step : { 1, 3, 2 })
  {
    EXPECT_EQ(run(pipeline, step), all);
  }
  EXPECT_EQ(timeOfCAD(), read) << "the CAD file was read again";
  expectAsFresh(pipeline, 2);
  for (std::size_t f = 0; f < times.size(); ++f)
  {
    auto* grid = vtkUnstructuredGrid::SafeDownCast(meshOf(pipeline.filters()[f]));
    EXPECT_EQ(grid->GetMeshMTime(), times[f]);
  }
}

TEST_F(TimeSeries, readsTheStepThatIsAskedForAlone)
{
  const Pipeline pipeline = makePipeline();
  for (const int step : { 3, 1 })
  {
    ASSERT_TRUE(update(pipeline.validity, step));
  }
  EXPECT_EQ(pipeline.series->runs(), 2);
}

TEST_F(TimeSeries, keepsTheTableOfAnAdaptation)
{
  const Pipeline pipeline = makePipeline();
  ASSERT_TRUE(update(pipeline.adapt, 0));
  const vtkIdType rows = tableOf(pipeline.adapt)->GetNumberOfRows();
  EXPECT_EQ(rows, exchange.rank() == 0 ? 3 : 0);
  ASSERT_TRUE(update(pipeline.adapt, 1));
  EXPECT_TRUE(isReused(pipeline.adapt));
  EXPECT_EQ(tableOf(pipeline.adapt)->GetNumberOfRows(), rows);
  EXPECT_TRUE(tableOf(pipeline.adapt)->GetFieldData()->HasArray("StopReason"));
}

/// Cells are exchanged: fields follow the rows that were found with another step.
TEST_F(TimeSeries, takesTheFieldsAlongThroughOperations)
{
  cadFile = cadtest::writeInto(folder, cadtest::box(1, 1, 1), ".brep");
  whole = cadtest::toGrid(cadtest::spoiltCubeMesh(3));
  cadtest::addArrays(whole);
  const Setup setup = [](Pipeline& pipeline)
  {
    for (vtkMeshAlgorithm* filter : pipeline.filters())
    {
      filter->SetMinimumQuality(0.6);
    }
    for (vtkMeshAlgorithm* filter :
      std::vector<vtkMeshAlgorithm*>{ pipeline.project, pipeline.refine, pipeline.adapt })
    {
      filter->AddConservedArray("Heat");
      filter->AddConservedArray("Colour");
    }
  };
  const Pipeline pipeline = makePipeline(setup);
  EXPECT_EQ(run(pipeline, 0), none);
  const std::string statistics = pipeline.project->GetRunStatistics();
  EXPECT_NE(statistics.find("\"local operations\": "), std::string::npos) << statistics;
  EXPECT_EQ(statistics.find("\"local operations\": 0"), std::string::npos) << statistics;
  EXPECT_EQ(run(pipeline, 2), all);
  expectAsFresh(pipeline, 2, setup);
}

TEST_F(TimeSeries, takesTextAlong)
{
  const Pipeline pipeline = makePipeline();
  run(pipeline, 0);
  run(pipeline, 1);
  vtkCellData* cells = meshOf(pipeline.adapt)->GetCellData();
  auto* names = vtkStringArray::SafeDownCast(cells->GetAbstractArray("Name"));
  vtkDataArray* tags = cells->GetArray("Tag");
  const bool isThere = names && tags;
  EXPECT_EQ(isThere, meshOf(pipeline.adapt)->GetNumberOfCells() > 0);
  for (vtkIdType c = 0; isThere && c < names->GetNumberOfValues(); ++c)
  {
    ASSERT_EQ(names->GetValue(c), std::to_string(1 + static_cast<int>(tags->GetTuple1(c))));
  }
}

TEST_F(TimeSeries, takesTheFieldsAlongToMidNodes)
{
  for (const int levels : { 0, 1 })
  {
    const Setup quadratic = [&](Pipeline& pipeline)
    {
      pipeline.refine->SetLevels(levels);
      pipeline.refine->SetQuadraticCells(true);
    };
    const Pipeline pipeline = makePipeline(quadratic);
    EXPECT_EQ(run(pipeline, 0), none);
    EXPECT_EQ(run(pipeline, 1), all);
    expectAsFresh(pipeline, 1, quadratic);
  }
}

TEST_F(TimeSeries, leavesGhostsOutAgain)
{
  const Setup withGhosts = [&](Pipeline& pipeline) { pipeline.series->setMesh(piece(true)); };
  const Pipeline pipeline = makePipeline(withGhosts);
  EXPECT_EQ(run(pipeline, 0), none);
  EXPECT_EQ(run(pipeline, 1), all);
  expectAsFresh(pipeline, 1, withGhosts);
}

TEST_F(TimeSeries, startsAnewWhereThePointsMove)
{
  const Setup moving = [](Pipeline& pipeline)
  {
    pipeline.series->setChange(
      [](vtkUnstructuredGrid* grid, int step) { stretch(grid, 1 + 0.01 * step); });
  };
  const Pipeline pipeline = makePipeline(moving);
  for (const int step : { 0, 1, 2 })
  {
    EXPECT_EQ(run(pipeline, step), none);
  }
  expectAsFresh(pipeline, 2, moving);
}

TEST_F(TimeSeries, startsAnewOnAllRanksWhereOnePieceChanges)
{
  const int last = exchange.size() - 1;
  const Setup changing = [&](Pipeline& pipeline)
  {
    pipeline.series->setChange([&](vtkUnstructuredGrid* grid, int step)
      { addIndicator(grid, step < 2 || exchange.rank() != last ? 5 : 100); });
    pipeline.refine->SetIndicatorArray("Indicator");
    pipeline.refine->SetMarkingArray("");
    pipeline.adapt->SetIndicatorArray("Indicator");
    pipeline.adapt->SetErrorMarking(vtkAdaptToCAD::OFF);
  };
  const Pipeline pipeline = makePipeline(changing);
  EXPECT_EQ(run(pipeline, 0), none);
  EXPECT_EQ(run(pipeline, 1), all);
  // what does not mark by the indicator keeps its geometry
  EXPECT_EQ(run(pipeline, 2), (std::vector<bool>{ true, true, false, false, false }));
  expectAsFresh(pipeline, 2, changing);
  EXPECT_EQ(run(pipeline, 3), all);
  expectAsFresh(pipeline, 3, changing);
}

TEST_F(TimeSeries, startsAnewWhereAPropertyChanges)
{
  const Setup change = [](Pipeline& pipeline)
  {
    pipeline.project->SetMaximumDistance(1e-3);
    pipeline.adapt->SetRecursionDepth(3);
  };
  Pipeline pipeline = makePipeline();
  EXPECT_EQ(run(pipeline, 0), none);
  change(pipeline);
  EXPECT_EQ(run(pipeline, 1), none);
  expectAsFresh(pipeline, 1, change);
  EXPECT_EQ(run(pipeline, 2), all);
}

TEST_F(TimeSeries, startsAnewWhereTheCADChanges)
{
  const std::string larger = cadtest::writeInto(folder, cadtest::sphere(radius * 1.05), ".step");
  const Setup change = [&](Pipeline& pipeline) { pipeline.cad->SetFileName(larger.c_str()); };
  Pipeline pipeline = makePipeline();
  EXPECT_EQ(run(pipeline, 0), none);
  change(pipeline);
  EXPECT_EQ(run(pipeline, 1), none);
  expectAsFresh(pipeline, 1, change);
}

TEST_F(TimeSeries, keepsNothingOfAFailure)
{
  const Setup failing = [&](Pipeline& pipeline)
  {
    pipeline.series->setChange([&](vtkUnstructuredGrid* grid, int step)
      { stretch(grid, step == 1 ? std::numeric_limits<double>::quiet_NaN() : 1); });
  };
  const Pipeline pipeline = makePipeline(failing);
  EXPECT_EQ(run(pipeline, 0), none);
  for (vtkMeshAlgorithm* filter : { static_cast<vtkMeshAlgorithm*>(pipeline.project),
         static_cast<vtkMeshAlgorithm*>(pipeline.adapt) })
  {
    filter->UpdateInformation();
    filter->GetOutputInformation(0)->Set(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP(), 1.0);
    const cadtest::Outcome outcome = cadtest::execute(filter);
    EXPECT_FALSE(outcome.succeeded);
    EXPECT_EQ(outcome.errors.size(), exchange.rank() == 0 ? 1U : 0U);
  }
  EXPECT_EQ(run(pipeline, 2), (std::vector<bool>{ false, true, true, true, false }));
  expectAsFresh(pipeline, 2, failing);
}

TEST_F(TimeSeries, keepsNothingOfAnAdaptationThatWasInterrupted)
{
  const Setup steps = [](Pipeline& pipeline) { pipeline.adapt->SetMaximumSteps(3); };
  const Pipeline pipeline = makePipeline(steps);
  vtkNew<vtkCallbackCommand> abort;
  abort->SetCallback(
    [](vtkObject* object, unsigned long, void*, void*)
    {
      auto* filter = static_cast<vtkAlgorithm*>(object);
      filter->SetAbortExecute(filter->GetProgress() >= 0.25 ? 1 : 0); // of three steps the first
    });
  if (exchange.rank() == 0)
  {
    pipeline.adapt->AddObserver(vtkCommand::ProgressEvent, abort);
  }
  ASSERT_TRUE(update(pipeline.adapt, 0));
  EXPECT_EQ(tableOf(pipeline.adapt)->GetNumberOfRows(), exchange.rank() == 0 ? 2 : 0);
  pipeline.adapt->RemoveAllObservers();
  pipeline.adapt->SetAbortExecute(0);
  EXPECT_EQ(run(pipeline, 1), none);
  expectAsFresh(pipeline, 1, steps);
  EXPECT_EQ(tableOf(pipeline.adapt)->GetNumberOfRows(), exchange.rank() == 0 ? 4 : 0);
}

} // namespace
} // namespace cadrefine
