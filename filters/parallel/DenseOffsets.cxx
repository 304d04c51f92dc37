// 1. Each rank keeps a stretch of the range of the numbers, as long as the others'.
// 2. Weights go to the rank that keeps their numbers, which writes them into its list.
// 3. A prefix sum over the list and over the ranks; sums go back the way the weights came.

#include "GlobalNumbering.h"

#include "LargeMemory.h"

#include <algorithm>
#include <limits>
#include <string>

namespace cadrefine
{

namespace
{

constexpr std::int64_t sparse = 4;

// A number, as its place in the stretch of the rank that keeps it, and its weight.
struct PlacedWeight
{
  std::uint32_t place;
  std::uint32_t weight;
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

// The sums of weights before the numbers that came, list by list.
struct Sums
{
  std::vector<std::vector<std::int64_t>> before;
  std::int64_t total = 0;
  bool repeated = false; // a number that came twice
};

Sums sumStretch(const std::vector<std::vector<PlacedWeight>>& incoming, std::int64_t length)
{
  constexpr std::int64_t none = -1;
  std::vector<std::int64_t> list;
  reserveLong(list, static_cast<std::size_t>(length));
  list.assign(static_cast<std::size_t>(length), none);
  Sums sums;
  for (const auto& weights : incoming)
  {
    for (const PlacedWeight& placed : weights)
    {
      sums.repeated = sums.repeated || list[placed.place] != none;
      list[placed.place] = placed.weight;
    }
  }
  for (std::int64_t& entry : list)
  {
    const std::int64_t weight = std::max<std::int64_t>(entry, 0);
    entry = sums.total;
    sums.total += weight;
  }
  for (const auto& weights : incoming)
  {
    auto& before = sums.before.emplace_back();
    resizeLong(before, weights.size());
    std::transform(weights.begin(), weights.end(), before.begin(),
      [&](const PlacedWeight& placed) { return list[placed.place]; });
  }
  return sums;
}

Numbering sumDense(RankExchange& exchange, const Range& range, const std::vector<GlobalId>& numbers,
  const std::vector<std::int64_t>& weights)
{
  std::vector<std::vector<PlacedWeight>> outgoing(static_cast<std::size_t>(exchange.size()));
  for (auto& list : outgoing)
    list.reserve(numbers.size() / outgoing.size());
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    outgoing[static_cast<std::size_t>(range.keeper(numbers[i]))].push_back(
      { range.place(numbers[i]), static_cast<std::uint32_t>(weights[i]) });
  }
  Sums sums = sumStretch(exchange.allToAll(outgoing), range.length);
  exchange.agree(sums.repeated ? "A number that must be unique occurs twice." : "");
  const std::int64_t first = exchange.sumBefore(sums.total);
  Numbering result;
  result.count = exchange.sum(sums.total);
  const auto answers = exchange.allToAll(sums.before);
  std::vector<std::size_t> next(answers.size(), 0);
  std::vector<std::int64_t> firsts = exchange.gather(first);
  resizeLong(result.numbers, numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    const auto keeper = static_cast<std::size_t>(range.keeper(numbers[i]));
    result.numbers[i] = firsts[keeper] + answers[keeper][next[keeper]++];
  }
  return result;
}

} // namespace

Numbering denseOffsets(RankExchange& exchange, const std::vector<GlobalId>& numbers,
  const std::vector<std::int64_t>& weights)
{
  const Range range = findRange(exchange, numbers);
  if (range.dense)
  {
    exchange.agree(
      numbers.size() == weights.size() ? "" : "There are not as many weights as numbers.");
    return sumDense(exchange, range, numbers, weights);
  }
  std::vector<Key<1>> keys;
  reserveLong(keys, numbers.size());
  for (const GlobalId number : numbers)
    keys.push_back({ number });
  return offsets(exchange, keys, weights);
}

} // namespace cadrefine
