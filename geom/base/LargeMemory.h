// Memory for long lists.
#pragma once

#include <cadrefine/base/ParallelFor.h>

#include <cstddef>
#include <cstdint>
#include <sys/mman.h>
#include <vector>

namespace cadrefine
{

/// Asks the system for huge pages (2 MiB) in place of what is not touched yet of a block of memory:
/// a list of a million cells then costs some page faults instead of thousands, which otherwise are
/// a third of the time of refining a mesh. Does nothing for small blocks, and the system may
/// refuse; only speed depends on it.
inline void preferHugePages(void* data, std::size_t bytes)
{
  constexpr std::uintptr_t pageSize = std::uintptr_t{ 1 } << 21;
  const auto begin = reinterpret_cast<std::uintptr_t>(data);
  const std::uintptr_t first = (begin + pageSize - 1) & ~(pageSize - 1);
  const std::uintptr_t last = (begin + bytes) & ~(pageSize - 1);
  if (first < last)
  {
    madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
  }
}

/// vector.reserve for a vector that may become long.
template<class T>
void reserveLong(std::vector<T>& list, std::size_t count)
{
  list.reserve(count);
  preferHugePages(list.data(), list.capacity() * sizeof(T));
}

/// vector.resize for a vector that may become long.
template<class T>
void resizeLong(std::vector<T>& list, std::size_t count)
{
  reserveLong(list, count);
  list.resize(count);
}

/// vector.resize for a vector that is empty and may become long; the system clears its pages, which
/// takes longer than to fill them, on threads.
template<class T>
void resizeLong(std::vector<T>& list, std::size_t count, const ParallelFor& parallelFor)
{
  constexpr std::size_t page = 4096;
  constexpr std::size_t pagesAThread = 1024;
  reserveLong(list, count);
  auto* memory = reinterpret_cast<volatile unsigned char*>(list.data());
  forEachIndex(parallelFor, count * sizeof(T) / page, pagesAThread,
    [&](std::size_t number) { memory[number * page] = 0; });
  list.resize(count);
}

} // namespace cadrefine
