// Validity and quality of all cells at once.
#pragma once

#include <cadrefine/base/ParallelFor.h>
#include <cadrefine/mesh/Mesh.h>

#include <cstdint>
#include <limits>

namespace cadrefine
{

struct QualitySummary
{
  std::int64_t invalidCells = 0; ///< Number of inverted or degenerate cells.
  /// Smallest quality of the cells whose quality itself was computed, and smallest cube of a
  /// twelfth of the mean ratio of the others. Two numbers, because roots of numbers next to each
  /// other may change places: a minimum of roots would depend on which cells are together.
  double smallestRatio = std::numeric_limits<double>::infinity();
  double smallestCube = std::numeric_limits<double>::infinity();

  /// Adds the cells of another summary.
  void add(const QualitySummary& other);
  /// The smallest quality of all cells.
  double minimum() const;
};

/// Summarises what stateAt says of the cells of a mesh of volume. For tetrahedra (up to rounding)
/// it is asked for few: a volume that is larger than the rounding errors in it is positive, and
/// instead of mean ratios their cubes are compared. Some 10 ns a tetrahedron. The summary of two
/// meshes is that of their cells together.
QualitySummary summariseCells(const Mesh& mesh, const ParallelFor& parallelFor = serialFor);

} // namespace cadrefine
