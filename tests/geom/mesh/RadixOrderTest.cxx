#include <cadrefine/base/RadixOrder.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace
{

using namespace cadrefine;

std::vector<PlacedKey> placed(const std::vector<std::uint64_t>& keys)
{
  std::vector<PlacedKey> result;
  for (const std::uint64_t key : keys)
  {
    result.push_back({ key, static_cast<std::uint32_t>(result.size()) });
  }
  return result;
}

void expectSortedLike(const std::vector<std::uint64_t>& keys)
{
  auto expected = placed(keys);
  std::stable_sort(expected.begin(), expected.end(),
    [](const PlacedKey& a, const PlacedKey& b) { return a.key < b.key; });
  auto sorted = placed(keys);
  radixSort(sorted);
  ASSERT_EQ(sorted.size(), expected.size());
  for (std::size_t i = 0; i < sorted.size(); ++i)
  {
    EXPECT_EQ(sorted[i].key, expected[i].key) << i;
    EXPECT_EQ(sorted[i].place, expected[i].place) << i;
  }
}

TEST(RadixSort, sortsNumbersOfAllSizesAndKeepsEqualOnesInOrder)
{
  std::mt19937_64 random(1);
  for (const int bits : { 1, 5, 11, 12, 23, 40, 55, 64 })
  {
    std::vector<std::uint64_t> keys(500);
    for (std::uint64_t& key : keys)
    {
      key = random() >> (64 - bits);
    }
    expectSortedLike(keys);
  }
}

TEST(RadixSort, takesNoneOneAndSortedKeys)
{
  expectSortedLike({});
  expectSortedLike({ 7 });
  expectSortedLike({ 1, 1, 2, std::numeric_limits<std::uint64_t>::max() });
  expectSortedLike({ std::numeric_limits<std::uint64_t>::max(), 0 });
}

TEST(OrderedBits, orderLikeTheNumbers)
{
  const std::vector<std::int64_t> numbers{ std::numeric_limits<std::int64_t>::min(), -5, -1, 0, 1,
    9, std::numeric_limits<std::int64_t>::max() };
  for (std::size_t i = 0; i + 1 < numbers.size(); ++i)
  {
    EXPECT_LT(orderedBits(numbers[i]), orderedBits(numbers[i + 1]));
  }
}

} // namespace
