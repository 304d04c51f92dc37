// Things by a vertex or an edge to which they belong.
#pragma once

#include "LargeMemory.h"
#include "MeshTypes.h"

#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace cadrefine
{

/// Puts things into buckets, one for each vertex (or edge), in the order in which they come: a
/// counting sort. Fill in two rounds, which must name the same vertices in the same order: count
/// all, start, add all.
template<class Entry>
class VertexBuckets
{
public:
  explicit VertexBuckets(std::size_t vertexCount) : begins_(vertexCount + 2, 0) {}

  void count(Index vertex) { ++begins_[static_cast<std::size_t>(vertex) + 2]; }
  void start()
  {
    std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
    resizeLong(entries_, begins_.back());
  }
  void add(Index vertex, const Entry& entry)
  {
    entries_[begins_[static_cast<std::size_t>(vertex) + 1]++] = entry;
  }

  /// Calls use(vertex, first, last) for the entries of each vertex in turn; they may be changed.
  template<class Use>
  void forEach(const Use& use)
  {
    for (std::size_t v = 0; v + 2 < begins_.size(); ++v)
    {
      use(static_cast<Index>(v), entries_.data() + begins_[v], entries_.data() + begins_[v + 1]);
    }
  }

  /// Where the entries of a vertex begin and end.
  std::pair<const Entry*, const Entry*> at(Index vertex) const
  {
    const auto v = static_cast<std::size_t>(vertex);
    return { entries_.data() + begins_[v], entries_.data() + begins_[v + 1] };
  }

private:
  /// While filling, begins_[v + 1] is where the next entry of vertex v goes; then where it ends.
  std::vector<std::size_t> begins_;
  std::vector<Entry> entries_;
};

} // namespace cadrefine
