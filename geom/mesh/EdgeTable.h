// The edges of a mesh.
#pragma once

#include <cadrefine/mesh/SimplexMesh.h>

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
  /// Number of the edge, or -1.
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
  std::vector<double> squaredLengths;
  std::vector<std::array<Index, 6>> ofTetrahedra;
  std::vector<std::array<Index, 3>> ofTriangles;
  std::vector<Index> ofSegments;
  /// Place of each vertex in the order of the ids.
  std::vector<Index> rankOfVertex;
  /// The edges whose smaller end has rank r: firstOfRank[r] up to firstOfRank[r + 1].
  std::vector<Index> firstOfRank;

  /// Number of the edge between two vertices, or -1. Takes the logarithm of the edges there.
  Index find(Index a, Index b) const;
};

/// Sorts the sides of all cells by one end, and the edges there by the other: work and memory
/// linear in the number of cells but for a logarithm of the edges at a vertex. Throws Error where
/// there are more than 2^32 - 1 sides (715 million tetrahedra) or 2^31 - 1 edges.
EdgeTable buildEdgeTable(const SimplexMesh& mesh);

/// The total order by which the longest edge is chosen: by (squared length, smaller id, larger id).
/// It needs no tolerance and is the same on every rank, since lengths are computed from the end
/// with the smaller id.
class EdgeOrder
{
public:
  explicit EdgeOrder(const EdgeTable& table) : lengths_(table.squaredLengths) {}

  /// True where edge `a` is longer than edge `b`. The edges are numbered by their ids.
  bool longer(Index a, Index b) const
  {
    return lengths_[a] != lengths_[b] ? lengths_[a] > lengths_[b] : a > b;
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
};

} // namespace cadrefine
