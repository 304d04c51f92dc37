// Cells at flagged vertices, and the vertices of cells.
#pragma once

#include <cadrefine/base/ParallelFor.h>
#include <cadrefine/mesh/Mesh.h>

#include <cstddef>
#include <vector>

namespace cadrefine
{

/// Cells of the mesh's own dimension with a flagged vertex, ascending. Work: one look at each cell.
std::vector<Index> cellsAt(
  const Mesh& mesh, const std::vector<unsigned char>& flags, const ParallelFor& parallelFor);
/// Those of `numbers`, ascending numbers of cells of the mesh's own dimension, that are of one
/// shape, whose `count` cells are numbered from `first` on; numbered among that shape's cells, from
/// 0.
std::vector<Index> cellsOfShape(
  const std::vector<Index>& numbers, std::size_t first, std::size_t count);
/// Flags the vertices of these cells.
void flagVertices(
  const Mesh& mesh, const std::vector<Index>& cells, std::vector<unsigned char>& flags);

/// The vertices that cells have, ascending. Work: one look at each cell.
std::vector<Index> usedVertices(const Mesh& mesh);
/// Takes all vertices but these, which are ascending and include all that cells have, out of a
/// mesh. Returns the new number of each old vertex, -1 for those taken out. Work: linear.
std::vector<Index> keepVertices(const std::vector<Index>& kept, Mesh& mesh);

} // namespace cadrefine
