// Meshes that are refined and made quadratic.
#pragma once

#include "DataSets.h"
#include "FilterRun.h"
#include "TestShapes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cadtest
{

/// Refined uniformly.
inline FilterRun::Data refineToQuadratic(const FilterRun& filters, vtkPointSet* mesh, int levels,
  int operations = vtkRefineWithCAD::ALL_OPERATIONS)
{
  return filters.run<vtkRefineWithCAD>(mesh,
    [&](vtkRefineWithCAD* filter)
    {
      filter->SetOperations(operations);
      filter->SetMethod(vtkRefineWithCAD::UNIFORM_BISECTION);
      filter->SetLevels(levels);
      filter->QuadraticCellsOn();
    });
}

/// Of a mesh in space of the sphere of radius 2: cells of this type are valid, on the sphere, and
/// their error falls at fourth order.
inline void expectConvergenceToTheSphere(vtkPointSet* mesh, int cellType)
{
  const TemporaryFolder folder;
  const FilterRun filters(writeInto(folder, sphere(2), ".step"));
  const auto projected = filters.project(mesh);
  double before = 0;
  for (int level = 1; level <= 3; ++level)
  {
    const auto data = refineToQuadratic(filters, projected, level);
    EXPECT_EQ(data->GetCellType(0), cellType);
    EXPECT_EQ(fieldValue(data, "InvalidCells"), 0);
    EXPECT_EQ(fieldValue(data, "UnprojectedVertices"), 0);
    const double error = fieldValue(filters.measure(data, 2), "GlobalGeometricError");
    if (level > 1)
    {
      EXPECT_GT(std::log2(before / error), 3.8) << "level " << level;
    }
    before = error;
  }
}

} // namespace cadtest
