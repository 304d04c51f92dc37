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
  std::int64_t invalidCells = 0; ///< Inverted or degenerate.
  /// Smallest quality of cells whose cube is not known, and smallest cube of a twelfth of the
  /// others'. Two numbers, because roots of numbers next to each other may change places: a minimum
  /// of roots would depend on which cells are together.
  double smallestRatio = std::numeric_limits<double>::infinity();
  double smallestCube = std::numeric_limits<double>::infinity();

  /// Takes the cells of another summary too.
  void add(const QualitySummary& other);
  /// Of the qualities.
  double minimum() const;
};

/// What stateAt says of the cells of a mesh of volume; of tetrahedra (up to rounding) asking it for
/// few: a volume that is larger than the rounding errors in it is positive, and of mean ratios the
/// cubes are compared. Some 10 ns a tetrahedron. The summary of two meshes is that of their cells
/// together.
QualitySummary summariseCells(const Mesh& mesh, const ParallelFor& parallelFor = serialFor);

} // namespace cadrefine
