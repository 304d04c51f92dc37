// Adapt To CAD on several ranks: the same mesh and table as on one, and one failure on all.

#include "DataSets.h"
#include "FilterRun.h"
#include "ParallelTest.h"
#include "Partition.h"
#include "TestMeshes.h"
#include "TestShapes.h"

#include <vtkAdaptToCAD.h>
#include <vtkCallbackCommand.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkPolyData.h>
#include <vtkTable.h>
#include <vtkUnstructuredGrid.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace cadrefine
{

namespace
{

using PointSet = vtkSmartPointer<vtkPointSet>;
using Columns = std::map<std::string, std::vector<double>>;
using Configure = std::function<void(vtkAdaptToCAD*)>;

/// Adapt To CAD with each kind of marking.
struct Marking
{
  const char* name;
  void (*configure)(vtkAdaptToCAD*);
};

void byThreshold(vtkAdaptToCAD* filter)
{
  filter->SetErrorMarking(vtkAdaptToCAD::THRESHOLD);
  filter->SetErrorThreshold(1e-3);
}

void byBulkAndIndicator(vtkAdaptToCAD* filter)
{
  filter->SetErrorMarking(vtkAdaptToCAD::BULK);
  filter->SetErrorFraction(0.6);
  filter->SetIndicatorArray("Indicator");
  filter->SetIndicatorMarking(vtkAdaptToCAD::FRACTION_OF_LARGEST);
  filter->SetIndicatorFraction(0.95);
}

void bySize(vtkAdaptToCAD* filter)
{
  filter->SetErrorMarking(vtkAdaptToCAD::OFF);
  filter->SetChordTolerance(0.005);
  filter->SetNormalAngle(15);
  filter->BalanceOff();
}

void byFaces(vtkAdaptToCAD* filter)
{
  filter->SetErrorMarking(vtkAdaptToCAD::OFF);
  filter->AddFace("0=0.005");
  filter->BoundaryCellsOn();
}

class AdaptPieces : public ParallelTest
{
protected:
  cadtest::TemporaryFolder folder;
  std::string sphere = cadtest::writeInto(folder, cadtest::sphere(2), ".step");

  static PointSet prepared(PointSet mesh)
  {
    cadtest::addArrays(mesh);
    vtkNew<vtkDoubleArray> indicator;
    indicator->SetName("Indicator");
    for (vtkIdType c = 0; c < mesh->GetNumberOfCells(); ++c)
    {
      indicator->InsertNextValue(static_cast<double>(c % 7));
    }
    mesh->GetCellData()->AddArray(indicator);
    cadtest::addGlobalIds(mesh);
    return mesh;
  }

  PointSet pieceOf(vtkPointSet* whole, cadtest::Dealing dealing) const
  {
    return cadtest::pieceOf(
      whole, cadtest::deal(dealing, whole, exchange.size()), exchange.rank(), false);
  }

  /// The whole mesh on rank 0, and the table of all ranks.
  struct Gathered
  {
    cadtest::CanonicalMesh mesh;
    Columns columns;
  };

  static Gathered gather(RankExchange& ranks, const cadtest::Outcome& outcome)
  {
    EXPECT_TRUE(outcome.succeeded);
    return { cadtest::gather(ranks, outcome.pointSet()), cadtest::columnsOf(outcome.secondOutput) };
  }

  void expectSame(const Gathered& pieces, const std::function<Gathered(RankExchange&)>& serial)
  {
    if (exchange.rank() > 0)
    {
      for (const auto& [name, values] : pieces.columns)
      {
        EXPECT_TRUE(values.empty()) << "the rows of " << name << " are on rank 0";
      }
      EXPECT_EQ(pieces.columns.count("GlobalGeometricError"), 1u);
      return;
    }
    RankExchange alone(nullptr);
    const Gathered expected = serial(alone);
    EXPECT_EQ(pieces.mesh.contradictions, 0);
    EXPECT_TRUE(pieces.mesh.points == expected.mesh.points);
    EXPECT_TRUE(pieces.mesh.cells == expected.mesh.cells);
    EXPECT_EQ(pieces.columns, expected.columns);
    EXPECT_GT(expected.columns.at("Step").size(), 2u);
  }

  void expectSameAsOneRank(const std::string& cadFile, PointSet whole, cadtest::Dealing dealing,
    const Configure& configure)
  {
    const cadtest::FilterRun filters(cadFile, worldController());
    whole = prepared(whole);
    expectSame(gather(exchange, filters.attempt<vtkAdaptToCAD>(pieceOf(whole, dealing), configure)),
      [&](RankExchange& alone) {
        return gather(alone, cadtest::FilterRun(cadFile).attempt<vtkAdaptToCAD>(whole, configure));
      });
  }

  void expectFailure(const PointSet& whole, const std::string& reason, const Configure& configure)
  {
    const cadtest::FilterRun filters(sphere, worldController());
    const auto outcome =
      filters.attempt<vtkAdaptToCAD>(pieceOf(whole, cadtest::Dealing::Blocks), configure);
    EXPECT_FALSE(outcome.succeeded);
    EXPECT_EQ(outcome.pointSet()->GetNumberOfPoints(), 0);
    EXPECT_TRUE(cadtest::columnsOf(outcome.secondOutput).empty());
    EXPECT_EQ(outcome.errors.size(), exchange.rank() == 0 ? 1u : 0u);
    if (!outcome.errors.empty())
    {
      EXPECT_NE(outcome.errors[0].find(reason), std::string::npos) << outcome.errors[0];
    }
  }

  static PointSet ball() { return cadtest::toGrid(cadtest::ballMesh(2, 0.03)); }
};

class AdaptPiecesBy
  : public AdaptPieces
  , public testing::WithParamInterface<Marking>
{
};

INSTANTIATE_TEST_SUITE_P(Markings, AdaptPiecesBy,
  testing::Values(Marking{ "Threshold", byThreshold },
    Marking{ "BulkAndIndicator", byBulkAndIndicator }, Marking{ "Size", bySize },
    Marking{ "Faces", byFaces }),
  [](const auto& each) { return std::string(each.param.name); });

TEST_P(AdaptPiecesBy, giveTheSameMeshAndTable)
{
  using cadtest::Dealing;
  const auto configure = [&](vtkAdaptToCAD* filter)
  {
    filter->SetMaximumSteps(4);
    GetParam().configure(filter);
  };
  expectSameAsOneRank(sphere, ball(), Dealing::Random, configure);
  expectSameAsOneRank(
    sphere, cadtest::toPolyData(cadtest::sphereMesh(2, 0.03)), Dealing::EmptyRank, configure);
  expectSameAsOneRank(CADREFINE_DATA "/three_arcs.igs",
    cadtest::readGrid(CADREFINE_DATA "/three_arcs_coarse.vtu"), Dealing::KdTree, configure);
}

TEST_F(AdaptPieces, giveTheSameWing)
{
  expectSameAsOneRank(CADREFINE_DATA "/naca0012_sharp.igs",
    cadtest::readGrid(CADREFINE_DATA "/naca0012_coarse.vtu"), cadtest::Dealing::EmptyRank,
    [](vtkAdaptToCAD* filter)
    {
      filter->SetErrorMarking(vtkAdaptToCAD::THRESHOLD);
      filter->SetErrorThreshold(1e-5);
      filter->SetMaximumSteps(2);
    });
}

/// Listed facets inside the mesh, whose cells are on other ranks.
TEST_F(AdaptPieces, giveTheSameInteriorBoundary)
{
  const Configure configure = [](vtkAdaptToCAD* filter)
  {
    filter->SetErrorMarking(vtkAdaptToCAD::OFF);
    filter->SetNormalAngle(25);
    filter->SetMaximumSteps(3);
  };
  expectSameAsOneRank(sphere, cadtest::toGrid(cadtest::ballInShellMesh(2, 0.03)),
    cadtest::Dealing::Random, configure);
}

void abortSecondStep(vtkObject* caller, unsigned long, void*, void*)
{
  auto* filter = static_cast<vtkAdaptToCAD*>(caller);
  if (filter->GetProgressText() && std::string(filter->GetProgressText()) == "Step 2")
  {
    filter->SetAbortExecute(1);
  }
}

/// One rank is enough.
TEST_F(AdaptPieces, keepTheStepWhereOneRankIsInterrupted)
{
  const cadtest::FilterRun filters(sphere, worldController());
  const PointSet whole = prepared(ball());
  vtkNew<vtkCallbackCommand> command;
  command->SetCallback(abortSecondStep);
  const auto outcome = filters.attempt<vtkAdaptToCAD>(pieceOf(whole, cadtest::Dealing::Random),
    [&](vtkAdaptToCAD* filter)
    {
      if (exchange.rank() == exchange.size() - 1)
      {
        filter->AddObserver(vtkCommand::ProgressEvent, command);
      }
    });
  const std::string reason = outcome.secondOutput->GetFieldData()
                               ->GetAbstractArray("StopReason")
                               ->GetVariantValue(0)
                               .ToString();
  EXPECT_EQ(reason, "interrupted");
  expectSame(gather(exchange, outcome),
    [&](RankExchange& alone)
    {
      return gather(alone, cadtest::FilterRun(sphere).attempt<vtkAdaptToCAD>(
                             whole, [](vtkAdaptToCAD* filter) { filter->SetMaximumSteps(2); }));
    });
}

/// The steps, as they are told of on the last rank alone; all communicate meanwhile.
struct Steps
{
  RankExchange& exchange;
  std::vector<cadtest::CanonicalMesh> meshes;
};

void takeStep(vtkObject* caller, unsigned long, void* client, void*)
{
  auto& steps = *static_cast<Steps*>(client);
  auto* output = static_cast<vtkAdaptToCAD*>(caller)->GetOutputDataObject(0);
  steps.meshes.push_back(cadtest::gather(steps.exchange, vtkPointSet::SafeDownCast(output)));
}

void observeSteps(vtkAdaptToCAD* filter, Steps& steps)
{
  vtkNew<vtkCallbackCommand> command;
  command->SetCallback(takeStep);
  command->SetClientData(&steps);
  filter->AddObserver(vtkAdaptToCAD::StepEvent, command);
}

void byAllSteps(vtkAdaptToCAD* filter)
{
  filter->SetUniformSteps(1);
  filter->SetMaximumSteps(2);
  filter->SetErrorMarking(vtkAdaptToCAD::THRESHOLD);
  filter->SetErrorThreshold(1e-3);
}

TEST_F(AdaptPieces, showTheSameSteps)
{
  const cadtest::FilterRun filters(sphere, worldController());
  const PointSet whole = prepared(ball());
  Steps steps{ exchange, {} };
  filters.attempt<vtkAdaptToCAD>(pieceOf(whole, cadtest::Dealing::Random),
    [&](vtkAdaptToCAD* filter)
    {
      byAllSteps(filter);
      observeSteps(filter, steps);
    });
  ASSERT_EQ(steps.meshes.size(), 4u);
  if (exchange.rank() == 0)
  {
    RankExchange alone(nullptr);
    Steps expected{ alone, {} };
    cadtest::FilterRun(sphere).attempt<vtkAdaptToCAD>(whole,
      [&](vtkAdaptToCAD* filter)
      {
        byAllSteps(filter);
        observeSteps(filter, expected);
      });
    ASSERT_EQ(expected.meshes.size(), 4u);
    for (std::size_t s = 0; s < 4; ++s)
    {
      EXPECT_EQ(steps.meshes[s].contradictions, 0);
      EXPECT_TRUE(steps.meshes[s].points == expected.meshes[s].points) << s;
      EXPECT_TRUE(steps.meshes[s].cells == expected.meshes[s].cells) << s;
    }
  }
}

/// One that aborts, on the last rank: it alone has an observer.
TEST_F(AdaptPieces, keepTheStepAfterWhichOneObserverAborts)
{
  const cadtest::FilterRun filters(sphere, worldController());
  const PointSet whole = prepared(ball());
  vtkNew<vtkCallbackCommand> command;
  command->SetCallback(
    [](vtkObject* caller, unsigned long, void*, void*)
    {
      auto* filter = static_cast<vtkAdaptToCAD*>(caller);
      if (std::string(filter->GetStepStatistics()).find(R"("step": 2,)") != std::string::npos)
      {
        filter->SetAbortExecute(1);
      }
    });
  const auto outcome = filters.attempt<vtkAdaptToCAD>(pieceOf(whole, cadtest::Dealing::Random),
    [&](vtkAdaptToCAD* filter)
    {
      if (exchange.rank() == exchange.size() - 1)
      {
        filter->AddObserver(vtkAdaptToCAD::StepEvent, command);
      }
    });
  expectSame(gather(exchange, outcome),
    [&](RankExchange& alone)
    {
      return gather(alone, cadtest::FilterRun(sphere).attempt<vtkAdaptToCAD>(
                             whole, [](vtkAdaptToCAD* filter) { filter->SetMaximumSteps(2); }));
    });
}

TEST_F(AdaptPieces, failTogether)
{
  const PointSet whole = prepared(ball());
  expectFailure(whole, "region is empty",
    [](vtkAdaptToCAD* filter)
    {
      filter->UseRegionOn();
      filter->SetRegion(1, -1, 1, -1, 1, -1);
    });
  expectFailure(
    whole, "Nonsense", [](vtkAdaptToCAD* filter) { filter->SetIndicatorArray("Nonsense"); });
  expectFailure(
    whole, "3 components", [](vtkAdaptToCAD* filter) { filter->SetIndicatorArray("Colour"); });
  for (const double fraction : { 0.0, 1.5, std::numeric_limits<double>::quiet_NaN() })
  {
    expectFailure(whole, "must be above 0 and at most 1",
      [&](vtkAdaptToCAD* filter)
      {
        filter->SetErrorMarking(vtkAdaptToCAD::FRACTION_OF_LARGEST);
        filter->SetErrorFraction(fraction);
      });
    expectFailure(whole, "must be above 0 and at most 1",
      [&](vtkAdaptToCAD* filter)
      {
        filter->SetIndicatorArray("Indicator");
        filter->SetIndicatorMarking(vtkAdaptToCAD::BULK);
        filter->SetIndicatorFraction(fraction);
      });
  }
}

/// On one rank; a threshold takes them.
TEST_F(AdaptPieces, failWhereOneValueHasNoPart)
{
  for (const double bad : { -1.0, std::numeric_limits<double>::infinity() })
  {
    const PointSet whole = prepared(ball());
    whole->GetCellData()->GetArray("Indicator")->SetTuple1(19, bad);
    for (const int strategy : { vtkAdaptToCAD::BULK, vtkAdaptToCAD::FRACTION_OF_LARGEST })
    {
      expectFailure(whole, "negative or not finite",
        [&](vtkAdaptToCAD* filter)
        {
          filter->SetIndicatorArray("Indicator");
          filter->SetIndicatorMarking(strategy);
        });
    }
    const cadtest::FilterRun filters(sphere, worldController());
    const auto outcome = filters.attempt<vtkAdaptToCAD>(pieceOf(whole, cadtest::Dealing::Blocks),
      [](vtkAdaptToCAD* filter)
      {
        filter->SetIndicatorArray("Indicator");
        filter->SetMaximumSteps(1);
      });
    EXPECT_TRUE(outcome.succeeded);
  }
}

TEST_F(AdaptPieces, failWhereOneValueIsNoNumber)
{
  const PointSet whole = prepared(ball());
  whole->GetCellData()
    ->GetArray("Indicator")
    ->SetTuple1(19, std::numeric_limits<double>::quiet_NaN());
  for (const int strategy :
    { vtkAdaptToCAD::THRESHOLD, vtkAdaptToCAD::FRACTION_OF_LARGEST, vtkAdaptToCAD::BULK })
  {
    expectFailure(whole, "contains NaN",
      [&](vtkAdaptToCAD* filter)
      {
        filter->SetIndicatorArray("Indicator");
        filter->SetIndicatorMarking(strategy);
      });
  }
}

TEST_F(AdaptPieces, failWithoutCells)
{
  vtkNew<vtkUnstructuredGrid> points;
  points->SetPoints(ball()->GetPoints());
  const cadtest::FilterRun filters(sphere, worldController());
  const auto outcome = filters.attempt<vtkAdaptToCAD>(points, [](vtkAdaptToCAD*) {});
  EXPECT_FALSE(outcome.succeeded);
  EXPECT_EQ(outcome.pointSet()->GetNumberOfPoints(), 0);
  EXPECT_TRUE(cadtest::columnsOf(outcome.secondOutput).empty());
}

} // namespace

} // namespace cadrefine
