// Things by a vertex or an edge to which they belong.
#pragma once

#include <cadrefine/base/LargeMemory.h>
#include <cadrefine/base/MeshTypes.h>
#include <cadrefine/base/ParallelFor.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace cadrefine
{

/// Puts things into buckets, one for each vertex (or edge), in the order in which they come: a
/// counting sort. Fill in two rounds, which must name the same vertices in the same order: count
/// all, start, add all. Or on threads, by `fill`.
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

  /// visit(begin, end, use), which is called twice for every part, calls use(vertex, entry) for the
  /// things in [begin, end) of `things` ones: at most 2^32 entries. Each of a few parts of the
  /// things has counts of its own, so that the order does not depend on threads. Memory beside the
  /// entries: four bytes a vertex and part.
  template<class Visit>
  void fill(std::size_t things, const Visit& visit, const ParallelFor& parallelFor)
  {
    constexpr std::size_t mostParts = 8;
    const std::size_t parts = things / fineGrain < mostParts ? 1 : mostParts;
    const std::size_t vertices = begins_.size() - 2;
    std::array<std::vector<std::uint32_t>, mostParts> next;
    const auto forPart = [&](std::size_t part, const auto& use)
    { visit(part * things / parts, (part + 1) * things / parts, use); };
    forEachIndex(parallelFor, parts, 1,
      [&](std::size_t part)
      {
        resizeLong(next[part], vertices);
        forPart(part, [&](Index vertex, const Entry&) { ++next[part][vertex]; });
      });
    std::uint32_t sum = 0;
    for (std::size_t v = 0; v < vertices; ++v)
    {
      begins_[v] = sum;
      for (std::size_t part = 0; part < parts; ++part)
      {
        sum += std::exchange(next[part][v], sum);
      }
    }
    begins_[vertices] = sum;
    resizeLong(entries_, sum, parallelFor);
    forEachIndex(parallelFor, parts, 1,
      [&](std::size_t part)
      {
        forPart(
          part, [&](Index vertex, const Entry& entry) { entries_[next[part][vertex]++] = entry; });
      });
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
