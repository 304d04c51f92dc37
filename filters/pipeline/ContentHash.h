// A short name for what a data set holds.
#pragma once

#include <cadrefine/base/ParallelFor.h>

#include <array>
#include <cstdint>

class vtkPointSet;

namespace cadrefine
{

/// 128 bits (XXH3 by Y. Collet) of the content: two that differ have the same with a probability of
/// 2^-128, if nobody made them to. (Data made to collide would give its maker the mesh of his other
/// data.)
using ContentHash = std::array<std::uint64_t, 2>;

/// Of the class, points, cells and arrays of points and cells, with their types, names and
/// attributes; field data and arrays that are no numbers are left out. Of this rank alone. Work: a
/// pass over the bytes, at about 8 GB/s a thread.
ContentHash hashContent(vtkPointSet* data, const ParallelFor& parallelFor);

} // namespace cadrefine
