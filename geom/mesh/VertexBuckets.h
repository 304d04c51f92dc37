// Sides of cells, sorted by their vertices.
#pragma once

#include "MeshTypes.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace cadrefine
{

/// Sorts things that are known by a first vertex and a number (what else they are known by): by a
/// counting sort into the buckets of the vertices, and each bucket by the number. Fill in two
/// rounds, which must name the same things in the same order: count all, start, add all. Work:
/// linear but for the logarithm of the largest bucket.
template<class Entry>
class VertexBuckets
{
public:
  explicit VertexBuckets(std::size_t vertexCount) : begins_(vertexCount + 2, 0) {}

  void count(Index vertex) { ++begins_[static_cast<std::size_t>(vertex) + 2]; }
  void start()
  {
    std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
    entries_.resize(begins_.back());
  }
  void add(Index vertex, const Entry& entry)
  {
    entries_[begins_[static_cast<std::size_t>(vertex) + 1]++] = entry;
  }

  /// Calls use(vertex, first, last) for the sorted entries of each vertex in turn.
  template<class Use>
  void forEachSorted(const Use& use)
  {
    for (std::size_t v = 0; v + 2 < begins_.size(); ++v)
    {
      Entry* first = entries_.data() + begins_[v];
      Entry* last = entries_.data() + begins_[v + 1];
      std::sort(first, last);
      use(static_cast<Index>(v), first, last);
    }
  }

private:
  /// While filling, begins_[v + 1] is where the next entry of vertex v goes; then where it ends.
  std::vector<std::size_t> begins_;
  std::vector<Entry> entries_;
};

} // namespace cadrefine
