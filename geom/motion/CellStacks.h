// Stacks of cells, as those of a boundary layer stand on a wall.
#pragma once

#include <cadrefine/base/VertexBuckets.h>
#include <cadrefine/mesh/Facets.h>
#include <cadrefine/mesh/Mesh.h>

namespace cadrefine
{

/// How wedges (from triangle to triangle), hexahedra and (in the plane and on surfaces, from edge
/// to edge) quadrilaterals of a piece stand on each other. Work of making it: linear in their
/// number; memory: 4 bytes a corner and 8 a vertex. Keeps a reference to the mesh.
class CellStacks
{
public:
  explicit CellStacks(const Mesh& mesh);

  /// The side of cell `side.cell` that is opposite to `side`; an edge of the cell joins corner k of
  /// both. Without corners where the cell has no such side.
  Facet opposite(const Facet& side) const;

  /// The same side, with the other cell that has it as its cell: -1 where there is none, or only
  /// one that is no part of a stack.
  Facet beyond(const Facet& side) const;

private:
  const Mesh& mesh_;
  /// Cells of stacks at each vertex, by their numbers among the cells of the mesh's own dimension.
  VertexBuckets<Index> cellsAt_;
};

} // namespace cadrefine
