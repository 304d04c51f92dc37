// What makes a mesh one of second order.
#pragma once

#include <cadrefine/mesh/CellState.h>
#include <cadrefine/mesh/EdgeTable.h>
#include <cadrefine/mesh/Mesh.h>
#include <cadrefine/quadratic/CurvedCells.h>

#include <array>
#include <iterator>
#include <vector>

namespace cadrefine
{

/// A node for each edge of a mesh. Points of the whole are numbered vertices first: the node of
/// edge e is the mesh's number of vertices + e.
struct MidNodes
{
  EdgeTable table;
  std::vector<Point3> points;
  std::vector<GlobalId> ids;
};

/// The middle of an edge of a straight mesh: the same bits wherever it is computed.
inline Point3 middleOf(const Mesh& mesh, const std::array<Index, 2>& ends)
{
  return 0.5 * (mesh.points[ends[0]] + mesh.points[ends[1]]);
}

std::vector<Point3> middlesOf(const Mesh& mesh, const std::vector<std::array<Index, 2>>& edges);

/// The nodes of a cell whose mid nodes, given its edges, are nodeAt(edge).
template<std::size_t Corners, std::size_t Edges, class NodeAt>
std::array<Point3, Corners + Edges> gatherNodes(const Mesh& mesh,
  const std::array<Index, Corners>& cell, const std::array<Index, Edges>& edges,
  const NodeAt& nodeAt)
{
  std::array<Point3, Corners + Edges> nodes;
  for (std::size_t k = 0; k < Corners; ++k)
  {
    nodes[k] = mesh.points[cell[k]];
  }
  for (std::size_t k = 0; k < Edges; ++k)
  {
    nodes[Corners + k] = nodeAt(edges[k]);
  }
  return nodes;
}

/// Whether the cell of second order is valid (see isValid); one of area as seen from `plane`, or
/// where that is zero (in space) from the side of its straight normal.
template<class Shape, class NodeAt>
bool isCellValid(Shape shape, const Mesh& mesh, const std::array<Index, Shape::corners>& cell,
  const std::array<Index, std::size(Shape::edges)>& edges, const Vector3& plane,
  const NodeAt& nodeAt)
{
  const CurvedCell<Shape> nodes = gatherNodes(mesh, cell, edges, nodeAt);
  if constexpr (Shape::dimension == 3)
  {
    return isValid(nodes);
  }
  else
  {
    return isValid(nodes, sideOf(shape, cornersOf(cell, mesh.points), plane));
  }
}

/// Whether each cell of the mesh's own dimension is valid (see isValid). `plane` is the unit normal
/// of a planar mesh, zero for others. Work: that of isValid for each cell.
std::vector<unsigned char> findValidCells(
  const Mesh& mesh, const MidNodes& nodes, const Vector3& plane);

} // namespace cadrefine
