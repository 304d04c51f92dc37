// Which cells Refine With CAD cuts.

#include "DataSets.h"
#include "FilterRun.h"
#include "TestMeshes.h"
#include "TestShapes.h"

#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkIdTypeArray.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>

#include <functional>
#include <limits>

namespace
{

using namespace cadrefine;

class Marking : public testing::Test
{
protected:
  using Configure = std::function<void(vtkRefineWithCAD*)>;
  using Data = cadtest::FilterRun::Data;

  cadtest::TemporaryFolder folder;
  cadtest::FilterRun filters{ cadtest::writeInto(folder, cadtest::sphere(2), ".step") };
  /// 20 cells.
  Data ball = filters.project(cadtest::toGrid(cadtest::ballMesh(2, 0.03)));

  template<class ValueOf>
  void addArray(const char* name, const ValueOf& valueOf)
  {
    vtkNew<vtkDoubleArray> array;
    array->SetName(name);
    for (vtkIdType c = 0; c < ball->GetNumberOfCells(); ++c)
    {
      array->InsertNextValue(valueOf(static_cast<int>(c)));
    }
    ball->GetCellData()->AddArray(array);
  }

  /// That `configure` marks the cells of which `isMarked` says so of their number.
  void expectMarks(const Configure& configure, const std::function<bool(int)>& isMarked)
  {
    addArray("Marks", [&](int c) { return isMarked(c) ? 1 : 0; });
    const Data expected = filters.run<vtkRefineWithCAD>(ball,
      [](vtkRefineWithCAD* filter)
      {
        filter->SetMarkingArray("Marks");
        filter->SetThreshold(0.5);
      });
    EXPECT_TRUE(cadtest::areSame(filters.run<vtkRefineWithCAD>(ball, configure), expected));
  }

  static vtkSmartPointer<vtkIdTypeArray> numbers(vtkIdType count)
  {
    auto ids = vtkSmartPointer<vtkIdTypeArray>::New();
    for (vtkIdType i = 0; i < count; ++i)
    {
      ids->InsertNextValue(i);
    }
    return ids;
  }

  void SetUp() override
  {
    addArray("Number", [](int c) { return c; });
    addArray("Backwards", [](int c) { return 19 - c; });
    addArray("Signed", [](int c) { return c - 10; });
    addArray("Zero", [](int) { return 0; });
    addArray("Odd", [](int c) { return c % 2; });
  }
};

TEST_F(Marking, byThreshold)
{
  for (const double threshold : { -1.0, 0.0, 12.0, 12.5, 19.0 })
  {
    expectMarks(
      [&](vtkRefineWithCAD* filter)
      {
        filter->SetMarkingArray("Number");
        filter->SetThreshold(threshold);
      },
      [&](int c) { return c > threshold; });
  }
}

TEST_F(Marking, byAThresholdOfNegativeValues)
{
  expectMarks(
    [](vtkRefineWithCAD* filter)
    {
      filter->SetMarkingArray("Signed");
      filter->SetThreshold(-5);
    },
    [](int c) { return c > 5; });
}

TEST_F(Marking, byAFractionOfTheLargest)
{
  for (const double fraction : { 1e-300, 0.25, 0.5, 1.0 })
  {
    expectMarks(
      [&](vtkRefineWithCAD* filter)
      {
        filter->SetMarkingArray("Number");
        filter->SetMarking(vtkRefineWithCAD::FRACTION_OF_LARGEST);
        filter->SetFraction(fraction);
      },
      [&](int c) { return c > 0 && c >= fraction * 19; });
  }
}

/// 0 + ... + 19 = 190; the sum of the largest k is k (39 - k) / 2.
TEST_F(Marking, byBulk)
{
  for (const auto& [fraction, least] :
    { std::pair{ 0.1, 19 }, { 0.101, 18 }, { 0.5, 14 }, { 189.0 / 190, 2 }, { 1.0, 1 } })
  {
    expectMarks(
      [&, part = fraction](vtkRefineWithCAD* filter)
      {
        filter->SetMarkingArray("Number");
        filter->SetMarking(vtkRefineWithCAD::BULK);
        filter->SetFraction(part);
      },
      [&, from = least](int c) { return c >= from; });
  }
}

/// First by their global ids.
TEST_F(Marking, byEqualValuesTakesTheFirstCells)
{
  ball->GetPointData()->SetGlobalIds(numbers(ball->GetNumberOfPoints()));
  ball->GetCellData()->SetGlobalIds(numbers(ball->GetNumberOfCells()));
  expectMarks(
    [](vtkRefineWithCAD* filter)
    {
      filter->SetMarkingArray("Odd");
      filter->SetMarking(vtkRefineWithCAD::BULK);
      filter->SetFraction(0.5);
    },
    [](int c) { return c % 2 == 1 && c < 10; });
}

TEST_F(Marking, byNothingButZerosMarksNothing)
{
  for (const int strategy :
    { vtkRefineWithCAD::THRESHOLD, vtkRefineWithCAD::FRACTION_OF_LARGEST, vtkRefineWithCAD::BULK })
  {
    expectMarks(
      [&](vtkRefineWithCAD* filter)
      {
        filter->SetMarkingArray("Zero");
        filter->SetMarking(strategy);
      },
      [](int) { return false; });
  }
}

TEST_F(Marking, withoutCriterionTakesAllCells)
{
  expectMarks([](vtkRefineWithCAD*) {}, [](int) { return true; });
  expectMarks(
    [](vtkRefineWithCAD* filter)
    {
      filter->SetMarkingArray("None");
      filter->SetIndicatorArray("None");
    },
    [](int) { return true; });
}

TEST_F(Marking, byIndicatorAlone)
{
  expectMarks(
    [](vtkRefineWithCAD* filter)
    {
      filter->SetIndicatorArray("Number");
      filter->SetIndicatorThreshold(16);
    },
    [](int c) { return c > 16; });
  expectMarks(
    [](vtkRefineWithCAD* filter)
    {
      filter->SetIndicatorArray("Number");
      filter->SetIndicatorMarking(vtkRefineWithCAD::BULK);
      filter->SetIndicatorFraction(0.1);
    },
    [](int c) { return c == 19; });
}

TEST_F(Marking, byErrorOrIndicator)
{
  expectMarks(
    [](vtkRefineWithCAD* filter)
    {
      filter->SetMarkingArray("Number");
      filter->SetMarking(vtkRefineWithCAD::BULK);
      filter->SetFraction(0.101);
      filter->SetIndicatorArray("Backwards");
      filter->SetIndicatorMarking(vtkRefineWithCAD::FRACTION_OF_LARGEST);
      filter->SetIndicatorFraction(0.9);
    },
    [](int c) { return c >= 18 || 19 - c >= 0.9 * 19; });
}

TEST_F(Marking, bySizeToo)
{
  ball = filters.measure(ball, 1);
  SetUp();
  const double chord = cadtest::fieldValue(ball, "MaximumChordError");
  const double angle = cadtest::fieldValue(ball, "MaximumNormalAngle");
  const auto value = [&](const char* name, int c)
  { return ball->GetCellData()->GetArray(name)->GetTuple1(c); };
  expectMarks(
    [&](vtkRefineWithCAD* filter)
    {
      filter->SetMarkingArray("Number");
      filter->SetThreshold(17);
      filter->SetChordTolerance(0.99 * chord);
      filter->SetNormalAngle(0.99 * angle);
    },
    [&](int c)
    {
      return c > 17 || value("ChordError", c) > 0.99 * chord ||
             value("NormalAngle", c) > 0.99 * angle;
    });
}

} // namespace
