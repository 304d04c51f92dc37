// The smallest set that carries a part of a sum, against sorting on one rank.

#include "refinement/BulkMarking.h"
#include "ParallelTest.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <random>

namespace cadrefine
{

namespace
{

struct Items
{
  std::vector<double> values;
  std::vector<std::int64_t> ids;
};

/// Ids that are not in the order of the values.
Items numbered(std::vector<double> values, std::mt19937_64& random)
{
  std::vector<std::int64_t> ids(values.size());
  std::iota(ids.begin(), ids.end(), 0);
  std::shuffle(ids.begin(), ids.end(), random);
  for (std::int64_t& id : ids)
  {
    id = 1000000007 * id; // all bytes of an id
  }
  return { std::move(values), std::move(ids) };
}

/// Places in the order in which they are taken: largest first, of equal ones the smaller id.
std::vector<std::size_t> inOrder(const Items& items)
{
  std::vector<std::size_t> order(items.values.size());
  std::iota(order.begin(), order.end(), std::size_t{ 0 });
  std::sort(order.begin(), order.end(),
    [&](std::size_t a, std::size_t b)
    {
      return items.values[a] != items.values[b] ? items.values[a] > items.values[b]
                                                : items.ids[a] < items.ids[b];
    });
  return order;
}

/// By sorting; right where `Sum` holds all partial sums exactly.
template<class Sum>
std::vector<unsigned char> markBySorting(const Items& items, double fraction)
{
  const auto target = static_cast<double>(
    fraction *
    static_cast<double>(std::accumulate(items.values.begin(), items.values.end(), Sum{ 0 })));
  std::vector<unsigned char> marks(items.values.size());
  Sum sum = 0;
  for (const std::size_t i : inOrder(items))
  {
    if (static_cast<double>(sum) >= target)
    {
      break;
    }
    marks[i] = 1;
    sum += static_cast<Sum>(items.values[i]);
  }
  return marks;
}

class BulkMarking : public ParallelTest
{
protected:
  using Dealer = std::function<int(std::size_t)>;

  /// The marks of all items, with each item on the rank that `rankOf` says.
  std::vector<unsigned char> mark(const Items& items, double fraction, const Dealer& rankOf)
  {
    Items mine;
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < items.values.size(); ++i)
    {
      if (rankOf(i) == exchange.rank())
      {
        mine.values.push_back(items.values[i]);
        mine.ids.push_back(items.ids[i]);
        places.push_back(i);
      }
    }
    const auto marks = markBulk(exchange, mine.values, mine.ids, fraction);
    EXPECT_EQ(marks.size(), places.size());
    std::vector<std::int64_t> all(items.values.size(), 0);
    for (std::size_t i = 0; i < places.size(); ++i)
    {
      all[places[i]] = marks[i];
    }
    all = exchange.sum(all);
    return { all.begin(), all.end() };
  }

  std::vector<unsigned char> markInBlocks(const Items& items, double fraction)
  {
    const std::size_t block = items.values.size() / exchange.size() + 1;
    return mark(items, fraction, [&](std::size_t i) { return static_cast<int>(i / block); });
  }

  /// However the items are dealt out, also to one rank only.
  void expectMarks(const Items& items, double fraction, const std::vector<unsigned char>& expected)
  {
    EXPECT_EQ(markInBlocks(items, fraction), expected) << fraction;
    const int last = exchange.size() - 1;
    EXPECT_EQ(mark(items, fraction, [&](std::size_t) { return last; }), expected) << fraction;
    std::vector<int> ranks(items.values.size());
    std::uniform_int_distribution<int> anyRank(0, last);
    std::generate(ranks.begin(), ranks.end(), [&] { return anyRank(commonRandom); });
    EXPECT_EQ(mark(items, fraction, [&](std::size_t i) { return ranks[i]; }), expected) << fraction;
  }
};

std::size_t countMarks(const std::vector<unsigned char>& marks)
{
  return static_cast<std::size_t>(std::count(marks.begin(), marks.end(), 1));
}

TEST_F(BulkMarking, isThatOfSortingForIntegers)
{
  for (const int largest : { 1, 3, 1000, 1 << 30 })
  {
    std::uniform_int_distribution<int> any(0, largest);
    std::vector<double> values(500);
    std::generate(values.begin(), values.end(), [&] { return any(commonRandom); });
    const Items items = numbered(values, commonRandom);
    for (const double fraction : { 1e-9, 0.001, 0.25, 0.5, 0.75, 0.999, 1.0 })
    {
      expectMarks(items, fraction, markBySorting<double>(items, fraction));
    }
  }
}

/// Doubles with 53 random bits over 40 orders of magnitude. Sorting adds in 64 bits of mantissa
/// (or more): fractions of which the target is no near miss agree.
TEST_F(BulkMarking, isThatOfSortingForDoubles)
{
  std::uniform_real_distribution<double> magnitude(-40, 0);
  std::vector<double> values(2000);
  std::generate(
    values.begin(), values.end(), [&] { return std::pow(10.0, magnitude(commonRandom)); });
  const Items items = numbered(values, commonRandom);
  for (const double fraction : { 1e-30, 1e-6, 0.1, 0.5, 0.9, 0.999999 })
  {
    expectMarks(items, fraction, markBySorting<long double>(items, fraction));
  }
}

/// By their definition: they carry the part, and do not without any one of them.
TEST_F(BulkMarking, areEnoughAndNoneToSpare)
{
  std::exponential_distribution<double> any(1);
  std::vector<double> values(1000);
  std::generate(values.begin(), values.end(), [&] { return std::ldexp(any(commonRandom), 20); });
  for (double& value : values)
  {
    value = std::round(value); // sums are exact
  }
  const Items items = numbered(values, commonRandom);
  const double whole = std::accumulate(values.begin(), values.end(), 0.0);
  for (const double fraction : { 0.01, 0.3, 0.5, 0.8, 0.99 })
  {
    const auto marks = markInBlocks(items, fraction);
    double carried = 0;
    double smallest = whole;
    double largestLeft = 0;
    for (std::size_t i = 0; i < marks.size(); ++i)
    {
      carried += marks[i] ? values[i] : 0;
      smallest = marks[i] ? std::min(smallest, values[i]) : smallest;
      largestLeft = marks[i] ? largestLeft : std::max(largestLeft, values[i]);
    }
    EXPECT_GE(carried, fraction * whole);
    EXPECT_LT(carried - smallest, fraction * whole);
    EXPECT_LE(largestLeft, smallest);
  }
}

TEST_F(BulkMarking, takesSmallerIdsOfEqualValues)
{
  const std::size_t count = 300;
  const Items items = numbered(std::vector<double>(count, 0.1), commonRandom);
  const auto marks = markInBlocks(items, 0.25);
  EXPECT_EQ(countMarks(marks), count / 4);
  for (std::size_t i = 0; i < count; ++i)
  {
    EXPECT_EQ(marks[i], items.ids[i] < 1000000007 * static_cast<std::int64_t>(count / 4));
  }
  expectMarks(items, 0.25, marks);
}

TEST_F(BulkMarking, takesTheLargestIds)
{
  const auto largest = std::numeric_limits<std::int64_t>::max();
  const Items items{ { 1, 1, 1, 1 }, { largest, 0, largest - 1, 1 } };
  expectMarks(items, 0.5, { 0, 1, 0, 1 });
  expectMarks(items, 0.75, { 0, 1, 1, 1 });
}

TEST_F(BulkMarking, ofEverythingLeavesZerosOut)
{
  const Items items = numbered({ 0, 5, -0.0, 1, 0, 7, -0.0, 1 }, commonRandom);
  expectMarks(items, 1, { 0, 1, 0, 1, 0, 1, 0, 1 });
}

TEST_F(BulkMarking, ofNothingMarksNothing)
{
  expectMarks(numbered({ 0, -0.0, 0, 0 }, commonRandom), 0.5, { 0, 0, 0, 0 });
  expectMarks({}, 0.5, {});
}

TEST_F(BulkMarking, ofATinyPartIsTheLargest)
{
  const Items items = numbered({ 2, 3, 1, 3.5, 2 }, commonRandom);
  for (const double fraction : { 0.1, 1e-20, std::numeric_limits<double>::denorm_min() })
  {
    expectMarks(items, fraction, { 0, 0, 0, 1, 0 });
  }
}

/// Neither overflow nor underflow.
TEST_F(BulkMarking, takesTheSmallestAndTheLargestDoubles)
{
  const double least = std::numeric_limits<double>::denorm_min();
  const double most = std::numeric_limits<double>::max();
  const Items small{ { least, 3 * least, 2 * least, 0 }, { 0, 1, 2, 3 } };
  expectMarks(small, 0.25, { 0, 1, 0, 0 });
  expectMarks(small, 0.75, { 0, 1, 1, 0 });
  expectMarks(small, 1, { 1, 1, 1, 0 });
  const Items large{ { most, most, most, most }, { 0, 1, 2, 3 } };
  expectMarks(large, 0.5, { 1, 1, 0, 0 });
  expectMarks(large, 1, { 1, 1, 1, 1 });
  const Items both{ { least, most, least }, { 0, 1, 2 } };
  expectMarks(both, 0.5, { 0, 1, 0 });
  expectMarks(both, 1, { 0, 1, 0 });
}

/// What is below the rounding of the sum is left out, whoever has it.
TEST_F(BulkMarking, isTheSameWhereSumsAreRounded)
{
  std::vector<double> values(64, 0.1);
  values.resize(256, 0x1p-58);
  const Items items = numbered(values, commonRandom);
  for (const double fraction : { 0.3, 0.9, 1.0 })
  {
    expectMarks(items, fraction, markInBlocks(items, fraction));
  }
  EXPECT_EQ(countMarks(markInBlocks(items, 0.99)), 64u);
}

} // namespace

} // namespace cadrefine
