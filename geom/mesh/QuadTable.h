// The quadrilaterals of a mesh.
#pragma once

#include <cadrefine/mesh/EdgeTable.h>

#include <array>
#include <vector>

namespace cadrefine
{

/// The quadrilateral cells of a mesh and faces of its cells, each once, and those of each cell.
struct QuadTable
{
  /// The edges of each quadrilateral in turn, from the one with the smallest number on to the
  /// smaller of the two beside it. The quadrilaterals are in the order of their first and third
  /// edges, which no two have in common.
  std::vector<std::array<Index, 4>> edges;
  /// The quadrilaterals of the cells of each shape, in the order of the shape's `quadEdges`.
  std::vector<std::array<Index, 1>> ofPyramids;
  std::vector<std::array<Index, 3>> ofWedges;
  std::vector<std::array<Index, 6>> ofHexahedra;
  std::vector<std::array<Index, 1>> ofQuadrilaterals;

  /// Number of the quadrilateral with these edges, in turn, or -1. Takes time logarithmic in the
  /// number of quadrilaterals.
  Index find(const std::array<Index, 4>& itsEdges) const;
};

/// The member of a table that has the quadrilaterals of the cells of a shape.
constexpr auto quadsOfCells(shapes::Pyramid)
{
  return &QuadTable::ofPyramids;
}
constexpr auto quadsOfCells(shapes::Wedge)
{
  return &QuadTable::ofWedges;
}
constexpr auto quadsOfCells(shapes::Hexahedron)
{
  return &QuadTable::ofHexahedra;
}
constexpr auto quadsOfCells(shapes::Quadrilateral)
{
  return &QuadTable::ofQuadrilaterals;
}

/// Sorts the quadrilaterals of all cells: work and memory linear in the number of cells.
QuadTable buildQuadTable(const EdgeTable& table);

} // namespace cadrefine
