// 1. Every rank sorts its keys and drops duplicates: by radix, as many of the first words as 64
//    bits hold once the least value is taken off, and the rest by comparing.
// 2. Samples of all ranks, one in each stretch of equal length, go to rank 0, which picks the
//    splitters: the keys at which one rank's share ends and the next one's begins.
// 3. Every rank sends its keys to the ranks whose share they are in.
// 4. The rank that got them merges them, drops duplicates and counts; a prefix sum over the ranks
//    gives the number of its first key.
// 5. Numbers go back the way the keys came.
//
// Gathering P samples from each rank (regular sampling) would cost P * P of memory; here it is 64 a
// rank on average. A sample's place in its stretch is pseudo-random but fixed, since samples at
// equal places on all ranks would err in the same direction.

#include "comm/GlobalNumbering.h"

#include <cadrefine/base/LargeMemory.h>
#include <cadrefine/base/MixedBits.h>
#include <cadrefine/base/RadixOrder.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

namespace cadrefine
{

namespace
{

constexpr std::int64_t samplesPerRank = 64;

// The least and the largest value of one word of the keys.
struct WordRange
{
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  std::int64_t largest = std::numeric_limits<std::int64_t>::min();

  int bits() const
  {
    int count = 0;
    for (std::uint64_t width = largest < least ? 0 : offset(largest); width > 0; width >>= 1)
    {
      ++count;
    }
    return count;
  }
  std::uint64_t offset(std::int64_t value) const
  {
    return static_cast<std::uint64_t>(value) - static_cast<std::uint64_t>(least);
  }
};

// The first words of the keys, as many as there is room for in one number that orders them.
template<std::size_t K>
struct PackedKeys
{
  std::vector<PlacedKey> keys;
  std::size_t words = 0; // that went in
};

template<std::size_t K>
PackedKeys<K> pack(const std::vector<Key<K>>& keys)
{
  std::array<WordRange, K> ranges;
  for (const Key<K>& key : keys)
  {
    for (std::size_t w = 0; w < K; ++w)
    {
      ranges[w].least = std::min(ranges[w].least, key[w]);
      ranges[w].largest = std::max(ranges[w].largest, key[w]);
    }
  }
  PackedKeys<K> packed;
  std::array<int, K> shifts{};
  int room = 64;
  while (packed.words < K && ranges[packed.words].bits() <= room)
  {
    const int bits = ranges[packed.words].bits();
    room -= bits;
    shifts[packed.words] = bits;
    ++packed.words;
  }
  resizeLong(packed.keys, keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i)
  {
    std::uint64_t number = 0;
    for (std::size_t w = 0; w < packed.words; ++w)
    {
      number = (shifts[w] < 64 ? number << shifts[w] : 0) | ranges[w].offset(keys[i][w]);
    }
    packed.keys[i] = { number, static_cast<std::uint32_t>(i) };
  }
  return packed;
}

// A list of keys put in order.
struct SortedPlaces
{
  std::vector<std::uint32_t> places; // of the keys, ascending
  std::vector<char> repeats;         // whether a key is equal to the one before it
};

// Orders the places first up to last, whose keys have the same first `words` words.
template<std::size_t K>
void sortByRest(const std::vector<Key<K>>& keys, std::size_t words, SortedPlaces& sorted,
  std::size_t first, std::size_t last)
{
  const auto compare = [&](std::uint32_t a, std::uint32_t b)
  {
    for (std::size_t w = words; w < K; ++w)
    {
      if (keys[a][w] != keys[b][w])
      {
        return keys[a][w] < keys[b][w] ? -1 : 1;
      }
    }
    return 0;
  };
  auto* places = sorted.places.data();
  std::sort(places + first, places + last,
    [&](std::uint32_t a, std::uint32_t b) { return compare(a, b) < 0; });
  for (std::size_t i = first + 1; i < last; ++i)
  {
    sorted.repeats[i] = compare(places[i - 1], places[i]) == 0;
  }
}

template<std::size_t K>
SortedPlaces sortKeys(const std::vector<Key<K>>& keys)
{
  PackedKeys<K> packed = pack(keys);
  radixSort(packed.keys);
  SortedPlaces sorted{ std::vector<std::uint32_t>(keys.size()), std::vector<char>(keys.size(), 0) };
  for (std::size_t i = 0; i < keys.size(); ++i)
  {
    sorted.places[i] = packed.keys[i].place;
    sorted.repeats[i] = i > 0 && packed.keys[i].key == packed.keys[i - 1].key;
  }
  for (std::size_t first = 0; packed.words < K && first < keys.size();)
  {
    std::size_t last = first + 1;
    while (last < keys.size() && packed.keys[last].key == packed.keys[first].key)
    {
      ++last;
    }
    if (last - first > 1)
    {
      sortByRest(keys, packed.words, sorted, first, last);
    }
    first = last;
  }
  return sorted;
}

// The same for keys that are sorted in pieces: from bounds[r] up to bounds[r + 1]. Merges pairs of
// pieces until one is left.
template<std::size_t K>
SortedPlaces mergeKeys(const std::vector<Key<K>>& keys, std::vector<std::size_t> bounds)
{
  SortedPlaces sorted{ std::vector<std::uint32_t>(keys.size()), std::vector<char>(keys.size(), 0) };
  std::iota(sorted.places.begin(), sorted.places.end(), 0U);
  const auto at = [&](std::size_t bound)
  { return sorted.places.begin() + static_cast<std::ptrdiff_t>(bounds[bound]); };
  while (bounds.size() > 2)
  {
    std::vector<std::size_t> merged{ 0 };
    for (std::size_t r = 0; r + 1 < bounds.size(); r += 2)
    {
      const std::size_t end = std::min(r + 2, bounds.size() - 1);
      std::inplace_merge(at(r), at(r + 1), at(end),
        [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
      merged.push_back(bounds[end]);
    }
    bounds = std::move(merged);
  }
  for (std::size_t i = 1; i < keys.size(); ++i)
  {
    sorted.repeats[i] = keys[sorted.places[i]] == keys[sorted.places[i - 1]];
  }
  return sorted;
}

// The distinct keys of a rank, ascending, and for each local key its place among them.
template<std::size_t K>
struct LocalKeys
{
  std::vector<Key<K>> distinct;
  std::vector<std::uint32_t> placeOf;
};

template<std::size_t K>
LocalKeys<K> takeDistinct(const std::vector<Key<K>>& keys, const SortedPlaces& sorted)
{
  LocalKeys<K> local;
  local.placeOf.resize(keys.size());
  reserveLong(local.distinct, keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i)
  {
    if (!sorted.repeats[i])
    {
      local.distinct.push_back(keys[sorted.places[i]]);
    }
    local.placeOf[sorted.places[i]] = static_cast<std::uint32_t>(local.distinct.size() - 1);
  }
  return local;
}

template<std::size_t K>
std::vector<Key<K>> takeSamples(
  const std::vector<Key<K>>& sorted, std::size_t stretch, std::size_t seed)
{
  std::vector<Key<K>> samples;
  for (std::size_t begin = 0; begin < sorted.size(); begin += stretch)
  {
    const std::size_t position = begin + mixedBits(seed + begin) % stretch;
    if (position < sorted.size())
    {
      samples.push_back(sorted[position]);
    }
  }
  return samples;
}

// The first keys of the shares of ranks 1, 2, ...; fewer where there are few samples.
template<std::size_t K>
std::vector<Key<K>> findSplitters(RankExchange& exchange, const std::vector<Key<K>>& sorted)
{
  const std::size_t rankCount = static_cast<std::size_t>(exchange.size());
  if (rankCount == 1)
  {
    return {};
  }
  const std::int64_t keyCount = exchange.sum(sorted.size());
  const std::size_t stretch =
    static_cast<std::size_t>(keyCount / (samplesPerRank * exchange.size()) + 1);
  std::vector<std::vector<Key<K>>> toRank(rankCount);
  toRank[0] =
    takeSamples(sorted, stretch, mixedBits(static_cast<std::size_t>(exchange.rank()) + 1));
  std::vector<Key<K>> samples;
  for (const std::vector<Key<K>>& list : exchange.allToAll(toRank))
  {
    samples.insert(samples.end(), list.begin(), list.end());
  }
  std::sort(samples.begin(), samples.end());

  std::vector<Key<K>> splitters;
  for (std::size_t r = 1; r < rankCount && !samples.empty(); ++r)
  {
    splitters.push_back(samples[r * samples.size() / rankCount]);
  }
  std::vector<char> bytes(splitters.size() * sizeof(Key<K>));
  if (!bytes.empty())
  {
    std::memcpy(bytes.data(), splitters.data(), bytes.size());
  }
  bytes = exchange.broadcast(bytes, 0);
  splitters.resize(bytes.size() / sizeof(Key<K>));
  if (!bytes.empty())
  {
    std::memcpy(splitters.data(), bytes.data(), bytes.size());
  }
  return splitters;
}

// Where in a sorted list each rank's share begins; one entry more than there are ranks.
template<std::size_t K>
std::vector<std::size_t> shareBounds(
  const std::vector<Key<K>>& sorted, const std::vector<Key<K>>& splitters, std::size_t rankCount)
{
  std::vector<std::size_t> bounds(rankCount + 1, sorted.size());
  bounds[0] = 0;
  for (std::size_t r = 0; r < splitters.size(); ++r)
  {
    bounds[r + 1] = static_cast<std::size_t>(
      std::lower_bound(sorted.begin(), sorted.end(), splitters[r]) - sorted.begin());
  }
  return bounds;
}

template<class T>
std::vector<std::vector<T>> cut(
  const std::vector<T>& values, const std::vector<std::size_t>& bounds)
{
  std::vector<std::vector<T>> pieces;
  for (std::size_t r = 0; r + 1 < bounds.size(); ++r)
  {
    pieces.emplace_back(values.data() + bounds[r], values.data() + bounds[r + 1]);
  }
  return pieces;
}

// The numbers of the keys of one share, in the order in which they came, and the weight of the
// share; a key weighs 1 where there are no weights.
struct Share
{
  std::vector<std::int64_t> numbers;
  std::int64_t weight = 0;
};

template<class T>
std::vector<T> joined(std::vector<std::vector<T>> lists)
{
  std::vector<T> all = std::move(lists.front());
  for (std::size_t l = 1; l < lists.size(); ++l)
  {
    all.insert(all.end(), lists[l].begin(), lists[l].end());
  }
  return all;
}

// Lists of these lengths in turn; `bounds` as from shareBounds.
template<class T>
std::vector<std::size_t> boundsOf(const std::vector<std::vector<T>>& lists)
{
  std::vector<std::size_t> bounds{ 0 };
  for (const std::vector<T>& list : lists)
  {
    bounds.push_back(bounds.back() + list.size());
  }
  return bounds;
}

Share numberShare(const SortedPlaces& sorted, const std::vector<std::int64_t>* weights)
{
  Share share;
  resizeLong(share.numbers, sorted.places.size());
  std::int64_t number = 0;
  for (std::size_t i = 0; i < sorted.places.size(); ++i)
  {
    const std::uint32_t place = sorted.places[i];
    if (!sorted.repeats[i])
    {
      number = share.weight;
      share.weight += weights ? (*weights)[place] : 1;
    }
    share.numbers[place] = number;
  }
  return share;
}

bool anyRepeats(const SortedPlaces& sorted)
{
  return std::find(sorted.repeats.begin(), sorted.repeats.end(), 1) != sorted.repeats.end();
}

// Steps 2 to 5, for the sorted distinct keys of a rank.
template<std::size_t K>
Numbering numberSorted(RankExchange& exchange, const std::vector<Key<K>>& sorted,
  const std::vector<std::int64_t>* weights)
{
  const std::vector<std::size_t> bounds =
    shareBounds(sorted, findSplitters(exchange, sorted), static_cast<std::size_t>(exchange.size()));
  auto keysHere = exchange.allToAll(cut(sorted, bounds));
  const std::vector<std::size_t> boundsHere = boundsOf(keysHere);
  const SortedPlaces sortedHere = mergeKeys(joined(std::move(keysHere)), boundsHere);
  std::vector<std::int64_t> weightsHere;
  if (weights)
  {
    weightsHere = joined(exchange.allToAll(cut(*weights, bounds)));
  }
  Share share = numberShare(sortedHere, weights ? &weightsHere : nullptr);
  if (weights)
  {
    exchange.agree(anyRepeats(sortedHere) ? "A key that must be unique occurs on two ranks." : "");
  }

  const std::int64_t first = exchange.sumBefore(share.weight);
  for (std::int64_t& number : share.numbers)
  {
    number += first;
  }
  Numbering result;
  result.count = exchange.sum(share.weight);
  result.numbers = joined(exchange.allToAll(cut(share.numbers, boundsHere)));
  return result;
}

template<std::size_t K>
Numbering inLocalOrder(const LocalKeys<K>& local, const Numbering& ofDistinct)
{
  Numbering result;
  result.count = ofDistinct.count;
  result.numbers.reserve(local.placeOf.size());
  for (const std::uint32_t place : local.placeOf)
  {
    result.numbers.push_back(ofDistinct.numbers[place]);
  }
  return result;
}

} // namespace

template<std::size_t K>
Numbering numberDistinct(RankExchange& exchange, const std::vector<Key<K>>& keys)
{
  const SortedPlaces sorted = sortKeys(keys);
  if (exchange.size() == 1)
  {
    Share all = numberShare(sorted, nullptr);
    return { std::move(all.numbers), all.weight };
  }
  const LocalKeys<K> local = takeDistinct(keys, sorted);
  return inLocalOrder(local, numberSorted(exchange, local.distinct, nullptr));
}

template<std::size_t K>
Numbering offsets(
  RankExchange& exchange, const std::vector<Key<K>>& keys, const std::vector<std::int64_t>& weights)
{
  const SortedPlaces sorted = sortKeys(keys);
  std::string error;
  if (weights.size() != keys.size())
  {
    error = "There are " + std::to_string(weights.size()) + " weights for " +
            std::to_string(keys.size()) + " keys.";
  }
  else if (anyRepeats(sorted))
  {
    error = "A key that must be unique occurs twice on a rank.";
  }
  exchange.agree(error);
  if (exchange.size() == 1)
  {
    Share all = numberShare(sorted, &weights);
    return { std::move(all.numbers), all.weight };
  }
  const LocalKeys<K> local = takeDistinct(keys, sorted);
  std::vector<std::int64_t> sortedWeights(weights.size());
  for (std::size_t i = 0; i < weights.size(); ++i)
  {
    sortedWeights[local.placeOf[i]] = weights[i];
  }
  return inLocalOrder(local, numberSorted(exchange, local.distinct, &sortedWeights));
}

std::int64_t coordinateKey(double coordinate)
{
  const double withoutMinusZero = coordinate + 0.0;
  std::int64_t bits = 0;
  std::memcpy(&bits, &withoutMinusZero, sizeof(bits));
  // The bits of a negative number grow with its magnitude: turn round all but the sign.
  return bits >= 0 ? bits : bits ^ std::numeric_limits<std::int64_t>::max();
}

template Numbering numberDistinct<1>(RankExchange&, const std::vector<Key<1>>&);
template Numbering numberDistinct<2>(RankExchange&, const std::vector<Key<2>>&);
template Numbering numberDistinct<3>(RankExchange&, const std::vector<Key<3>>&);
template Numbering numberDistinct<4>(RankExchange&, const std::vector<Key<4>>&);
template Numbering offsets<1>(
  RankExchange&, const std::vector<Key<1>>&, const std::vector<std::int64_t>&);
template Numbering offsets<2>(
  RankExchange&, const std::vector<Key<2>>&, const std::vector<std::int64_t>&);
template Numbering offsets<3>(
  RankExchange&, const std::vector<Key<3>>&, const std::vector<std::int64_t>&);
template Numbering offsets<4>(
  RankExchange&, const std::vector<Key<4>>&, const std::vector<std::int64_t>&);

} // namespace cadrefine
