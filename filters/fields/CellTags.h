// Cell arrays that tell kinds of cells apart, such as materials.
#pragma once

#include "comm/RankExchange.h"

#include <cadrefine/base/MeshTypes.h>
#include <cadrefine/mesh/Mesh.h>

#include <vtkType.h>

#include <cstddef>
#include <cstdint>
#include <vector>

class vtkCellData;
class vtkDataArray;

namespace cadrefine
{

/// Whether a cell array tells kinds of cells apart, so far as its type and name tell: one of whole
/// numbers that has a name, unless that is one of VTK's own ("vtk...") or of CADRefine's.
bool isTag(vtkDataArray* array);

/// Cells in a row of a mesh's arrays.
struct CellRange
{
  vtkIdType first;
  std::size_t count;
};

/// The range of the cells of this dimension in a mesh's arrays.
CellRange cellsOf(const Mesh& mesh, int dimension);

/// Hashes of the names, ascending, of arrays that look like tags but number the cells, or those
/// that the cells were refined from: over all ranks they have more than 32 different values, and
/// more than half as many as there are cells in the range; or more than 256, for fewer than 100
/// cells each. The same on all ranks. Collective: two times all-to-all, 16 bytes a value that a
/// rank has. Values are told apart by hashes of 64 bits.
std::vector<std::uint64_t> findNumberings(
  RankExchange& exchange, vtkCellData* data, const CellRange& cells);

/// For each cell of the range a hash of all its tags, without the arrays that number cells: the
/// same for cells with the same tags, on whatever rank.
std::vector<std::uint64_t> tagHashesOf(
  vtkCellData* data, const CellRange& cells, const std::vector<std::uint64_t>& numberings);

/// For each cell of the range a number, from 0 on, that is the same for cells of this rank with the
/// same hash (see tagHashesOf).
std::vector<Index> labelsOf(
  vtkCellData* data, const CellRange& cells, const std::vector<std::uint64_t>& numberings);

} // namespace cadrefine
