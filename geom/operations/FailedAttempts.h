// Which operations were tried in vain.
#pragma once

#include <cadrefine/mesh/Mesh.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace cadrefine
{

/// What was tried in vain with cells, edges and vertices: not to be tried again before the cells
/// there change. Work: constant for each question. Memory: for what failed, and for the vertices.
class FailedAttempts
{
public:
  /// Notes that these cells are new: what failed at their corners may be tried again.
  template<class Cells>
  void noteChange(const Cells& cells)
  {
    ++now_;
    for (const auto& cell : cells)
    {
      for (const Index vertex : cell.corners)
      {
        changes_.resize(std::max(changes_.size(), static_cast<std::size_t>(vertex) + 1), 0);
        changes_[vertex] = now_;
      }
    }
  }

  void noteCell(Index cell) { ofCells_[cell] = now_; }
  void noteVertex(Index vertex) { ofVertices_[vertex] = now_; }
  /// Notes that nothing could be gained at an edge. `withSplit`: halving it was tried, too.
  void noteEdge(Index a, Index b, bool withSplit) { ofEdges_[keyOf(a, b)] = { now_, withSplit }; }

  template<class Corners>
  bool hasCell(Index cell, const Corners& corners) const
  {
    const auto found = ofCells_.find(cell);
    return found != ofCells_.end() &&
           std::all_of(corners.begin(), corners.end(),
             [&](Index vertex) { return changedAt(vertex) <= found->second; });
  }

  bool hasVertex(Index vertex) const
  {
    const auto found = ofVertices_.find(vertex);
    return found != ofVertices_.end() && changedAt(vertex) <= found->second;
  }

  bool hasEdge(Index a, Index b, bool withSplit) const
  {
    const auto found = ofEdges_.find(keyOf(a, b));
    return found != ofEdges_.end() && (found->second.withSplit || !withSplit) &&
           changedAt(a) <= found->second.time && changedAt(b) <= found->second.time;
  }

private:
  using Time = std::int64_t; ///< Number of changes so far.
  struct EdgeFailure
  {
    Time time = 0;
    bool withSplit = false;
  };

  static std::uint64_t keyOf(Index a, Index b)
  {
    const auto [low, high] = std::minmax(a, b);
    return static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint64_t>(high);
  }

  Time changedAt(Index vertex) const
  {
    const auto v = static_cast<std::size_t>(vertex);
    return v < changes_.size() ? changes_[v] : 0;
  }

  Time now_ = 0;
  std::vector<Time> changes_; ///< When the cells at each vertex last changed.
  std::unordered_map<Index, Time> ofCells_;
  std::unordered_map<Index, Time> ofVertices_;
  std::unordered_map<std::uint64_t, EdgeFailure> ofEdges_;
};

} // namespace cadrefine
