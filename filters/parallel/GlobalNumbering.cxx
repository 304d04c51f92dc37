// 1. Every rank sorts its keys and drops duplicates.
// 2. Samples of all ranks, one in each stretch of equal length, go to rank 0, which picks the
//    splitters: the keys at which one rank's share ends and the next one's begins.
// 3. Every rank sends its keys to the ranks whose share they are in.
// 4. The rank that got them sorts them again, drops duplicates and counts; a prefix sum over the
//    ranks gives the number of its first key.
// 5. Numbers go back the way the keys came.
//
// Gathering P samples from each rank (regular sampling) would cost P * P of memory; here it is 64 a
// rank on average. A sample's place in its stretch is pseudo-random but fixed, since samples at
// equal places on all ranks would err in the same direction.

#include "GlobalNumbering.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

namespace cadrefine
{

namespace
{

constexpr std::int64_t samplesPerRank = 64;

// A key and where it stands in a list.
template<std::size_t K>
struct Place
{
  Key<K> key;
  std::size_t list;
  std::size_t position;

  friend bool operator<(const Place& a, const Place& b)
  {
    if (a.key != b.key)
      return a.key < b.key;
    return std::pair(a.list, a.position) < std::pair(b.list, b.position);
  }
};

template<std::size_t K>
std::vector<Place<K>> sortedPlaces(const std::vector<std::vector<Key<K>>>& lists)
{
  std::size_t count = 0;
  for (const std::vector<Key<K>>& list : lists)
    count += list.size();
  std::vector<Place<K>> places;
  places.reserve(count);
  for (std::size_t l = 0; l < lists.size(); ++l)
  {
    for (std::size_t i = 0; i < lists[l].size(); ++i)
      places.push_back({ lists[l][i], l, i });
  }
  std::sort(places.begin(), places.end());
  return places;
}

// The distinct keys of a rank, ascending, and for each local key its place among them.
template<std::size_t K>
struct LocalKeys
{
  std::vector<Key<K>> distinct;
  std::vector<std::size_t> placeOf;
};

template<std::size_t K>
LocalKeys<K> sortLocally(const std::vector<Key<K>>& keys)
{
  LocalKeys<K> local;
  local.placeOf.resize(keys.size());
  for (const Place<K>& place : sortedPlaces<K>({ keys }))
  {
    if (local.distinct.empty() || local.distinct.back() != place.key)
      local.distinct.push_back(place.key);
    local.placeOf[place.position] = local.distinct.size() - 1;
  }
  return local;
}

std::size_t mixed(std::size_t bits)
{
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9ULL;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebULL;
  return bits ^ (bits >> 31);
}

template<std::size_t K>
std::vector<Key<K>> takeSamples(
  const std::vector<Key<K>>& sorted, std::size_t stretch, std::size_t seed)
{
  std::vector<Key<K>> samples;
  for (std::size_t begin = 0; begin < sorted.size(); begin += stretch)
  {
    const std::size_t position = begin + mixed(seed + begin) % stretch;
    if (position < sorted.size())
      samples.push_back(sorted[position]);
  }
  return samples;
}

// The first keys of the shares of ranks 1, 2, ...; fewer where there are few samples.
template<std::size_t K>
std::vector<Key<K>> findSplitters(RankExchange& exchange, const std::vector<Key<K>>& sorted)
{
  const std::size_t rankCount = static_cast<std::size_t>(exchange.size());
  if (rankCount == 1)
    return {};
  const std::int64_t keyCount = exchange.sum(sorted.size());
  const std::size_t stretch =
    static_cast<std::size_t>(keyCount / (samplesPerRank * exchange.size()) + 1);
  std::vector<std::vector<Key<K>>> toRank(rankCount);
  toRank[0] = takeSamples(sorted, stretch, mixed(static_cast<std::size_t>(exchange.rank()) + 1));
  std::vector<Key<K>> samples;
  for (const std::vector<Key<K>>& list : exchange.allToAll(toRank))
    samples.insert(samples.end(), list.begin(), list.end());
  std::sort(samples.begin(), samples.end());

  std::vector<Key<K>> splitters;
  for (std::size_t r = 1; r < rankCount && !samples.empty(); ++r)
    splitters.push_back(samples[r * samples.size() / rankCount]);
  std::vector<char> bytes(splitters.size() * sizeof(Key<K>));
  if (!bytes.empty())
    std::memcpy(bytes.data(), splitters.data(), bytes.size());
  bytes = exchange.broadcast(bytes, 0);
  splitters.resize(bytes.size() / sizeof(Key<K>));
  if (!bytes.empty())
    std::memcpy(splitters.data(), bytes.data(), bytes.size());
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
    pieces.emplace_back(values.data() + bounds[r], values.data() + bounds[r + 1]);
  return pieces;
}

using NumberLists = std::vector<std::vector<std::int64_t>>;

// The numbers of the keys of one share, in the lists in which they came, and the weight of the
// share; a key weighs 1 where there are no weights.
struct Share
{
  NumberLists numbers;
  std::int64_t weight = 0;
  bool repeated = false; // a key that came twice
};

template<std::size_t K>
Share numberShare(const std::vector<std::vector<Key<K>>>& keys, const NumberLists* weights)
{
  Share share;
  share.numbers.resize(keys.size());
  for (std::size_t l = 0; l < keys.size(); ++l)
    share.numbers[l].resize(keys[l].size());
  const std::vector<Place<K>> places = sortedPlaces(keys);
  std::int64_t number = 0;
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    const Place<K>& place = places[i];
    if (i > 0 && places[i - 1].key == place.key)
    {
      share.repeated = true;
    }
    else
    {
      number = share.weight;
      share.weight += weights ? (*weights)[place.list][place.position] : 1;
    }
    share.numbers[place.list][place.position] = number;
  }
  return share;
}

// Steps 2 to 5, for the sorted distinct keys of a rank.
template<std::size_t K>
Numbering numberSorted(RankExchange& exchange, const std::vector<Key<K>>& sorted,
  const std::vector<std::int64_t>* weights)
{
  const std::vector<std::size_t> bounds =
    shareBounds(sorted, findSplitters(exchange, sorted), static_cast<std::size_t>(exchange.size()));
  const auto keysHere = exchange.allToAll(cut(sorted, bounds));
  NumberLists weightsHere;
  if (weights)
    weightsHere = exchange.allToAll(cut(*weights, bounds));
  Share share = numberShare(keysHere, weights ? &weightsHere : nullptr);
  if (weights)
    exchange.agree(share.repeated ? "A key that must be unique occurs on two ranks." : "");

  const std::int64_t first = exchange.sumBefore(share.weight);
  for (std::vector<std::int64_t>& numbers : share.numbers)
  {
    for (std::int64_t& number : numbers)
      number += first;
  }
  Numbering result;
  result.count = exchange.sum(share.weight);
  for (const std::vector<std::int64_t>& numbers : exchange.allToAll(share.numbers))
    result.numbers.insert(result.numbers.end(), numbers.begin(), numbers.end());
  return result;
}

template<std::size_t K>
Numbering inLocalOrder(const LocalKeys<K>& local, const Numbering& ofDistinct)
{
  Numbering result;
  result.count = ofDistinct.count;
  result.numbers.reserve(local.placeOf.size());
  for (const std::size_t place : local.placeOf)
    result.numbers.push_back(ofDistinct.numbers[place]);
  return result;
}

} // namespace

template<std::size_t K>
Numbering numberDistinct(RankExchange& exchange, const std::vector<Key<K>>& keys)
{
  const LocalKeys<K> local = sortLocally(keys);
  return inLocalOrder(local, numberSorted(exchange, local.distinct, nullptr));
}

template<std::size_t K>
Numbering offsets(
  RankExchange& exchange, const std::vector<Key<K>>& keys, const std::vector<std::int64_t>& weights)
{
  const LocalKeys<K> local = sortLocally(keys);
  std::string error;
  if (weights.size() != keys.size())
    error = "There are " + std::to_string(weights.size()) + " weights for " +
            std::to_string(keys.size()) + " keys.";
  else if (local.distinct.size() != keys.size())
    error = "A key that must be unique occurs twice on a rank.";
  exchange.agree(error);

  std::vector<std::int64_t> sortedWeights(weights.size());
  for (std::size_t i = 0; i < weights.size(); ++i)
    sortedWeights[local.placeOf[i]] = weights[i];
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
