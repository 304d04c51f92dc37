// Lists as sets.
#pragma once

#include <algorithm>
#include <vector>

namespace cadrefine
{

/// Sorts a list and leaves each value in it once.
template<class T>
void sortUniquely(std::vector<T>& list)
{
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

} // namespace cadrefine
