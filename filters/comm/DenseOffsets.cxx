// 1. Each rank keeps a stretch of the range of the numbers, as long as the others'.
// 2. Numbers of a rank that follow each other make a run; its sum goes to the rank that keeps these
//    numbers, which sorts the runs that came.
// 3. A prefix sum over these and over the ranks; sums go back the way the runs came.

#include "comm/GlobalNumbering.h"

#include <cadrefine/base/LargeMemory.h>
#include <cadrefine/base/RadixOrder.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace cadrefine
{

namespace
{

constexpr std::int64_t sparse = 4;
constexpr std::size_t longRun = 64;

// Numbers one after the other, kept by one rank: the first as its place in that rank's stretch.
struct Run
{
  std::uint32_t place;
  std::uint32_t length;
  std::int64_t weight; // of all together
};

struct Range
{
  GlobalId first = 0;
  std::int64_t length = 0; // of a rank's stretch
  bool dense = false;

  int keeper(GlobalId number) const { return static_cast<int>((number - first) / length); }
  std::uint32_t place(GlobalId number) const
  {
    return static_cast<std::uint32_t>((number - first) % length);
  }
};

Range findRange(RankExchange& exchange, const std::vector<GlobalId>& numbers)
{
  constexpr GlobalId infinity = std::numeric_limits<GlobalId>::max();
  GlobalId least = infinity;
  GlobalId largest = -infinity;
  for (const GlobalId number : numbers)
  {
    least = std::min(least, number);
    largest = std::max(largest, number);
  }
  const auto bounds = exchange.max(std::vector<std::int64_t>{ -least, largest });
  const std::int64_t count = exchange.sum(numbers.size());
  Range range;
  range.first = -bounds[0];
  // The width as an unsigned number: it may be beyond the largest signed one.
  const auto width =
    static_cast<std::uint64_t>(bounds[1]) - static_cast<std::uint64_t>(range.first);
  range.dense = count > 0 && width < static_cast<std::uint64_t>(sparse * count);
  range.length = range.dense ? static_cast<std::int64_t>(width) / exchange.size() + 1 : 0;
  range.dense = range.dense && range.length <= std::numeric_limits<std::uint32_t>::max();
  return range;
}

// Calls begin(keeper, number) where a run starts, and weigh(weight) for each number.
template<class Begin, class Weigh>
void forRuns(
  const Range& range, const std::vector<GlobalId>& numbers, const Begin& begin, const Weigh& weigh)
{
  GlobalId next = 0;
  GlobalId end = 0; // of the stretch
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    if (i == 0 || numbers[i] != next || next == end)
    {
      const int keeper = range.keeper(numbers[i]);
      end = range.first + (keeper + 1) * range.length;
      begin(keeper, numbers[i]);
    }
    next = numbers[i] + 1;
    weigh(i); // which may write the number's sum in its place
  }
}

std::vector<std::vector<Run>> makeRuns(int ranks, const Range& range,
  const std::vector<GlobalId>& numbers, const std::vector<Index>& weights)
{
  std::vector<std::vector<Run>> runs(static_cast<std::size_t>(ranks));
  Run* run = nullptr;
  forRuns(
    range, numbers,
    [&](int keeper, GlobalId number) {
      run = &runs[static_cast<std::size_t>(keeper)].emplace_back(Run{ range.place(number), 0, 0 });
    },
    [&](std::size_t i)
    {
      ++run->length;
      run->weight += weights[i];
    });
  return runs;
}

// The sums of weights before the runs that came, list by list.
struct Sums
{
  std::vector<std::vector<std::int64_t>> before;
  std::int64_t total = 0;
  bool repeated = false; // a number that came twice
};

Sums sumRuns(const std::vector<std::vector<Run>>& incoming)
{
  std::vector<Run> runs;
  for (const auto& list : incoming)
  {
    runs.insert(runs.end(), list.begin(), list.end());
  }
  std::vector<PlacedKey> order;
  reserveLong(order, runs.size());
  for (std::size_t r = 0; r < runs.size(); ++r)
  {
    order.push_back({ runs[r].place, static_cast<std::uint32_t>(r) });
  }
  radixSort(order);
  Sums sums;
  std::uint64_t end = 0; // of the last run
  for (const PlacedKey& next : order)
  {
    Run& run = runs[next.place];
    sums.repeated = sums.repeated || run.place < end;
    end = std::uint64_t{ run.place } + run.length;
    sums.total += std::exchange(run.weight, sums.total); // from now on what is before it
  }
  auto run = runs.begin();
  for (const auto& list : incoming)
  {
    auto& before = sums.before.emplace_back();
    resizeLong(before, list.size());
    for (std::int64_t& sum : before)
    {
      sum = (run++)->weight;
    }
  }
  return sums;
}

// In the place of the numbers.
Numbering sumDense(RankExchange& exchange, const Range& range, std::vector<GlobalId> numbers,
  const std::vector<Index>& weights)
{
  const Sums sums = sumRuns(exchange.allToAll(makeRuns(exchange.size(), range, numbers, weights)));
  exchange.agree(sums.repeated ? "A number that must be unique occurs twice." : "");
  const std::int64_t first = exchange.sumBefore(sums.total);
  Numbering result;
  result.count = exchange.sum(sums.total);
  const auto answers = exchange.allToAll(sums.before);
  std::vector<std::size_t> next(answers.size(), 0);
  const std::vector<std::int64_t> firsts = exchange.gather(first);
  std::int64_t sum = 0;
  forRuns(
    range, numbers,
    [&](int rank, GlobalId)
    {
      const auto keeper = static_cast<std::size_t>(rank);
      sum = firsts[keeper] + answers[keeper][next[keeper]++];
    },
    [&](std::size_t i)
    {
      numbers[i] = sum;
      sum += weights[i];
    });
  result.numbers = std::move(numbers);
  return result;
}

// The places of the numbers in ascending order.
std::vector<std::uint32_t> ascendingPlaces(const std::vector<GlobalId>& numbers)
{
  std::vector<PlacedKey> keys;
  resizeLong(keys, numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    keys[i] = { orderedBits(numbers[i]), static_cast<std::uint32_t>(i) };
  }
  radixSort(keys);
  std::vector<std::uint32_t> places;
  resizeLong(places, keys.size());
  std::transform(
    keys.begin(), keys.end(), places.begin(), [](const PlacedKey& key) { return key.place; });
  return places;
}

// How many runs the numbers make in their order.
std::size_t countRuns(const std::vector<GlobalId>& numbers)
{
  std::size_t count = 1;
  for (std::size_t i = 1; i < numbers.size(); ++i)
  {
    count += numbers[i] != numbers[i - 1] + 1;
  }
  return count;
}

// Ascending, unless runs are long as it is; on one rank nothing is sent.
Numbering sumInOrder(RankExchange& exchange, const Range& range, std::vector<GlobalId> numbers,
  const std::vector<Index>& weights)
{
  if (exchange.size() == 1 || countRuns(numbers) < numbers.size() / longRun)
  {
    return sumDense(exchange, range, std::move(numbers), weights);
  }
  const std::vector<std::uint32_t> places = ascendingPlaces(numbers);
  std::vector<GlobalId> sortedNumbers;
  std::vector<Index> sortedWeights;
  reserveLong(sortedNumbers, numbers.size());
  reserveLong(sortedWeights, numbers.size());
  for (const std::uint32_t place : places)
  {
    sortedNumbers.push_back(numbers[place]);
    sortedWeights.push_back(weights[place]);
  }
  const Numbering sorted = sumDense(exchange, range, std::move(sortedNumbers), sortedWeights);
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    numbers[places[i]] = sorted.numbers[i];
  }
  return { std::move(numbers), sorted.count };
}

} // namespace

Numbering denseOffsets(
  RankExchange& exchange, std::vector<GlobalId> numbers, const std::vector<Index>& weights)
{
  const Range range = findRange(exchange, numbers);
  if (range.dense)
  {
    exchange.agree(
      numbers.size() == weights.size() ? "" : "There are not as many weights as numbers.");
    return sumInOrder(exchange, range, std::move(numbers), weights);
  }
  std::vector<Key<1>> keys;
  reserveLong(keys, numbers.size());
  for (const GlobalId number : numbers)
  {
    keys.push_back({ number });
  }
  return offsets(exchange, keys, std::vector<std::int64_t>(weights.begin(), weights.end()));
}

} // namespace cadrefine
