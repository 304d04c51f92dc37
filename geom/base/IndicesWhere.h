// The indices for which something holds, and lists of chosen entries alone.
#pragma once

#include <cadrefine/base/MeshTypes.h>
#include <cadrefine/base/ParallelFor.h>

#include <cstddef>
#include <vector>

namespace cadrefine
{

/// The indices of 0, ..., count - 1 for which holds(index) is true, ascending.
template<class Predicate>
std::vector<Index> indicesWhere(std::size_t count, const Predicate& holds)
{
  std::vector<Index> indices;
  for (std::size_t i = 0; i < count; ++i)
  {
    if (holds(i))
    {
      indices.push_back(static_cast<Index>(i));
    }
  }
  return indices;
}

/// indicesWhere on threads, for a predicate that is cheap.
template<class Predicate>
std::vector<Index> indicesWhere(
  const ParallelFor& parallelFor, std::size_t count, const Predicate& holds)
{
  return collect<Index>(parallelFor, count, fineGrain,
    [&](std::size_t begin, std::size_t end, std::vector<Index>& indices)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        if (holds(i))
        {
          indices.push_back(static_cast<Index>(i));
        }
      }
    });
}

/// Removes all entries of a list but those with these indices, which ascend.
template<class T>
void keepOnly(const std::vector<Index>& kept, std::vector<T>& list)
{
  for (std::size_t i = 0; i < kept.size(); ++i)
  {
    list[i] = list[kept[i]];
  }
  list.resize(kept.size());
}

} // namespace cadrefine
