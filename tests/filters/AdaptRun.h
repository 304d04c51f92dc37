// What Adapt To CAD makes of a ball.
#pragma once

#include "DataSets.h"
#include "FilterRun.h"
#include "TestMeshes.h"
#include "TestShapes.h"

#include <gtest/gtest.h>
#include <vtkFieldData.h>
#include <vtkUnstructuredGrid.h>

#include <map>
#include <string>
#include <vector>

namespace cadtest
{

struct Adapted
{
  FilterRun::Data mesh;
  std::map<std::string, std::vector<double>> columns;
  std::string reason;

  std::size_t steps() const { return columns.at("Step").size() - 1; }
};

inline Adapted resultOf(const Outcome& outcome)
{
  EXPECT_TRUE(outcome.succeeded);
  EXPECT_TRUE(outcome.errors.empty());
  EXPECT_TRUE(outcome.warnings.empty());
  vtkAbstractArray* reason = outcome.secondOutput->GetFieldData()->GetAbstractArray("StopReason");
  return { outcome.pointSet(), columnsOf(outcome.secondOutput),
    reason ? reason->GetVariantValue(0).ToString() : "none" };
}

/// The table's rows have the field data of each mesh on the way.
inline void expectRow(const Adapted& adapted, std::size_t row, vtkPointSet* mesh)
{
  for (const auto& [name, values] : adapted.columns)
  {
    if (name != "Step" && name != "MarkedCells")
    {
      EXPECT_EQ(values.at(row), fieldValue(mesh, name.c_str())) << name << " " << row;
    }
  }
  EXPECT_EQ(adapted.columns.at("Step").at(row), row);
}

class AdaptRun : public testing::Test
{
protected:
  TemporaryFolder folder;
  FilterRun filters{ writeInto(folder, sphere(2), ".step") };
  FilterRun::Data ball = toGrid(ballMesh(2, 0.03));
};

} // namespace cadtest
