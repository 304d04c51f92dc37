// Lists of things by the vertex or edge to which they belong.
#pragma once

#include <cadrefine/base/LargeMemory.h>
#include <cadrefine/base/MeshTypes.h>
#include <cadrefine/base/ParallelFor.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace cadrefine
{

/// Things in buckets, one for each vertex (or edge), in the order in which they come: a counting
/// sort of at most 2^32 entries.
template<class Entry>
class VertexBuckets
{
public:
  /// visit(use), which is called twice, calls use(vertex, entry) for all entries. Memory beside
  /// them: eight bytes a vertex, and four more until they are there.
  template<class Visit>
  VertexBuckets(std::size_t vertexCount, const Visit& visit)
    : VertexBuckets(
        vertexCount, 1, [&](std::size_t, std::size_t, const auto& use) { visit(use); }, serialFor)
  {
  }

  /// Fills the buckets on threads: visit(begin, end, use), which is called twice for every part,
  /// calls use(vertex, entry) for the things in [begin, end) of `things` ones. Each of a few parts
  /// has counts of its own (four bytes a vertex), so that the order does not depend on threads.
  template<class Visit>
  VertexBuckets(
    std::size_t vertexCount, std::size_t things, const Visit& visit, const ParallelFor& parallelFor)
    : begins_(vertexCount + 1)
  {
    constexpr std::size_t mostParts = 8;
    const std::size_t parts = things / fineGrain < mostParts ? 1 : mostParts;
    std::array<std::vector<std::uint32_t>, mostParts> next;
    const auto forPart = [&](std::size_t part, const auto& use)
    { visit(part * things / parts, (part + 1) * things / parts, use); };
    forEachIndex(parallelFor, parts, 1,
      [&](std::size_t part)
      {
        resizeLong(next[part], vertexCount);
        forPart(part, [&](Index vertex, const Entry&) { ++next[part][vertex]; });
      });
    std::uint32_t sum = 0;
    for (std::size_t v = 0; v < vertexCount; ++v)
    {
      begins_[v] = sum;
      for (std::size_t part = 0; part < parts; ++part)
      {
        sum += std::exchange(next[part][v], sum);
      }
    }
    begins_[vertexCount] = sum;
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
    for (std::size_t v = 0; v + 1 < begins_.size(); ++v)
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
  /// Where the entries of each vertex begin, and those of the last one end.
  std::vector<std::size_t> begins_;
  std::vector<Entry> entries_;
};

} // namespace cadrefine
