// Numbers and offsets, compared with those of one rank that has all keys.
#include "ParallelTest.h"

#include "comm/GlobalNumbering.h"

#include <cadrefine/base/Error.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace cadrefine
{

namespace
{

enum class Spread
{
  even,
  skewed,   // nearly all keys are on the last rank
  oneValue, // all keys are equal
  nothing,
};

class GlobalNumberingTest : public ParallelTest
{
protected:
  // All ranks' keys, the same on all ranks; keys[r] are those of rank r.
  template<std::size_t K>
  std::vector<std::vector<Key<K>>> randomKeys(Spread spread, std::int64_t range, int count)
  {
    // The first entries repeat, so that the others decide too.
    std::uniform_int_distribution<std::int64_t> first(-3, 3);
    std::uniform_int_distribution<std::int64_t> entry(-range, range);
    const std::size_t size = static_cast<std::size_t>(exchange.size());
    std::vector<std::vector<Key<K>>> keys(size);
    for (int i = 0; i < count && spread != Spread::nothing; ++i)
    {
      Key<K> key;
      for (std::int64_t& value : key)
      {
        value = spread == Spread::oneValue ? 5 : entry(commonRandom);
      }
      if (K > 1 && spread == Spread::even)
      {
        key[0] = first(commonRandom);
      }
      const bool toLast = spread == Spread::skewed && i % 50 != 0;
      keys[toLast ? size - 1 : commonRandom() % size].push_back(key);
    }
    return keys;
  }

  template<std::size_t K>
  void checkNumbers(Spread spread, std::int64_t range, int count)
  {
    const auto keys = randomKeys<K>(spread, range, count);
    std::map<Key<K>, GlobalId> numbers;
    for (const auto& list : keys)
    {
      for (const Key<K>& key : list)
      {
        numbers[key] = 0;
      }
    }
    GlobalId next = 0;
    for (auto& entry : numbers)
    {
      entry.second = next++;
    }

    const auto& mine = keys[static_cast<std::size_t>(exchange.rank())];
    const Numbering result = numberDistinct<K>(exchange, mine);
    EXPECT_EQ(result.count, next);
    std::vector<GlobalId> expected;
    for (const Key<K>& key : mine)
    {
      expected.push_back(numbers.at(key));
    }
    EXPECT_EQ(result.numbers, expected);
  }

  template<std::size_t K>
  void checkAllSpreads()
  {
    for (const Spread spread : { Spread::even, Spread::skewed, Spread::oneValue, Spread::nothing })
    {
      for (const int count : { 1, 10, 3000 })
      {
        checkNumbers<K>(spread, 3, count);
        checkNumbers<K>(spread, std::int64_t{ 1 } << 62, count);
      }
    }
  }

  template<std::size_t K>
  void checkOffsets(Spread spread, int count)
  {
    auto keys = randomKeys<K>(spread, 1000000, count);
    std::map<Key<K>, std::int64_t> weights; // and dropped where a key has come before
    for (auto& list : keys)
    {
      const auto isRepeated = [&](const Key<K>& key)
      { return !weights.emplace(key, static_cast<std::int64_t>(commonRandom() % 10)).second; };
      list.erase(std::remove_if(list.begin(), list.end(), isRepeated), list.end());
    }
    const auto& mine = keys[static_cast<std::size_t>(exchange.rank())];
    std::vector<std::int64_t> myWeights;
    for (const Key<K>& key : mine)
    {
      myWeights.push_back(weights.at(key));
    }
    const Numbering result = offsets<K>(exchange, mine, myWeights);

    std::int64_t before = 0;
    std::map<Key<K>, std::int64_t> sums;
    for (const auto& [key, weight] : weights)
    {
      sums[key] = before;
      before += weight;
    }
    std::vector<GlobalId> expected;
    for (const Key<K>& key : mine)
    {
      expected.push_back(sums.at(key));
    }
    EXPECT_EQ(result.numbers, expected);
    EXPECT_EQ(result.count, before);
  }
};

TEST_F(GlobalNumberingTest, numberKeysOfOneEntry)
{
  checkAllSpreads<1>();
}

TEST_F(GlobalNumberingTest, numberKeysOfTwoEntries)
{
  checkAllSpreads<2>();
}

TEST_F(GlobalNumberingTest, numberKeysOfThreeEntries)
{
  checkAllSpreads<3>();
}

TEST_F(GlobalNumberingTest, numberKeysOfFourEntries)
{
  checkAllSpreads<4>();
}

TEST_F(GlobalNumberingTest, sumWeights)
{
  for (const Spread spread : { Spread::even, Spread::skewed, Spread::nothing })
  {
    checkOffsets<1>(spread, 2000);
    checkOffsets<2>(spread, 2000);
    checkOffsets<3>(spread, 2000);
    checkOffsets<4>(spread, 20);
  }
}

TEST_F(GlobalNumberingTest, sumWeightsOfDenseAndSparseNumbers)
{
  const GlobalId largest = std::numeric_limits<GlobalId>::max();
  for (const GlobalId step : { GlobalId{ 1 }, GlobalId{ 3 }, GlobalId{ 1000 }, largest / 1000 })
  {
    for (const GlobalId first : { GlobalId{ 0 }, GlobalId{ -700 }, 1 - step * 500 })
    {
      std::vector<GlobalId> numbers;
      std::vector<Key<1>> keys;
      std::vector<Index> weights;
      for (GlobalId i = 999; i >= 0; --i)
      {
        const auto weight = static_cast<Index>(commonRandom() % 9);
        if (static_cast<int>(commonRandom() % static_cast<std::size_t>(exchange.size())) ==
            exchange.rank())
        {
          numbers.push_back(first + step * i);
          keys.push_back({ numbers.back() });
          weights.push_back(weight);
        }
      }
      const Numbering expected = offsets<1>(exchange, keys, { weights.begin(), weights.end() });
      const Numbering result = denseOffsets(exchange, numbers, weights);
      EXPECT_EQ(result.numbers, expected.numbers);
      EXPECT_EQ(result.count, expected.count);
    }
  }
  EXPECT_EQ(denseOffsets(exchange, {}, {}).count, 0);
}

TEST_F(GlobalNumberingTest, refuseRepeatedDenseNumbersOnAllRanks)
{
  const bool last = exchange.rank() == exchange.size() - 1;
  const auto twiceHere = last ? std::vector<GlobalId>{ 7, 8, 7 } : std::vector<GlobalId>{};
  EXPECT_THROW(denseOffsets(exchange, twiceHere, std::vector<Index>(twiceHere.size(), 1)), Error);
  EXPECT_THROW(denseOffsets(exchange, { exchange.rank() },
                 last ? std::vector<Index>() : std::vector<Index>{ 1 }),
    Error);
}

TEST_F(GlobalNumberingTest, refuseRepeatedKeysOnAllRanks)
{
  const bool last = exchange.rank() == exchange.size() - 1;
  const auto twiceHere = last ? std::vector<Key<1>>{ { 7 }, { 7 } } : std::vector<Key<1>>{};
  EXPECT_THROW(
    offsets<1>(exchange, twiceHere, std::vector<std::int64_t>(twiceHere.size(), 1)), Error);
  EXPECT_THROW(offsets<1>(exchange, { { exchange.rank() } },
                 last ? std::vector<std::int64_t>() : std::vector<std::int64_t>{ 1 }),
    Error);
  if (exchange.size() > 1)
  {
    EXPECT_THROW(offsets<1>(exchange, { { 7 } }, { 1 }), Error);
  }
}

// Stretches of numbers, of which each rank has every so many, cost as many bytes however long they
// are.
TEST_F(GlobalNumberingTest, sendRunsOfDenseNumbersAsOne)
{
  std::vector<std::int64_t> bytes;
  for (const GlobalId length : { 10, 1000 })
  {
    std::vector<GlobalId> numbers;
    for (GlobalId stretch = exchange.rank(); stretch < 30; stretch += exchange.size())
    {
      for (GlobalId i = 0; i < length; ++i)
      {
        numbers.push_back(stretch * length + i);
      }
    }
    std::vector<Index> weights(numbers.size());
    std::transform(numbers.begin(), numbers.end(), weights.begin(),
      [](GlobalId n) { return static_cast<Index>(n % 3); });
    const std::int64_t before = exchange.bytesSent();
    const Numbering result = denseOffsets(exchange, numbers, weights);
    bytes.push_back(exchange.bytesSent() - before);
    for (std::size_t i = 0; i < numbers.size(); ++i)
    {
      EXPECT_EQ(result.numbers[i], numbers[i] / 3 * 3 + (numbers[i] % 3 == 2 ? 1 : 0));
    }
  }
  EXPECT_EQ(bytes[0], bytes[1]);
}

TEST_F(GlobalNumberingTest, refuseRunsThatOverlap)
{
  const bool last = exchange.rank() == exchange.size() - 1;
  const auto numbers = last ? std::vector<GlobalId>{ 1, 2, 3, 2, 3, 4 } : std::vector<GlobalId>{};
  EXPECT_THROW(denseOffsets(exchange, numbers, std::vector<Index>(numbers.size(), 1)), Error);
}

// Each rank gets about its share, though all keys were on one.
TEST_F(GlobalNumberingTest, spreadTheWork)
{
  const int count = 20000;
  std::vector<Key<2>> mine;
  for (int i = 0; i < count && exchange.rank() == exchange.size() - 1; ++i)
  {
    mine.push_back({ i / 7, i });
  }
  const std::int64_t before = exchange.bytesSent();
  numberDistinct<2>(exchange, mine);
  if (exchange.rank() < exchange.size() - 1)
  {
    // Numbers sent back, and splitters.
    const std::int64_t numbersSent = (exchange.bytesSent() - before) / 8;
    EXPECT_LT(numbersSent, 2 * count / exchange.size() + 100);
    EXPECT_GT(numbersSent, count / exchange.size() / 2);
  }
}

TEST_F(GlobalNumberingTest, orderCoordinates)
{
  const double inf = INFINITY;
  const double least = std::numeric_limits<double>::denorm_min();
  const std::vector<double> ascending = { -inf, -1e300, -2.0, -1.0, -1e-300, -least, 0.0, least,
    1e-300, 1.0, std::nextafter(1.0, 2.0), 1e300, inf };
  for (std::size_t i = 1; i < ascending.size(); ++i)
  {
    EXPECT_LT(coordinateKey(ascending[i - 1]), coordinateKey(ascending[i]));
  }
  EXPECT_EQ(coordinateKey(-0.0), coordinateKey(0.0));
  EXPECT_EQ(coordinateKey(Point3{ -0.0, 1, 2 }), coordinateKey(Point3{ 0.0, 1, 2 }));
  EXPECT_LT(coordinateKey(Point3{ 0, 1, 2 }), coordinateKey(Point3{ 0, 1, 3 }));
}

} // namespace

} // namespace cadrefine
