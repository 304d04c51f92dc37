// The edges of a mesh.
#pragma once

#include "SimplexMesh.h"

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

/// Edges of a mesh, each once, and those of each cell. Refers to the ids of the mesh.
struct EdgeTable
{
  EdgeList list;
  std::vector<double> squaredLengths;
  std::vector<std::array<Index, 6>> ofTetrahedra;
  std::vector<std::array<Index, 3>> ofTriangles;
  std::vector<Index> ofSegments;

  const std::vector<std::array<Index, 2>>& edges() const { return list.edges(); }
};

/// Work and memory linear in the number of cells.
EdgeTable buildEdgeTable(const SimplexMesh& mesh);

/// The total order by which the longest edge is chosen: by (squared length, smaller id, larger id).
/// It needs no tolerance and is the same on every rank, since lengths are computed from the end
/// with the smaller id.
class EdgeOrder
{
public:
  EdgeOrder(const EdgeTable& table, const std::vector<GlobalId>& ids) : table_(table), ids_(ids) {}

  /// True where edge `a` is longer than edge `b`.
  bool longer(Index a, Index b) const
  {
    const double lengthA = table_.squaredLengths[a];
    const double lengthB = table_.squaredLengths[b];
    return lengthA != lengthB ? lengthA > lengthB : longerById(a, b);
  }

private:
  bool longerById(Index a, Index b) const
  {
    const auto& endsA = table_.edges()[a];
    const auto& endsB = table_.edges()[b];
    return endsA[0] != endsB[0] ? ids_[endsA[0]] > ids_[endsB[0]] : ids_[endsA[1]] > ids_[endsB[1]];
  }

  const EdgeTable& table_;
  const std::vector<GlobalId>& ids_;
};

} // namespace cadrefine
