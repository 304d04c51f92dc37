// What a filter's work depends on, and what is only carried along.
#pragma once

#include "StepResult.h"

#include <string>
#include <vector>

class vtkPointSet;

namespace cadrefine
{

/// A data set in two parts, which share its arrays.
struct InputParts
{
  /// Points, cells, ids, ghosts, the point arrays of the classification (see CADArrays.h), and the
  /// cell arrays that the filter reads. No field data.
  vtkSmartPointer<vtkPointSet> geometry;
  MeshArrays fields; ///< All else.
};

/// `cellArrays`: those that the filter reads.
InputParts splitInput(vtkPointSet* input, const std::vector<std::string>& cellArrays);

/// Fills `output` with the mesh that `result` made of the geometry, and with the fields. Points,
/// cells and arrays of the mesh are shared with it. Collective. Work: that of taking the fields
/// along (see ArrayRoute).
void joinOutput(
  RankExchange& exchange, const InputParts& parts, const StepResult& result, vtkPointSet* output);

} // namespace cadrefine
