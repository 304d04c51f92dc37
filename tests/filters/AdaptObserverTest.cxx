// The steps of Adapt To CAD, as those see them who observe it.

#include "AdaptRun.h"

#include <gtest/gtest.h>
#include <vtkAdaptToCAD.h>
#include <vtkCallbackCommand.h>
#include <vtkTable.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace
{

using cadtest::Adapted;
using cadtest::expectRow;
using cadtest::resultOf;
using Data = cadtest::FilterRun::Data;

/// What there is when a step is told of.
struct Told
{
  std::vector<Data> meshes;
  std::vector<std::string> statistics;
  std::vector<std::size_t> rows;
  int abortAfter = -1; ///< Step.
  int failAfter = -1;
};

void takeStep(vtkObject* caller, unsigned long, void* client, void*)
{
  auto* filter = static_cast<vtkAdaptToCAD*>(caller);
  auto& told = *static_cast<Told*>(client);
  const auto* output = vtkPointSet::SafeDownCast(filter->GetOutputDataObject(0));
  const auto mesh = Data::Take(output->NewInstance());
  mesh->DeepCopy(filter->GetOutputDataObject(0));
  told.meshes.push_back(mesh);
  told.statistics.emplace_back(filter->GetStepStatistics());
  told.rows.push_back(cadtest::columnsOf(filter->GetOutputDataObject(1)).at("Step").size());
  EXPECT_NE(std::string(filter->GetFitReport()), "");
  const int step = static_cast<int>(told.meshes.size()) - 1;
  if (step == told.abortAfter)
  {
    filter->SetAbortExecute(1);
  }
  if (step == told.failAfter)
  {
    throw std::runtime_error("the disk is full");
  }
}

class AdaptObserved : public cadtest::AdaptRun
{
protected:
  vtkSmartPointer<vtkAdaptToCAD> makeFilter(int steps) const
  {
    auto filter = vtkSmartPointer<vtkAdaptToCAD>::New();
    filter->SetController(nullptr);
    filter->SetInputDataObject(0, ball);
    filter->SetInputDataObject(1, filters.cad());
    filter->SetUniformSteps(1);
    filter->SetMaximumSteps(steps);
    return filter;
  }

  static void observe(vtkAdaptToCAD* filter, Told& told)
  {
    vtkNew<vtkCallbackCommand> command;
    command->SetCallback(takeStep);
    command->SetClientData(&told);
    filter->AddObserver(vtkAdaptToCAD::StepEvent, command);
  }
};

TEST_F(AdaptObserved, seesTheMeshOfEachStep)
{
  cadtest::addArrays(ball);
  Told told;
  const auto filter = makeFilter(2);
  filter->QuadraticCellsOn();
  observe(filter, told);
  const Adapted adapted = resultOf(cadtest::execute(filter));
  ASSERT_EQ(told.meshes.size(), 5u);
  const char* const kinds[] = { "projection", "uniform", "longest-edge", "longest-edge",
    "quadratic" };
  for (std::size_t step = 0; step < 5; ++step)
  {
    Data expected;
    if (step == 0)
    {
      expected = filters.measure(filters.project(ball), 0);
    }
    else if (step < 4)
    {
      expected = resultOf(cadtest::execute(makeFilter(static_cast<int>(step) - 1))).mesh;
    }
    EXPECT_TRUE(cadtest::areSame(told.meshes[step], expected ? expected : adapted.mesh)) << step;
    expectRow(adapted, step, told.meshes[step]);
    EXPECT_EQ(told.rows[step], step + 1);
    std::ostringstream begin;
    begin << R"({"step": )" << step << R"(, "kind": ")" << kinds[step] << R"(", "seconds": {)";
    EXPECT_EQ(told.statistics[step].find(begin.str()), 0u) << told.statistics[step];
    EXPECT_NE(told.statistics[step].find(R"("error imbalance after")"), std::string::npos);
    EXPECT_EQ(
      told.statistics[step].find(R"("marked cells")") != std::string::npos, step == 2 || step == 3);
  }
  const Adapted unseen = [&]
  {
    const auto other = makeFilter(2);
    other->QuadraticCellsOn();
    return resultOf(cadtest::execute(other));
  }();
  EXPECT_TRUE(cadtest::areSame(adapted.mesh, unseen.mesh));
  EXPECT_EQ(adapted.columns, unseen.columns);
}

TEST_F(AdaptObserved, endsWhereItsObserverAborts)
{
  Told told;
  told.abortAfter = 2;
  const auto filter = makeFilter(5);
  filter->QuadraticCellsOn();
  observe(filter, told);
  const Adapted adapted = resultOf(cadtest::execute(filter));
  EXPECT_EQ(adapted.reason, "interrupted");
  EXPECT_EQ(adapted.steps(), 2u);
  ASSERT_EQ(told.meshes.size(), 3u);
  EXPECT_TRUE(cadtest::areSame(adapted.mesh, told.meshes[2]));

  Told last;
  last.abortAfter = 2;
  const auto whole = makeFilter(1);
  whole->QuadraticCellsOn();
  observe(whole, last);
  EXPECT_EQ(resultOf(cadtest::execute(whole)).steps(), 2u) << "no quadratic cells either";
}

TEST_F(AdaptObserved, failsWithItsObserver)
{
  Told told;
  told.failAfter = 1;
  const auto filter = makeFilter(3);
  observe(filter, told);
  const cadtest::Outcome outcome = cadtest::execute(filter);
  EXPECT_FALSE(outcome.succeeded);
  ASSERT_EQ(outcome.errors.size(), 1u);
  EXPECT_NE(outcome.errors[0].find("the disk is full"), std::string::npos) << outcome.errors[0];
  EXPECT_EQ(outcome.pointSet()->GetNumberOfPoints(), 0);
  EXPECT_TRUE(cadtest::columnsOf(outcome.secondOutput).empty());
  EXPECT_EQ(std::string(filter->GetFitReport()), "");
}

/// The texts of a run, in order.
void takeText(vtkObject* caller, unsigned long, void* client, void*)
{
  const char* text = static_cast<vtkAdaptToCAD*>(caller)->GetProgressText();
  static_cast<std::vector<std::string>*>(client)->emplace_back(text ? text : "");
}

TEST_F(AdaptObserved, countsCellsBeforeItCutsThem)
{
  for (const int method :
    { vtkAdaptToCAD::UNIFORM_BISECTION, vtkAdaptToCAD::LONGEST_EDGE_BISECTION })
  {
    std::vector<std::string> texts;
    vtkNew<vtkCallbackCommand> command;
    command->SetCallback(takeText);
    command->SetClientData(&texts);
    const auto filter = makeFilter(5);
    filter->SetMethod(method);
    filter->SetMaximumCells(161); // one more than the uniform step makes
    filter->AddObserver(vtkCommand::ProgressEvent, command);
    const Adapted adapted = resultOf(cadtest::execute(filter));
    EXPECT_EQ(adapted.steps(), 1u);
    EXPECT_NE(adapted.reason.find("MaximumCells"), std::string::npos) << adapted.reason;
    const auto has = [&](const char* text)
    { return std::find(texts.begin(), texts.end(), text) != texts.end(); };
    EXPECT_TRUE(has("Step 1: splitting cells"));
    EXPECT_TRUE(has("Step 2: marking cells"));
    EXPECT_FALSE(has("Step 2: splitting cells"));
  }
}

} // namespace
