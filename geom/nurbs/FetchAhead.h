// Fetching memory while other work is done. Private to geom/nurbs.
#pragma once

#include <cstddef>

namespace cadrefine
{

/// Asks for `count` objects from `first` on, which a query is about to read: models are larger than
/// caches, and a query's steps depend on each other, so that it would wait for each. Changes
/// nothing else.
template<typename T>
void fetchAhead(const T* first, std::size_t count = 1)
{
  constexpr std::size_t line = 64;
  const auto* bytes = reinterpret_cast<const char*>(first);
  for (std::size_t offset = 0; offset < count * sizeof(T); offset += line)
  {
    __builtin_prefetch(bytes + offset);
  }
}

} // namespace cadrefine
