// Loops that may run on several threads, without saying how.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

namespace cadrefine
{

using RangeBody = std::function<void(std::size_t begin, std::size_t end)>;

/// Calls body(begin, end) for ranges that together are [0, count), maybe several at once: what the
/// calls do must not depend on each other. No more than `grain` items are too few for a thread.
using ParallelFor =
  std::function<void(std::size_t count, std::size_t grain, const RangeBody& body)>;

/// Grains for items of about 10 microseconds, such as closest points, and of 0.1 microseconds.
constexpr std::size_t coarseGrain = 64;
constexpr std::size_t fineGrain = 4096;

inline void serialFor(std::size_t count, std::size_t, const RangeBody& body)
{
  body(0, count);
}

/// Calls item(i) for all i in [0, count).
template<class Item>
void forEachIndex(
  const ParallelFor& parallelFor, std::size_t count, std::size_t grain, const Item& item)
{
  parallelFor(count, grain,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        item(i);
      }
    });
}

/// Collects what append(begin, end, list) appends to the list of each range, in the order of the
/// ranges.
template<class Item, class Append>
std::vector<Item> collect(
  const ParallelFor& parallelFor, std::size_t count, std::size_t grain, const Append& append)
{
  std::map<std::size_t, std::vector<Item>> found; // by the begin of the range
  std::mutex mutex;
  parallelFor(count, grain,
    [&](std::size_t begin, std::size_t end)
    {
      std::vector<Item> list;
      append(begin, end, list);
      const std::lock_guard<std::mutex> lock(mutex);
      found.emplace(begin, std::move(list));
    });
  std::vector<Item> all;
  for (const auto& [begin, list] : found)
  {
    all.insert(all.end(), list.begin(), list.end());
  }
  return all;
}

} // namespace cadrefine
