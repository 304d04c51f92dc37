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

  /// The side of the cell `side.cell` that is opposite to this side of it, with the same cell,
  /// corner k of both joined by an edge; without corners where the cell has no such side.
  Facet opposite(const Facet& side) const;

  /// This side as that of the other cell that has it; its cell is -1 where there is none, or only
  /// one that is no part of a stack.
  Facet beyond(const Facet& side) const;

private:
  const Mesh& mesh_;
  VertexBuckets<Index> cellsAt_; ///< In their numbers among the cells of the mesh's own dimension.
};

} // namespace cadrefine
