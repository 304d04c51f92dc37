// Sorting by whole numbers in linear time.
#pragma once

#include <cadrefine/base/LargeMemory.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace cadrefine
{

/// A sort key and the place that it comes from.
struct PlacedKey
{
  std::uint64_t key;
  std::uint32_t place;
};

/// Sorts by key; equal keys stay in their order. Least significant digit first, 11 bits a pass
/// (D. E. Knuth, "The Art of Computer Programming" 3, 5.2.5, algorithm R); digits in which all keys
/// agree cost nothing, and keys that are in order already one look. Work linear in the number of
/// keys times at most 6 digits; memory: the keys once more.
inline void radixSort(std::vector<PlacedKey>& keys)
{
  constexpr int digitBits = 11;
  constexpr int digits = 6;
  constexpr std::size_t buckets = std::size_t{ 1 } << digitBits;
  const auto digitOf = [](std::uint64_t key, int digit)
  { return (key >> (digit * digitBits)) & (buckets - 1); };

  std::vector<std::array<std::size_t, buckets>> counts(digits);
  bool sorted = true;
  std::uint64_t previous = 0;
  for (const PlacedKey& entry : keys)
  {
    sorted = sorted && previous <= entry.key;
    previous = entry.key;
    for (int digit = 0; digit < digits; ++digit)
    {
      ++counts[digit][digitOf(entry.key, digit)];
    }
  }
  if (sorted)
  {
    return;
  }
  std::vector<PlacedKey> other;
  resizeLong(other, keys.size());
  for (int digit = 0; digit < digits; ++digit)
  {
    auto& next = counts[digit];
    if (next[digitOf(keys.front().key, digit)] == keys.size())
    {
      continue;
    }
    std::size_t first = 0;
    for (std::size_t& count : next)
    {
      first += std::exchange(count, first);
    }
    for (const PlacedKey& entry : keys)
    {
      other[next[digitOf(entry.key, digit)]++] = entry;
    }
    keys.swap(other);
  }
}

/// A whole number as an unsigned one with the same order.
inline std::uint64_t orderedBits(std::int64_t number)
{
  return static_cast<std::uint64_t>(number) ^ (std::uint64_t{ 1 } << 63);
}

} // namespace cadrefine
