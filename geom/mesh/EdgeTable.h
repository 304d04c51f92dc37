// The edges of a mesh.
#pragma once

#include <cadrefine/mesh/Mesh.h>

#include <algorithm>
#include <array>
#include <vector>

namespace cadrefine
{

/// A growing list of distinct edges between numbered vertices. Adding or finding one costs time in
/// proportion to the edges at its end with the smaller global id.
class EdgeList
{
public:
  EdgeList() = default;
  explicit EdgeList(const std::vector<GlobalId>& ids) : ids_(&ids), firstOfVertex_(ids.size(), -1)
  {
  }

  /// End vertices, the one with the smaller global id first.
  const std::vector<std::array<Index, 2>>& edges() const { return edges_; }
  /// Number of the edge between two vertices, or -1.
  Index find(Index a, Index b) const;
  Index findOrAdd(Index a, Index b);

private:
  const std::vector<GlobalId>* ids_ = nullptr;
  std::vector<std::array<Index, 2>> edges_;
  std::vector<Index> firstOfVertex_;
  std::vector<Index> next_;
};

/// Edges of a mesh, each once, and those of each cell.
struct EdgeTable
{
  /// End vertices, the one with the smaller global id first; in ascending order of (smaller id,
  /// larger id).
  std::vector<std::array<Index, 2>> edges;
  /// Squared length of each edge; for edges that stand over each other in wedges (see EdgeStacks)
  /// that of the longest.
  std::vector<double> squaredLengths;
  /// For each edge, the ids of the ends of the longest of those that stand over each other with it;
  /// empty: no edges stand over each other.
  std::vector<std::array<GlobalId, 2>> idsInStack;
  /// The edges of the cells of each shape, in the order of the shape's edges.
  std::vector<std::array<Index, 6>> ofTetrahedra;
  std::vector<std::array<Index, 8>> ofPyramids;
  std::vector<std::array<Index, 9>> ofWedges;
  std::vector<std::array<Index, 12>> ofHexahedra;
  std::vector<std::array<Index, 3>> ofTriangles;
  std::vector<std::array<Index, 4>> ofQuadrilaterals;
  std::vector<std::array<Index, 1>> ofSegments;
  /// Place of each vertex in the order of the ids.
  std::vector<Index> positionOfVertex;
  /// The edges whose smaller end is at position p: firstOfPosition[p] up to firstOfPosition[p + 1].
  std::vector<Index> firstOfPosition;

  /// Number of the edge between two vertices, or -1. Takes time logarithmic in the edges there.
  Index find(Index a, Index b) const;
};

/// The member of a table that has the edges of the cells of a shape.
constexpr auto edgesOfCells(shapes::Tetrahedron)
{
  return &EdgeTable::ofTetrahedra;
}
constexpr auto edgesOfCells(shapes::Pyramid)
{
  return &EdgeTable::ofPyramids;
}
constexpr auto edgesOfCells(shapes::Wedge)
{
  return &EdgeTable::ofWedges;
}
constexpr auto edgesOfCells(shapes::Hexahedron)
{
  return &EdgeTable::ofHexahedra;
}
constexpr auto edgesOfCells(shapes::Triangle)
{
  return &EdgeTable::ofTriangles;
}
constexpr auto edgesOfCells(shapes::Quadrilateral)
{
  return &EdgeTable::ofQuadrilaterals;
}
constexpr auto edgesOfCells(shapes::Segment)
{
  return &EdgeTable::ofSegments;
}

/// Sorts the sides of all cells by one end, and the edges there by the other: work and memory
/// linear in the number of cells but for a logarithm of the edges at a vertex. Throws Error where
/// there are more than 2^32 - 1 sides (715 million tetrahedra) or 2^31 - 1 edges.
EdgeTable buildEdgeTable(const Mesh& mesh);

/// The total order by which the longest edge is chosen: by (squared length, smaller id, larger id).
/// It needs no tolerance and is the same on every rank, since lengths are computed from the end
/// with the smaller id. Edges that stand over each other count as the longest of them, so that the
/// triangles over each other are cut alike.
class EdgeOrder
{
public:
  explicit EdgeOrder(const EdgeTable& table)
    : lengths_(table.squaredLengths), idsInStack_(table.idsInStack)
  {
  }

  /// True where edge `a` is longer than edge `b`. The edges are numbered by their ids.
  bool longer(Index a, Index b) const
  {
    if (lengths_[a] != lengths_[b])
    {
      return lengths_[a] > lengths_[b];
    }
    return !idsInStack_.empty() && idsInStack_[a] != idsInStack_[b]
             ? idsInStack_[a] > idsInStack_[b]
             : a > b;
  }

  /// The longest of some edges; there must be one.
  template<class Edges>
  Index longest(const Edges& edges) const
  {
    return *std::max_element(
      edges.begin(), edges.end(), [&](Index a, Index b) { return longer(b, a); });
  }

private:
  const std::vector<double>& lengths_;
  const std::vector<std::array<GlobalId, 2>>& idsInStack_;
};

} // namespace cadrefine
