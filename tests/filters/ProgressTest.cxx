// What the filters tell of their progress, and the active arrays by which ParaView colours.

#include "DataSets.h"
#include "FilterRun.h"
#include "TestMeshes.h"
#include "TestShapes.h"

#include <gtest/gtest.h>
#include <vtkAdaptToCAD.h>
#include <vtkCallbackCommand.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <set>

namespace
{

using Data = cadtest::FilterRun::Data;

struct Told
{
  std::vector<double> fractions;
  std::set<std::string> texts;
};

void listen(vtkObject* caller, unsigned long, void* told, void*)
{
  auto* filter = static_cast<vtkAlgorithm*>(caller);
  auto& result = *static_cast<Told*>(told);
  result.fractions.push_back(filter->GetProgress());
  if (const char* text = filter->GetProgressText())
  {
    result.texts.insert(text);
  }
}

class FilterProgress : public testing::Test
{
protected:
  /// Texts of a run, whose fractions must rise from 0 to 1.
  template<class Filter, class Configure>
  std::set<std::string> textsOf(vtkPointSet* mesh, const Configure& configure) const
  {
    Told told;
    vtkNew<vtkCallbackCommand> command;
    command->SetCallback(listen);
    command->SetClientData(&told);
    filters.run<Filter>(mesh,
      [&](Filter* filter)
      {
        configure(filter);
        filter->AddObserver(vtkCommand::ProgressEvent, command);
      });
    for (std::size_t i = 1; i < told.fractions.size(); ++i)
    {
      EXPECT_GE(told.fractions[i], told.fractions[i - 1] - 1e-12) << "event " << i;
    }
    EXPECT_EQ(told.fractions.front(), 0);
    EXPECT_EQ(told.fractions.back(), 1);
    return told.texts;
  }

  cadtest::TemporaryFolder folder;
  cadtest::FilterRun filters{ cadtest::writeInto(folder, cadtest::sphere(2), ".step") };
  Data ball = cadtest::toGrid(cadtest::ballMesh(2, 0.03));
};

TEST_F(FilterProgress, countsThePointsThatAreProjected)
{
  constexpr int count = 20000;
  vtkNew<vtkPolyData> cloud;
  vtkNew<vtkPoints> points;
  for (int i = 0; i < count; ++i)
  {
    points->InsertNextPoint(1.9 + 1e-5 * i, 1e-4 * i, 0);
  }
  cloud->SetPoints(points);
  const auto texts = textsOf<vtkProjectOntoCAD>(cloud, [](vtkProjectOntoCAD*) {});
  EXPECT_EQ(texts.count("projecting 0 of 20,000 points"), 1u);
  EXPECT_EQ(texts.count("projecting 4,096 of 20,000 points"), 1u);
}

TEST_F(FilterProgress, tellsWhatIsDone)
{
  const auto projecting = textsOf<vtkProjectOntoCAD>(ball, [](vtkProjectOntoCAD*) {});
  for (const char* text : { "reading the mesh", "finding the boundary",
         "projecting 0 of 12 vertices", "moving vertices onto the CAD" })
  {
    EXPECT_EQ(projecting.count(text), 1u) << text << testing::PrintToString(projecting);
  }
  const Data projected = filters.project(ball);
  const auto measuring = textsOf<vtkCADGeometricError>(projected, [](vtkCADGeometricError*) {});
  for (const char* text : { "projecting 0 of 30 boundary edges", "measuring facets" })
  {
    EXPECT_EQ(measuring.count(text), 1u) << text << testing::PrintToString(measuring);
  }
  const auto measuringDeeper = textsOf<vtkCADGeometricError>(
    projected, [](vtkCADGeometricError* filter) { filter->SetRecursionDepth(2); });
  EXPECT_EQ(measuringDeeper.count("measuring 0 of 120 edges"), 1u)
    << testing::PrintToString(measuringDeeper);
  const auto refining =
    textsOf<vtkRefineWithCAD>(projected, [](vtkRefineWithCAD* filter) { filter->SetLevels(2); });
  for (const char* text : { "level 1 of 2: marking cells", "level 2 of 2: splitting cells" })
  {
    EXPECT_EQ(refining.count(text), 1u) << text << testing::PrintToString(refining);
  }
}

TEST_F(FilterProgress, namesTheStepsOfAnAdaptation)
{
  const auto texts =
    textsOf<vtkAdaptToCAD>(ball, [](vtkAdaptToCAD* filter) { filter->SetMaximumSteps(2); });
  for (const char* text : { "Projection", "Projection: finding the boundary", "Step 1",
         "Projection: reading the mesh", "Step 2: marking cells", "Step 2: measuring facets" })
  {
    EXPECT_EQ(texts.count(text), 1u) << text << testing::PrintToString(texts);
  }
  EXPECT_EQ(texts.count("Step 2: reading the mesh"), 0u) << "it is read once";
  const auto others = textsOf<vtkAdaptToCAD>(filters.project(ball),
    [](vtkAdaptToCAD* filter)
    {
      filter->StartProjectedOn();
      filter->SetUniformSteps(1);
      filter->SetMaximumSteps(0);
      filter->QuadraticCellsOn();
    });
  for (const char* text : { "Input", "Input: measuring facets", "Step 1: splitting cells",
         "Quadratic cells", "Quadratic cells: measuring 0 of 80 facets" })
  {
    EXPECT_EQ(others.count(text), 1u) << text << testing::PrintToString(others);
  }
}

std::string nameOf(vtkDataArray* array)
{
  return array ? array->GetName() : "none";
}

TEST_F(FilterProgress, resultsAreColouredByWhatMatters)
{
  const Data projected = filters.project(ball);
  EXPECT_EQ(nameOf(projected->GetPointData()->GetScalars()), "CADEntity");
  const Data measured = filters.measure(projected, 1);
  EXPECT_EQ(nameOf(measured->GetPointData()->GetScalars()), "none");
  EXPECT_EQ(nameOf(measured->GetCellData()->GetScalars()), "GeometricError");
  const Data refined = filters.refineWhereErrorExceeds(measured, 0);
  EXPECT_EQ(nameOf(refined->GetCellData()->GetScalars()), "none") << "its error is not known";
  EXPECT_EQ(nameOf(refined->GetPointData()->GetScalars()), "CADEntity");
  const Data judged = filters.run<vtkMeshValidity>(refined, [](vtkMeshValidity*) {});
  EXPECT_EQ(nameOf(judged->GetCellData()->GetScalars()), "CellQuality");
}

TEST_F(FilterProgress, invalidCellsAreShownFirst)
{
  const Data inverted = cadtest::toGrid(cadtest::ballMesh(2, 0.03));
  for (vtkIdType p = 0; p < inverted->GetNumberOfPoints(); ++p)
  {
    double point[3];
    inverted->GetPoint(p, point);
    inverted->GetPoints()->SetPoint(p, -point[0], point[1], point[2]);
  }
  const cadtest::Outcome judged =
    filters.attempt<vtkMeshValidity>(inverted, [](vtkMeshValidity*) {});
  ASSERT_TRUE(judged.succeeded);
  ASSERT_GT(cadtest::fieldValue(judged.pointSet(), "InvalidCells"), 0);
  EXPECT_EQ(nameOf(judged.pointSet()->GetCellData()->GetScalars()), "CellValidity");
}

} // namespace
