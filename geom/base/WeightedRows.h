// New values as sums of old ones with weights.
#pragma once

#include <cadrefine/base/MeshTypes.h>

#include <cstddef>
#include <vector>

namespace cadrefine
{

/// A sparse matrix: the value of `targets[r]` is the sum over k, firsts[r] <= k < firsts[r + 1], of
/// weights[k] times the value that sources[k] had before. Memory: 8 bytes a row, 12 an entry.
struct WeightedRows
{
  std::vector<Index> targets; ///< Ascending.
  std::vector<Index> firsts{ 0 };
  std::vector<Index> sources;
  std::vector<double> weights;

  std::size_t size() const { return targets.size(); }
  bool empty() const { return targets.empty(); }

  /// Adds a source to the row that is ended next.
  void add(Index source, double weight)
  {
    sources.push_back(source);
    weights.push_back(weight);
  }

  void endRow(Index target)
  {
    targets.push_back(target);
    firsts.push_back(static_cast<Index>(sources.size()));
  }
};

} // namespace cadrefine
