// Validity and quality of all cells at once.
#pragma once

#include "SimplexMesh.h"

#include <cstdint>
#include <limits>

namespace cadrefine
{

struct QualitySummary
{
  std::int64_t invalidCells = 0;                            ///< Inverted or degenerate.
  double minimum = std::numeric_limits<double>::infinity(); ///< Of the mean ratios.
};

/// What orientation and meanRatio (up to rounding) say of the tetrahedra of a mesh, asking them for
/// few: a volume that is larger than the rounding errors in it is positive, and of mean ratios the
/// cubes are compared. Some 10 ns a cell. The summary of two meshes is that of their cells
/// together.
QualitySummary summariseTetrahedra(const SimplexMesh& mesh);

} // namespace cadrefine
