// What a filter's work depends on, and what is only carried along.
#pragma once

#include "pipeline/PipelineResult.h"

#include <string>
#include <vector>

class vtkFieldData;
class vtkPointSet;

namespace cadrefine
{

/// A data set in two parts, which share its arrays.
struct InputSplit
{
  /// Points, cells, ids, ghosts, the point arrays of the classification (see CADArrays.h), and the
  /// cell arrays that the filter reads. No field data.
  vtkSmartPointer<vtkPointSet> geometry;
  MeshArrays fields; ///< All else, and the tags.
  /// Names of the cell arrays that the geometry has too, not as active ones.
  std::vector<std::string> tags;
};

/// Splits a data set. `cellArrays`: those that the filter reads; with `readsTags` also all tags
/// (see isTag).
InputSplit splitInput(
  vtkPointSet* input, const std::vector<std::string>& cellArrays, bool readsTags = false);

/// Whether there are cell arrays of floating point other than those that are measured anew.
bool hasMeans(const InputSplit& parts);

/// Takes away what CAD Geometric Error and Mesh Validity found of a mesh that has changed since.
/// (InvalidCells and MinimumQuality are kept up by all filters.)
void removeMeasured(vtkFieldData* ofCells, vtkFieldData* ofMesh);
/// Takes away what Mesh Validity found of cells that have changed since.
void removeQualities(vtkFieldData* ofCells);

/// Takes the fields along to meshes that are made of the geometry, one from the other.
class OutputJoin
{
public:
  explicit OutputJoin(const InputSplit& parts) : parts_(parts), fields_(parts.fields) {}

  /// Fills `output` with the mesh and the fields. Points, cells and arrays of the mesh are shared
  /// with it. `mapping` leads from the geometry, and goes on where that of the call before ended;
  /// `selection` from there to the mesh. Collective. Work: that of taking the fields along from
  /// there (see FieldMapping).
  void fill(RankExchange& exchange, vtkPointSet* mesh, const FieldMapping& mapping,
    const ArraySelection& selection, vtkPointSet* output);

private:
  const InputSplit& parts_;
  MeshArrays fields_;
  std::size_t stages_ = 0; ///< Stages of the mapping that the fields have behind them.
};

} // namespace cadrefine
