// Properties out of their range: one error on all ranks that names the property and the range.

#include "BadMesh.h"
#include "DataSets.h"

#include <limits>

namespace cadrefine
{

namespace
{

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

class BadProperties : public BadMesh
{
protected:
  vtkSmartPointer<vtkPointSet> mesh = pieceOf(ball());
  vtkSmartPointer<vtkPointSet> projected = filters.project(mesh);

  template<class Filter, class Owner, class Value>
  void expectRefused(vtkPointSet* input, const std::string& name, void (Owner::*set)(Value),
    const std::vector<Value>& values, const std::string& range)
  {
    for (const Value value : values)
    {
      SCOPED_TRACE(name);
      const auto outcome =
        filters.attempt<Filter>(input, [&](Filter* filter) { (filter->*set)(value); });
      expectError(outcome, "the property " + name + " is ");
      expectError(outcome, ", which is not a finite number" + range);
    }
  }
};

const std::vector<double> notLengths{ -1, -infinity, infinity, nan };
const std::vector<double> notFinite{ -infinity, infinity, nan };
const std::string anyLength = " of 0 or more";

TEST_F(BadProperties, ofProjectOntoCAD)
{
  using Filter = vtkProjectOntoCAD;
  expectRefused<Filter>(
    mesh, "MaximumDistance", &Filter::SetMaximumDistance, notLengths, anyLength);
  for (const double bad : notFinite)
  {
    const auto outcome = filters.attempt<Filter>(mesh,
      [&](Filter* filter)
      {
        filter->UseRegionOn();
        filter->SetRegion(0, 1, 0, bad, 0, 1);
      });
    expectError(outcome, "the property Region is ");
  }
  const auto outcome = filters.attempt<Filter>(mesh,
    [](Filter* filter)
    {
      filter->UseRegionOn();
      filter->SetRegion(0, 1, 3, 2, 0, 1);
    });
  expectError(outcome, "the region is empty (Region): its lower bound in y, 3, is above its upper");
}

TEST_F(BadProperties, ofCADGeometricError)
{
  using Filter = vtkCADGeometricError;
  expectRefused<Filter>(
    projected, "RecursionDepth", &Filter::SetRecursionDepth, { -1, 9 }, " from 0 to 8");
}

TEST_F(BadProperties, ofRefineWithCAD)
{
  using Filter = vtkRefineWithCAD;
  expectRefused<Filter>(projected, "Levels", &Filter::SetLevels, { -1, 21 }, " from 0 to 20");
  expectRefused<Filter>(projected, "Method", &Filter::SetMethod, { -1, 2 }, " from 0 to 1");
  expectRefused<Filter>(projected, "Marking", &Filter::SetMarking, { -1, 3 }, " from 0 to 2");
  expectRefused<Filter>(projected, "Threshold", &Filter::SetThreshold, notFinite, "");
  expectRefused<Filter>(
    projected, "IndicatorMarking", &Filter::SetIndicatorMarking, { -1, 3 }, " from 0 to 2");
  expectRefused<Filter>(
    projected, "IndicatorThreshold", &Filter::SetIndicatorThreshold, notFinite, "");
  expectRefused<Filter>(
    projected, "ChordTolerance", &Filter::SetChordTolerance, notLengths, anyLength);
  expectRefused<Filter>(
    projected, "NormalAngle", &Filter::SetNormalAngle, { -1., 180.5, nan }, " from 0 to 180");
}

TEST_F(BadProperties, ofAdaptToCAD)
{
  using Filter = vtkAdaptToCAD;
  expectRefused<Filter>(
    mesh, "MaximumDistance", &Filter::SetMaximumDistance, notLengths, anyLength);
  expectRefused<Filter>(mesh, "TargetError", &Filter::SetTargetError, notLengths, anyLength);
  expectRefused<Filter>(mesh, "ErrorThreshold", &Filter::SetErrorThreshold, notLengths, anyLength);
  expectRefused<Filter>(mesh, "ErrorMarking", &Filter::SetErrorMarking, { -1, 5 }, " from 0 to 4");
  expectRefused<Filter>(mesh, "UniformSteps", &Filter::SetUniformSteps, { -1 }, anyLength);
  expectRefused<Filter>(mesh, "MaximumSteps", &Filter::SetMaximumSteps, { -1 }, anyLength);
  expectRefused<Filter>(mesh, "MaximumCells", &Filter::SetMaximumCells, { -1 }, anyLength);
  expectRefused<Filter>(
    mesh, "RecursionDepth", &Filter::SetRecursionDepth, { -1, 9 }, " from 0 to 8");
  expectRefused<Filter>(mesh, "NormalAngle", &Filter::SetNormalAngle, { 181. }, " from 0 to 180");
}

/// It is a distance like others.
TEST_F(BadProperties, theLargestNumberAsADistance)
{
  const auto projectWithin = [&](double distance)
  {
    return filters.run<vtkProjectOntoCAD>(
      mesh, [&](vtkProjectOntoCAD* filter) { filter->SetMaximumDistance(distance); });
  };
  const double largest = std::numeric_limits<double>::max();
  EXPECT_TRUE(cadtest::areSame(projectWithin(largest), projectWithin(100)));
}

} // namespace

} // namespace cadrefine
