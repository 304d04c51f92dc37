// Disjoint sets of indices, which can be joined.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace cadrefine
{

/// Union-find with path halving; a set's representative is its smallest member.
class DisjointSets
{
public:
  explicit DisjointSets(std::size_t count) : parents_(count)
  {
    std::iota(parents_.begin(), parents_.end(), 0);
  }

  void join(std::int32_t a, std::int32_t b)
  {
    a = find(a);
    b = find(b);
    parents_[std::max(a, b)] = std::min(a, b);
  }

  /// The representative of each index.
  std::vector<std::int32_t> representatives()
  {
    std::vector<std::int32_t> of(parents_.size());
    for (std::size_t i = 0; i < of.size(); ++i)
    {
      of[i] = find(static_cast<std::int32_t>(i));
    }
    return of;
  }

private:
  std::int32_t find(std::int32_t i)
  {
    while (parents_[i] != i)
    {
      i = parents_[i] = parents_[parents_[i]];
    }
    return i;
  }

  std::vector<std::int32_t> parents_;
};

} // namespace cadrefine
