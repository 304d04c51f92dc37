// What Refine With CAD does with a mesh.
#pragma once

#include "pipeline/MeshState.h"
#include "refinement/Marking.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace cadrefine
{

struct RefinementOptions
{
  bool uniform = false;                   ///< Cut all edges; else the longest of marked cells.
  int levels = 1;                         ///< 0: the mesh stays as it is, for quadraticCells.
  std::vector<MarkingCriterion> criteria; ///< Empty: all cells are marked.
  /// CAD faces (see selectEntities): cells whose ChordError is larger than the chord tolerance of a
  /// face that they have a facet on are marked too.
  std::vector<std::string> faces;
  bool onlyAtFaces = false; ///< No cells are marked but those with a facet on these faces.
  /// Bisect further until the facets on the CAD of each marked cell are cut.
  bool cutFacets = false;
  /// Whether layers are kept, see markLongestEdges.
  bool keepLayers = true;
  bool projectNewVertices = true;
  /// The minimum of improveMesh; none: no local operations.
  std::optional<double> minimumQuality;
  /// Whether local operations must not enlarge the geometric error, see SurfaceLimits.
  bool keepsError = false;
  bool balance = true;
  /// Put out cells of second order (see placeMidNodes); not for vtkPolyData, which has none.
  bool quadraticCells = false;
  bool onlyIfMarked = false; ///< Make no mesh where no cell is marked in the first level.
  /// The first level is not made where it would have more cells of the mesh's own dimension; 0: no
  /// limit.
  std::int64_t maximumCells = 0;
};

struct RefinementOutcome
{
  std::int64_t markedCells = 0; ///< Cells marked in the last level, over all ranks.
  bool limited = false;         ///< The first level would have had too many cells.
  std::string whyNone = {};     ///< Why no cell is marked, where none is: see describeLargest.
  bool refined = true;          ///< False: the mesh is as it was.
};

/// Throws Error for a data set that cannot hold cells of second order.
void checkForQuadraticCells(vtkPointSet* data);

/// Refines a mesh (see refine and refineOntoCAD), which is classified if its new vertices are to be
/// projected. What was measured of it is carried over like other arrays. Collective.
RefinementOutcome refineMesh(
  const PipelineContext& context, MeshState& state, const RefinementOptions& options);

} // namespace cadrefine
