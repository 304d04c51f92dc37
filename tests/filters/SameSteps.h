// Filters one after the other, whose results are to be the same on any number of ranks.
#pragma once

#include "DataSets.h"
#include "FilterRun.h"
#include "ParallelTest.h"
#include "Partition.h"
#include "SamePieces.h"

#include <vtkCADBoundary.h>

#include <iterator>
#include <string>
#include <vector>

namespace cadtest
{

/// The mesh after each filter.
using Steps = std::vector<FilterRun::Data>;

struct RefinementSettings
{
  double threshold = 0; ///< Of the geometric error of cells that are marked.
  int levels = 1;       ///< Of marked cells.
  bool balance = true;
  bool keepLayers = true;
};

/// Projected, measured, refined where the error is, refined uniformly, its boundary, measured with
/// its boundary's cells.
inline Steps refinementSteps(
  const FilterRun& filters, vtkPointSet* mesh, const RefinementSettings& settings)
{
  Steps steps{ filters.project(mesh) };
  steps.push_back(filters.measure(steps.back(), 2));
  steps.push_back(filters.run<vtkRefineWithCAD>(steps.back(),
    [&](vtkRefineWithCAD* filter)
    {
      filter->SetMarkingArray("GeometricError");
      filter->SetThreshold(settings.threshold);
      filter->SetLevels(settings.levels);
      filter->SetBalance(settings.balance);
      filter->SetKeepLayers(settings.keepLayers);
    }));
  steps.push_back(filters.run<vtkRefineWithCAD>(steps.back(),
    [&](vtkRefineWithCAD* filter)
    {
      filter->SetMethod(vtkRefineWithCAD::UNIFORM_BISECTION);
      filter->SetBalance(settings.balance);
    }));
  steps.push_back(filters.run<vtkCADBoundary>(steps.back(), [](vtkCADBoundary*) {}));
  steps.push_back(filters.run<vtkCADGeometricError>(*std::prev(steps.end(), 2),
    [](vtkCADGeometricError* filter)
    {
      filter->SetRecursionDepth(1);
      filter->SetBoundaryCells(true);
    }));
  return steps;
}

/// On rank 0 the steps on one rank that were made last: the next dealing of the same mesh is
/// compared with them, too.
struct SerialSteps
{
  std::string problem;
  Steps steps;
};

/// Each step that runSteps(mesh, controller) makes of `whole` is the same in pieces as on one rank,
/// where it follows from `problem`. Returns the steps of this rank's piece. Collective.
template<class RunSteps>
Steps expectSameSteps(cadrefine::RankExchange& exchange, SerialSteps& serial,
  const std::string& problem, vtkPointSet* whole, Dealing dealing, bool ghosts,
  const RunSteps& runSteps)
{
  const auto rankOfCell = deal(dealing, whole, exchange.size());
  const auto piece = pieceOf(whole, rankOfCell, exchange.rank(), ghosts);
  Steps pieces = runSteps(piece, cadrefine::worldController());
  if (serial.problem != problem)
  {
    serial = { problem, exchange.rank() == 0 ? runSteps(whole, nullptr) : Steps(pieces.size()) };
  }
  for (std::size_t step = 0; step < pieces.size(); ++step)
  {
    SCOPED_TRACE("after step " + std::to_string(step));
    expectSame(exchange, pieces[step], serial.steps[step]);
  }
  return pieces;
}

/// Field values are the same on every rank, also on one that holds nothing. Collective.
inline void expectFieldValuesAgree(cadrefine::RankExchange& exchange, vtkPointSet* piece)
{
  for (const char* name :
    { "GlobalGeometricError", "MaximumGeometricDistance", "InvalidCells", "UnprojectedVertices" })
  {
    const double value = fieldValue(piece, name);
    EXPECT_EQ(exchange.min(value), exchange.max(value)) << name;
  }
}

} // namespace cadtest
