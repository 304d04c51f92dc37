// What Adapt To CAD does with a data set.
#pragma once

#include "classification/ProjectionTask.h"
#include "pipeline/PipelineContext.h"
#include "pipeline/PipelineResult.h"
#include "pipeline/Refinement.h"

#include <functional>
#include <string>

class vtkPointSet;

namespace cadrefine
{

struct AdaptationOptions
{
  bool startProjected = false; ///< The input has its places on the CAD, and keeps them.
  ProjectionOptions projection;
  int recursionDepth = 0; ///< Depth of the error; 0: automatic.
  /// One level a step; `maximumCells` is that of the whole adaptation.
  RefinementOptions refinement;
  int uniformSteps = 0; ///< Steps that cut all cells, before those of `refinement`.
  int maximumSteps = 0; ///< Largest number of steps of `refinement`.
  /// Above 0: after each step of `refinement` cells are coarsened (see coarsenMesh) that have
  /// values below this part of the smallest that each criterion marks, with `targetError`; and
  /// there is at least one step.
  double coarseningFraction = 0;
  double targetError = 0;      ///< Target of the global geometric error; 0: none.
  bool quadraticCells = false; ///< In the end make the cells quadratic, in a step of its own.
  bool boundaryCells = false;  ///< See makeDataSetWithBoundary.
  FieldNeeds fieldNeeds;
};

/// A step that has been made.
struct AdaptationStep
{
  vtkPointSet* mesh;               ///< The mesh of the step, with its error.
  const FieldMapping& mapping;     ///< The way of arrays from the input.
  const ArraySelection& selection; ///< What leads from the end of the mapping to the mesh.
  vtkTable* table;                 ///< With the rows up to this step.
  const std::string& fitReport;
  /// A JSON object: "step", its number from 0; "kind": "projection", "input" (of a mesh that was
  /// projected already), "uniform", "longest-edge" or "quadratic"; "seconds" and "costs" (as
  /// RunStatistics) of its phases "project", "refine" and "error".
  std::string statistics;
};

/// Who follows an adaptation.
struct AdaptationObserver
{
  std::function<bool()> isInterrupted; ///< Whether there shall be no further step.
  /// Empty, or takes each step, the mesh that is kept in the end included. On all ranks alike; may
  /// communicate.
  std::function<void(const AdaptationStep&)> onStep;
};

/// Projects the mesh, unless it is projected already; then measures the error, marks, refines and
/// coarsens, until the error, the steps or the cells reach their limit, no cell is marked, or the
/// user interrupts. The cells of a step are counted before any is cut. Collective. Memory: that of
/// a step, and of the mesh before it; with `onStep` that of a mesh more. `isInterrupted` is asked
/// on every rank between steps; one that says so is enough.
///
/// The mesh is that of the last whole step, with its error. The table has a row a step, the first
/// for the mesh after projection, on rank 0: Step, MarkedCells (cells that were marked to make it),
/// and the field data of the mesh by their names. Its field data StopReason says why there was no
/// further step. The other ranks have the columns alone. The statistics of `context` get the
/// seconds of all phases ("seconds project phase", ...) and what these tell of themselves.
PipelineResult adaptMesh(const PipelineContext& context, vtkPointSet* input,
  const AdaptationOptions& options, const AdaptationObserver& observer);

} // namespace cadrefine
