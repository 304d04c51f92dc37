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
  /// The edges of each in turn, from that with the smallest number on to the smaller of the two
  /// beside it. In the order of the first one and the third, which no other quadrilateral has.
  std::vector<std::array<Index, 4>> edges;
  /// Of the cells of each shape, in the order of its `quadEdges`.
  std::vector<std::array<Index, 1>> ofPyramids;
  std::vector<std::array<Index, 3>> ofWedges;
  std::vector<std::array<Index, 6>> ofHexahedra;
  std::vector<std::array<Index, 1>> ofQuadrilaterals;

  /// Number of the quadrilateral with these edges, in turn, or -1. Takes the logarithm of their
  /// number.
  Index find(const std::array<Index, 4>& itsEdges) const;
};

/// Where a table has the quadrilaterals of the cells of a shape.
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

/// Sorts those of all cells: work and memory linear in the number of cells.
QuadTable buildQuadTable(const EdgeTable& table);

} // namespace cadrefine
