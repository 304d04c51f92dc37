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
/// The cells of a shape, numbered from 0, among these numbers, ascending, of cells of the mesh's
/// own dimension, of which `count` from `first` on are of that shape.
std::vector<Index> cellsOfShape(
  const std::vector<Index>& numbers, std::size_t first, std::size_t count);
/// Flags the vertices of these cells.
void flagVertices(
  const Mesh& mesh, const std::vector<Index>& cells, std::vector<unsigned char>& flags);

/// The vertices that cells have, ascending. Work: one look at each cell.
std::vector<Index> usedVertices(const Mesh& mesh);
/// Takes all vertices but these, which are ascending and all that cells have, out of a mesh. The
/// new number of each, -1 of what is gone. Work: linear.
std::vector<Index> keepVertices(const std::vector<Index>& kept, Mesh& mesh);

} // namespace cadrefine
