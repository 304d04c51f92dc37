// Adapt To CAD on one rank: what it makes, and why it stops.

#include "AdaptRun.h"
#include "DataSets.h"
#include "FilterRun.h"
#include "MeshChecks.h"
#include "TestMeshes.h"
#include "TestShapes.h"

#include <gtest/gtest.h>
#include <vtkAdaptToCAD.h>
#include <vtkCallbackCommand.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

namespace
{

using namespace cadrefine;
using cadtest::Adapted;
using cadtest::expectRow;
using cadtest::resultOf;
using Data = cadtest::FilterRun::Data;

class Adapt : public cadtest::AdaptRun
{
protected:
  using Configure = std::function<void(vtkAdaptToCAD*)>;

  Adapted adapt(vtkPointSet* mesh, const Configure& configure) const
  {
    return resultOf(filters.attempt<vtkAdaptToCAD>(mesh, configure));
  }

  static double field(const Adapted& adapted, const char* name)
  {
    return cadtest::fieldValue(adapted.mesh, name);
  }

  static void expectSound(vtkPointSet* data)
  {
    const Mesh mesh = cadtest::toMesh(data);
    EXPECT_TRUE(cadtest::isValid(mesh));
    EXPECT_TRUE(cadtest::hasNoHangingVertex(mesh));
  }

  static double largestOf(vtkPointSet* data, const char* name)
  {
    return data->GetCellData()->GetArray(name)->GetRange()[1];
  }

  static void addIndicator(vtkPointSet* data)
  {
    vtkNew<vtkDoubleArray> indicator;
    indicator->SetName("Indicator");
    for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c)
    {
      indicator->InsertNextValue(c < 5 ? 1 : 0);
    }
    data->GetCellData()->AddArray(indicator);
  }
};

std::int64_t countAbove(vtkPointSet* mesh, const char* name, double threshold)
{
  vtkDataArray* array = mesh->GetCellData()->GetArray(name);
  std::int64_t count = 0;
  for (vtkIdType c = 0; c < array->GetNumberOfTuples(); ++c)
  {
    count += array->GetTuple1(c) > threshold;
  }
  return count;
}

TEST_F(Adapt, isTheChainOfItsFilters)
{
  const cadtest::FilterRun wing(CADREFINE_DATA "/naca0012_sharp.igs");
  const auto coarse = cadtest::readGrid(CADREFINE_DATA "/naca0012_coarse.vtu");
  constexpr double threshold = 1e-5;
  for (const bool cut : { false, true })
  {
    const Adapted adapted = resultOf(wing.attempt<vtkAdaptToCAD>(coarse,
      [&](vtkAdaptToCAD* filter)
      {
        filter->SetCutFacets(cut);
        filter->SetErrorMarking(vtkAdaptToCAD::THRESHOLD);
        filter->SetErrorThreshold(threshold);
        filter->SetMaximumSteps(3);
      }));
    ASSERT_EQ(adapted.steps(), 3u);
    Data data = wing.measure(wing.project(coarse), 0);
    expectRow(adapted, 0, data);
    EXPECT_EQ(adapted.columns.at("MarkedCells")[0], 0);
    for (std::size_t step = 1; step <= 3; ++step)
    {
      EXPECT_EQ(
        adapted.columns.at("MarkedCells")[step], countAbove(data, "GeometricError", threshold));
      data = wing.measure(wing.run<vtkRefineWithCAD>(data,
                            [&](vtkRefineWithCAD* filter)
                            {
                              filter->SetCutFacets(cut);
                              filter->SetMarkingArray("GeometricError");
                              filter->SetThreshold(threshold);
                            }),
        0);
      expectRow(adapted, step, data);
    }
    EXPECT_TRUE(cadtest::areSame(adapted.mesh, data));
    expectSound(adapted.mesh);
  }
}

TEST_F(Adapt, withoutStepsProjectsAndMeasures)
{
  const Adapted adapted = adapt(ball,
    [](vtkAdaptToCAD* filter)
    {
      filter->SetMaximumSteps(0);
      filter->SetRecursionDepth(3);
    });
  EXPECT_TRUE(cadtest::areSame(adapted.mesh, filters.measure(filters.project(ball), 3)));
  EXPECT_EQ(adapted.steps(), 0u);
  EXPECT_NE(adapted.reason.find("MaximumSteps"), std::string::npos) << adapted.reason;
}

TEST_F(Adapt, stopsAtItsTarget)
{
  const Adapted all = adapt(ball, [](vtkAdaptToCAD* filter) { filter->SetMaximumSteps(4); });
  const auto& errors = all.columns.at("GlobalGeometricError");
  EXPECT_NE(all.reason.find("MaximumSteps"), std::string::npos) << all.reason;
  for (const std::size_t step : { 0, 2 })
  {
    const Adapted adapted =
      adapt(ball, [&](vtkAdaptToCAD* filter) { filter->SetTargetError(errors.at(step)); });
    EXPECT_EQ(adapted.steps(), step);
    EXPECT_LE(field(adapted, "GlobalGeometricError"), errors[step]);
    EXPECT_NE(adapted.reason.find("TargetError"), std::string::npos) << adapted.reason;
  }
}

TEST_F(Adapt, neverMakesMoreCellsThanAllowed)
{
  const Adapted all = adapt(ball, [](vtkAdaptToCAD* filter) { filter->SetMaximumSteps(4); });
  const auto& cells = all.columns.at("GlobalCells");
  for (const int spare : { 0, -1 })
  {
    const Adapted adapted = adapt(ball, [&](vtkAdaptToCAD* filter)
      { filter->SetMaximumCells(static_cast<vtkIdType>(cells.at(3)) + spare); });
    EXPECT_EQ(adapted.steps(), spare == 0 ? 3u : 2u);
    EXPECT_EQ(adapted.mesh->GetNumberOfCells(), cells.at(adapted.steps()));
    EXPECT_NE(adapted.reason.find("MaximumCells"), std::string::npos) << adapted.reason;
  }
}

TEST_F(Adapt, stopsWhereNoCellIsMarked)
{
  const Adapted adapted = adapt(ball,
    [](vtkAdaptToCAD* filter)
    {
      filter->SetErrorMarking(vtkAdaptToCAD::THRESHOLD);
      filter->SetErrorThreshold(100);
    });
  EXPECT_EQ(adapted.steps(), 0u);
  std::ostringstream reason;
  reason << "no cell is marked: the largest GeometricError is "
         << largestOf(adapted.mesh, "GeometricError") << ", the threshold 100";
  EXPECT_EQ(adapted.reason, reason.str());
  EXPECT_TRUE(cadtest::areSame(adapted.mesh, filters.measure(filters.project(ball), 0)));
  const Adapted full = adapt(ball,
    [](vtkAdaptToCAD* filter)
    {
      filter->SetErrorMarking(vtkAdaptToCAD::THRESHOLD);
      filter->SetErrorThreshold(100);
      filter->SetMaximumCells(1);
    });
  EXPECT_EQ(full.reason, reason.str()) << "that there are too many cells is no reason";
}

/// By a threshold that is given, otherwise in bulk.
TEST_F(Adapt, choosesItsMarkingByItself)
{
  constexpr double threshold = 2e-3;
  const auto marked = [&](int marking, double value)
  {
    return adapt(ball,
      [&](vtkAdaptToCAD* filter)
      {
        filter->SetErrorMarking(marking);
        filter->SetErrorThreshold(value);
        filter->SetMaximumSteps(2);
      });
  };
  const int automatic = vtkAdaptToCAD::AUTOMATIC;
  const auto byThreshold = marked(automatic, threshold);
  const auto inBulk = marked(automatic, 0);
  EXPECT_TRUE(cadtest::areSame(byThreshold.mesh, marked(vtkAdaptToCAD::THRESHOLD, threshold).mesh));
  EXPECT_TRUE(cadtest::areSame(inBulk.mesh, marked(vtkAdaptToCAD::BULK, threshold).mesh));
  EXPECT_NE(byThreshold.columns, inBulk.columns);
}

TEST_F(Adapt, refinesToAChordTolerance)
{
  const Adapted adapted = adapt(ball,
    [](vtkAdaptToCAD* filter)
    {
      filter->SetErrorMarking(vtkAdaptToCAD::OFF);
      filter->SetChordTolerance(0.02);
      filter->SetMaximumSteps(30);
    });
  std::ostringstream reason;
  reason << "no cell is marked: the largest ChordError is " << field(adapted, "MaximumChordError")
         << ", the threshold 0.02";
  EXPECT_EQ(adapted.reason, reason.str());
  EXPECT_LE(field(adapted, "MaximumChordError"), 0.02);
  EXPECT_EQ(largestOf(adapted.mesh, "ChordError"), field(adapted, "MaximumChordError"));
  EXPECT_GT(field(adapted, "MaximumChordError"), 0.002) << "not finer than needed";
  expectSound(adapted.mesh);
}

TEST_F(Adapt, refinesToAChordToleranceOnATorus)
{
  const cadtest::FilterRun torus(cadtest::writeInto(folder, cadtest::torus(3, 1), ".brep"));
  const Adapted adapted =
    resultOf(torus.attempt<vtkAdaptToCAD>(cadtest::toGrid(cadtest::torusMesh(3, 1, 12, 6)),
      [](vtkAdaptToCAD* filter)
      {
        filter->SetErrorMarking(vtkAdaptToCAD::OFF);
        filter->SetChordTolerance(0.05);
        filter->SetMaximumSteps(30);
      }));
  EXPECT_EQ(adapted.reason.find("no cell is marked: the largest "), 0u) << adapted.reason;
  EXPECT_LE(field(adapted, "MaximumChordError"), 0.05);
  EXPECT_EQ(field(adapted, "UnprojectedVertices"), 0);
  expectSound(adapted.mesh);
}

TEST_F(Adapt, refinesToAnAngle)
{
  const Adapted adapted = adapt(ball,
    [](vtkAdaptToCAD* filter)
    {
      filter->SetErrorMarking(vtkAdaptToCAD::OFF);
      filter->SetNormalAngle(20);
      filter->SetMaximumSteps(30);
    });
  EXPECT_EQ(adapted.reason.find("no cell is marked: the largest "), 0u) << adapted.reason;
  EXPECT_GT(adapted.columns.at("MaximumNormalAngle")[0], 40);
  EXPECT_LE(field(adapted, "MaximumNormalAngle"), 20);
  EXPECT_EQ(largestOf(adapted.mesh, "NormalAngle"), field(adapted, "MaximumNormalAngle"));
  expectSound(adapted.mesh);
}

TEST_F(Adapt, followsIndicatorAndGeometry)
{
  addIndicator(ball);
  const auto marked = [&](bool error, bool indicator)
  {
    return adapt(ball,
      [&](vtkAdaptToCAD* filter)
      {
        const int off = vtkAdaptToCAD::OFF;
        filter->SetErrorMarking(error ? int{ vtkAdaptToCAD::FRACTION_OF_LARGEST } : off);
        filter->SetErrorFraction(0.9);
        filter->SetIndicatorArray(indicator ? "Indicator" : "None");
        filter->SetMaximumSteps(1);
      })
      .columns.at("MarkedCells")
      .at(1);
  };
  EXPECT_EQ(marked(false, true), 5);
  EXPECT_GE(marked(true, true), std::max(5.0, marked(true, false)));
  EXPECT_LE(marked(true, true), 5 + marked(true, false));
  EXPECT_EQ(marked(false, false), 20) << "without any criterion all cells are marked";
}

TEST_F(Adapt, takesPolyData)
{
  const auto surface = cadtest::toPolyData(cadtest::sphereMesh(2, 0.03));
  const Adapted adapted = adapt(surface,
    [](vtkAdaptToCAD* filter)
    {
      filter->SetErrorMarking(vtkAdaptToCAD::THRESHOLD);
      filter->SetMaximumSteps(6);
    });
  ASSERT_NE(vtkPolyData::SafeDownCast(adapted.mesh), nullptr);
  EXPECT_EQ(adapted.steps(), 6u);
  const auto& errors = adapted.columns.at("GlobalGeometricError");
  EXPECT_LT(errors.back(), 0.1 * errors.front());
  EXPECT_EQ(cadtest::countOuterSides(cadtest::toMesh(adapted.mesh)), 0u);
}

TEST_F(Adapt, projectsInsideItsRegion)
{
  const auto configure = [](auto* filter)
  {
    filter->UseRegionOn();
    filter->SetRegion(0, 3, -3, 3, -3, 3);
  };
  const Adapted adapted = adapt(ball,
    [&](vtkAdaptToCAD* filter)
    {
      configure(filter);
      filter->SetMaximumSteps(0);
    });
  const Data projected =
    filters.run<vtkProjectOntoCAD>(ball, [&](vtkProjectOntoCAD* filter) { configure(filter); });
  EXPECT_TRUE(cadtest::areSame(adapted.mesh, filters.measure(projected, 0)));
}

TEST_F(Adapt, refinesUniformly)
{
  const Adapted adapted = adapt(ball,
    [](vtkAdaptToCAD* filter)
    {
      filter->SetMethod(vtkAdaptToCAD::UNIFORM_BISECTION);
      filter->SetMaximumSteps(2);
    });
  EXPECT_EQ(adapted.columns.at("GlobalCells"), (std::vector<double>{ 20, 160, 1280 }));
  EXPECT_EQ(adapted.columns.at("MarkedCells"), (std::vector<double>{ 0, 20, 160 }));
}

TEST_F(Adapt, refinesUniformlyFirst)
{
  constexpr double threshold = 1e-2;
  const Adapted adapted = adapt(ball,
    [](vtkAdaptToCAD* filter)
    {
      filter->SetUniformSteps(1);
      filter->SetMaximumSteps(1);
      filter->SetErrorMarking(vtkAdaptToCAD::THRESHOLD);
      filter->SetErrorThreshold(threshold);
      filter->CutFacetsOff();
    });
  const Data fine = filters.measure(filters.refineUniformly(filters.project(ball)), 0);
  const auto marked = countAbove(fine, "GeometricError", threshold);
  EXPECT_GT(marked, 0);
  EXPECT_LT(marked, 160);
  EXPECT_EQ(
    adapted.columns.at("MarkedCells"), (std::vector<double>{ 0, 20, static_cast<double>(marked) }));
  expectRow(adapted, 1, fine);
  EXPECT_TRUE(cadtest::areSame(
    adapted.mesh, filters.measure(filters.refineWhereErrorExceeds(fine, threshold), 0)));
  const Adapted none = adapt(ball,
    [](vtkAdaptToCAD* filter)
    {
      filter->SetUniformSteps(1);
      filter->SetMaximumSteps(0);
      filter->SetErrorMarking(vtkAdaptToCAD::THRESHOLD);
      filter->SetErrorThreshold(100);
    });
  EXPECT_EQ(none.steps(), 1u);
  EXPECT_NE(none.reason.find("MaximumSteps"), std::string::npos) << none.reason;
}

TEST_F(Adapt, goesOnWithAProjectedMesh)
{
  const auto steps = [&](vtkPointSet* mesh, int count, bool projected)
  {
    return adapt(mesh,
      [&](vtkAdaptToCAD* filter)
      {
        filter->SetMaximumSteps(count);
        filter->SetStartProjected(projected);
        filter->ProjectNewVerticesOff(); // so that projecting again would move vertices
      });
  };
  const Adapted whole = steps(ball, 3, false);
  const Adapted second = steps(steps(ball, 2, false).mesh, 1, true);
  EXPECT_TRUE(cadtest::areSame(second.mesh, whole.mesh));
  for (const auto& [name, values] : whole.columns)
  {
    if (name != "Step" && name != "MarkedCells" && name != "ProjectedPoints")
    {
      EXPECT_EQ(second.columns.at(name), (std::vector<double>{ values.at(2), values.at(3) }))
        << name;
    }
  }
  EXPECT_EQ(second.columns.at("ProjectedPoints")[0], 0) << "none is looked up";

  const auto outcome =
    filters.attempt<vtkAdaptToCAD>(ball, [](vtkAdaptToCAD* filter) { filter->StartProjectedOn(); });
  EXPECT_FALSE(outcome.succeeded);
  ASSERT_EQ(outcome.errors.size(), 1u);
  EXPECT_NE(outcome.errors[0].find("apply the filter Project Onto CAD first"), std::string::npos)
    << outcome.errors[0];
}

TEST_F(Adapt, makesQuadraticCellsInTheEnd)
{
  const auto configure = [](vtkAdaptToCAD* filter) { filter->SetMaximumSteps(2); };
  const Adapted adapted = adapt(ball,
    [&](vtkAdaptToCAD* filter)
    {
      configure(filter);
      filter->QuadraticCellsOn();
    });
  const Data quadratic = filters.measure(filters.run<vtkRefineWithCAD>(adapt(ball, configure).mesh,
                                           [](vtkRefineWithCAD* filter)
                                           {
                                             filter->SetLevels(0);
                                             filter->QuadraticCellsOn();
                                           }),
    0);
  EXPECT_TRUE(cadtest::areSame(adapted.mesh, quadratic));
  ASSERT_EQ(adapted.steps(), 3u);
  expectRow(adapted, 3, quadratic);
  EXPECT_NE(adapted.reason.find("MaximumSteps"), std::string::npos) << adapted.reason;

  const Adapted alone = adapt(quadratic,
    [](vtkAdaptToCAD* filter)
    {
      filter->StartProjectedOn();
      filter->SetMaximumSteps(0);
    });
  EXPECT_TRUE(cadtest::areSame(alone.mesh, quadratic)) << "measured, not refined";
  const auto outcome =
    filters.attempt<vtkAdaptToCAD>(cadtest::toPolyData(cadtest::sphereMesh(2, 0.03)),
      [](vtkAdaptToCAD* filter) { filter->QuadraticCellsOn(); });
  EXPECT_FALSE(outcome.succeeded);
  ASSERT_EQ(outcome.errors.size(), 1u);
  EXPECT_NE(outcome.errors[0].find("poly data cannot hold quadratic cells"), std::string::npos);
}

/// Aborts an adaptation where its second step begins.
void abortSecondStep(vtkObject* caller, unsigned long, void*, void*)
{
  auto* filter = static_cast<vtkAdaptToCAD*>(caller);
  if (filter->GetProgressText() && std::string(filter->GetProgressText()) == "Step 2")
  {
    filter->SetAbortExecute(1);
  }
}

/// What there was is kept, also at the next update, and the filter runs again where it is changed.
TEST_F(Adapt, keepsTheStepWhereItIsInterrupted)
{
  const auto steps = [&](int count)
  { return adapt(ball, [&](vtkAdaptToCAD* filter) { filter->SetMaximumSteps(count); }); };
  vtkNew<vtkAdaptToCAD> filter;
  filter->SetController(nullptr);
  filter->SetInputDataObject(0, ball);
  filter->SetInputDataObject(1, filters.cad());
  filter->SetMaximumSteps(4);
  vtkNew<vtkCallbackCommand> command;
  command->SetCallback(abortSecondStep);
  filter->AddObserver(vtkCommand::ProgressEvent, command);
  const Adapted interrupted = resultOf(cadtest::execute(filter)); // and removes the observers
  EXPECT_EQ(interrupted.reason, "interrupted");
  EXPECT_EQ(interrupted.steps(), 2u);
  EXPECT_TRUE(cadtest::areSame(interrupted.mesh, steps(2).mesh));

  EXPECT_EQ(resultOf(cadtest::execute(filter)).reason, "interrupted") << "nothing has changed";
  filter->Modified();
  const Adapted whole = resultOf(cadtest::execute(filter));
  EXPECT_EQ(whole.steps(), 4u);
  EXPECT_TRUE(cadtest::areSame(whole.mesh, steps(4).mesh));
}

} // namespace
