#include "refinement/BulkMarking.h"

#include "comm/FixedPointSum.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

namespace cadrefine
{
namespace
{

using Key = std::uint64_t;
constexpr int digits = 8;
constexpr std::size_t binCount = 256;

Key digitOf(Key key, int digit)
{
  return key >> (8 * (digits - 1 - digit)) & (binCount - 1);
}

/// Makes each bin the sum of those of all ranks.
void addOverRanks(RankExchange& exchange, std::vector<FixedPointSum>& bins)
{
  std::vector<std::int64_t> limbs;
  for (const FixedPointSum& bin : bins)
  {
    const auto mine = bin.limbs();
    limbs.insert(limbs.end(), mine.begin(), mine.end());
  }
  limbs = exchange.sum(limbs);
  auto next = limbs.cbegin();
  for (FixedPointSum& bin : bins)
  {
    FixedPointSum::Limbs all;
    std::copy_n(next, all.size(), all.begin());
    bin = FixedPointSum(bin.exponent(), all);
    next += static_cast<std::ptrdiff_t>(all.size());
  }
}

/// Where items in descending order of their keys reach a sum of weights.
struct Cut
{
  Key key = 0;         ///< Key of the items that reach the sum.
  FixedPointSum above; ///< Weight of the items that come before these.
};

/// Finds the cut among the items `open`, which come after others of weight `above`; all together
/// weigh at least `target`. Digit by digit, as radix sort does.
Cut findCut(RankExchange& exchange, const std::vector<Key>& keys,
  const std::vector<double>& weights, std::vector<std::size_t> open, const FixedPointSum& above,
  double target)
{
  Cut cut{ 0, above };
  for (int digit = 0; digit < digits; ++digit)
  {
    std::vector<FixedPointSum> bins(binCount, FixedPointSum(above.exponent()));
    for (const std::size_t i : open)
    {
      bins[digitOf(keys[i], digit)].add(weights[i]);
    }
    addOverRanks(exchange, bins);
    Key bin = binCount;
    for (FixedPointSum next = cut.above; next.value() < target && bin > 0;)
    {
      cut.above = next;
      next.add(bins[--bin]);
    }
    cut.key = cut.key << 8 | bin;
    open.erase(std::remove_if(open.begin(), open.end(),
                 [&](std::size_t i) { return digitOf(keys[i], digit) != bin; }),
      open.end());
  }
  return cut;
}

/// A key that ascends with the value, which is not negative.
Key keyOf(double value)
{
  const double positive = value + 0.0; // -0.0 would be the largest
  Key key = 0;
  std::memcpy(&key, &positive, sizeof(key));
  return key;
}

} // namespace

std::vector<unsigned char> markBulk(RankExchange& exchange, const std::vector<double>& values,
  const std::vector<std::int64_t>& ids, double fraction)
{
  std::vector<unsigned char> marks(values.size());
  const std::int64_t exponent = exchange.max(FixedPointSum::exponentOf(values));
  if (exponent == FixedPointSum::allZero)
  {
    return marks;
  }
  // In [0, 1), so that neither their sum nor a part of it leaves the range of doubles.
  std::vector<double> weights(values.size());
  std::transform(values.begin(), values.end(), weights.begin(),
    [&](double value) { return std::scalbn(value, static_cast<int>(-exponent)); });
  const double target = std::max(
    fraction * exchange.sumReproducibly(weights), std::numeric_limits<double>::denorm_min());
  const FixedPointSum nothing(0);
  std::vector<Key> keys(values.size());
  std::transform(values.begin(), values.end(), keys.begin(), keyOf);
  std::vector<std::size_t> all(values.size());
  std::iota(all.begin(), all.end(), std::size_t{ 0 });
  const Cut cut = findCut(exchange, keys, weights, std::move(all), nothing, target);

  std::vector<std::size_t> ties;
  for (std::size_t i = 0; i < keys.size(); ++i)
  {
    marks[i] = keys[i] > cut.key;
    if (keys[i] == cut.key)
    {
      ties.push_back(i);
    }
  }
  // Of these the smaller ids come first.
  std::vector<Key> idKeys(ids.size());
  std::transform(
    ids.begin(), ids.end(), idKeys.begin(), [](std::int64_t id) { return ~static_cast<Key>(id); });
  const Cut last = findCut(exchange, idKeys, weights, ties, cut.above, target);
  for (const std::size_t i : ties)
  {
    marks[i] = idKeys[i] >= last.key;
  }
  return marks;
}

} // namespace cadrefine
