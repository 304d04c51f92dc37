// Messages and reductions.
#include "ParallelTest.h"

#include <cadrefine/base/Error.h>
#include <cadrefine/base/SortUniquely.h>

#include <vtkDummyController.h>
#include <vtkNew.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cadrefine
{

namespace
{

class RankExchangeTest : public ParallelTest
{
protected:
  // The values that rank `from` sends to rank `to`; none for some pairs.
  static std::vector<double> letter(int from, int to)
  {
    std::vector<double> values(static_cast<std::size_t>((from * 5 + to * 3) % 7) * 10);
    std::iota(values.begin(), values.end(), 1000.0 * from + to);
    return values;
  }

  void checkAllToAll(RankExchange& tested)
  {
    std::vector<std::vector<double>> outgoing;
    outgoing.reserve(static_cast<std::size_t>(tested.size()));
    for (int to = 0; to < tested.size(); ++to)
    {
      outgoing.push_back(letter(tested.rank(), to));
    }
    const std::vector<std::vector<double>> incoming = tested.allToAll(outgoing);
    EXPECT_EQ(incoming.size(), outgoing.size());
    for (int from = 0; from < static_cast<int>(incoming.size()); ++from)
    {
      EXPECT_EQ(incoming[static_cast<std::size_t>(from)], letter(from, tested.rank()));
    }
  }
};

TEST_F(RankExchangeTest, gatherNumbersInTheOrderOfTheRanks)
{
  const double mine = exchange.rank() + 0.5;
  std::vector<double> expected;
  std::vector<std::int64_t> ranks;
  for (int r = 0; r < exchange.size(); ++r)
  {
    expected.insert(expected.end(), { r + 0.5, -1.0 });
    ranks.push_back(r);
  }
  EXPECT_EQ(exchange.gather({ mine, -1.0 }), expected);
  EXPECT_EQ(exchange.gather(std::int64_t{ exchange.rank() }), ranks);
  EXPECT_GE(exchange.seconds(), 0);
}

TEST_F(RankExchangeTest, workAloneWithoutAController)
{
  vtkNew<vtkDummyController> dummy;
  for (vtkMultiProcessController* controller :
    std::vector<vtkMultiProcessController*>{ nullptr, dummy })
  {
    RankExchange alone(controller);
    EXPECT_EQ(alone.rank(), 0);
    EXPECT_EQ(alone.size(), 1);
    EXPECT_TRUE(alone.any(true));
    EXPECT_FALSE(alone.any(false));
    EXPECT_EQ(alone.sum(3), 3);
    EXPECT_EQ(alone.min(-0.5), -0.5);
    EXPECT_EQ(alone.sumBefore(4), 0);
    EXPECT_EQ(alone.sumReproducibly({ 1.0, 2.5 }), 3.5);
    EXPECT_EQ(alone.broadcast({ 'a', 'b' }, 0), (std::vector<char>{ 'a', 'b' }));
    EXPECT_EQ(alone.allToAll<int>({ { 1, 2 } }), (std::vector<std::vector<int>>{ { 1, 2 } }));
    EXPECT_EQ(alone.exchange<int>({}, {}), std::vector<std::vector<int>>());
    EXPECT_THROW(alone.agree("reason"), Error);
    EXPECT_EQ(alone.messagesSent(), 0);
    EXPECT_EQ(alone.bytesSent(), 0);
  }
}

TEST_F(RankExchangeTest, reduceNumbers)
{
  const int rank = exchange.rank();
  const std::int64_t size = exchange.size();
  EXPECT_EQ(exchange.sum(rank + 1), size * (size + 1) / 2);
  EXPECT_EQ(exchange.sumBefore(rank + 1), std::int64_t{ rank } * (rank + 1) / 2);
  EXPECT_EQ(exchange.min(-rank), 1 - size);
  EXPECT_EQ(exchange.max(std::int64_t{ 1 } << (40 + rank)), std::int64_t{ 1 } << (39 + size));
  EXPECT_EQ(exchange.max(0.5 * rank), 0.5 * static_cast<double>(size - 1));
  EXPECT_EQ(exchange.sum(std::vector<std::int64_t>{ 1, rank }),
    (std::vector<std::int64_t>{ size, size * (size - 1) / 2 }));
  EXPECT_EQ(exchange.min(std::vector<double>{ 1.0 * rank, 2.0 }), (std::vector<double>{ 0, 2 }));
  EXPECT_EQ(exchange.any(rank == size - 1), true);
  EXPECT_EQ(exchange.any(rank == size), false);
}

TEST_F(RankExchangeTest, minimumAndMaximumHandDownNan)
{
  const bool last = exchange.rank() == exchange.size() - 1;
  const std::vector<double> mine = { last ? NAN : 1.0, 2.0, -0.0 };
  for (const std::vector<double>& reduced : { exchange.min(mine), exchange.max(mine) })
  {
    EXPECT_TRUE(std::isnan(reduced[0]));
    EXPECT_EQ(reduced[1], 2.0);
    EXPECT_FALSE(std::signbit(reduced[2]));
  }
  EXPECT_EQ(exchange.max(-INFINITY), -INFINITY);
}

TEST_F(RankExchangeTest, agreeOnTheErrorOfTheLowestRank)
{
  exchange.agree("");
  const int firstToFail = exchange.size() / 2;
  std::string caught;
  try
  {
    exchange.agree(exchange.rank() >= firstToFail ? "rank " + std::to_string(exchange.rank()) : "");
  }
  catch (const Error& error)
  {
    caught = error.what();
  }
  EXPECT_EQ(caught, "rank " + std::to_string(firstToFail));
}

TEST_F(RankExchangeTest, sumTheSameForEveryPartition)
{
  std::uniform_real_distribution<double> mantissa(-1, 1);
  std::uniform_int_distribution<int> exponent(-400, 300);
  std::vector<double> addends(2000);
  for (double& addend : addends)
  {
    addend = std::scalbn(mantissa(commonRandom), exponent(commonRandom));
  }
  const double expected = RankExchange(nullptr).sumReproducibly(addends);
  for (int trial = 0; trial < 20; ++trial)
  {
    std::shuffle(addends.begin(), addends.end(), commonRandom);
    std::vector<double> mine;
    for (const double addend : addends)
    {
      if (static_cast<int>(commonRandom() % static_cast<unsigned>(exchange.size())) ==
          exchange.rank())
      {
        mine.push_back(addend);
      }
    }
    EXPECT_EQ(exchange.sumReproducibly(mine), expected);
  }
}

TEST_F(RankExchangeTest, sumNothingAndWhatIsNoNumber)
{
  EXPECT_EQ(exchange.sumReproducibly({}), 0.0);
  EXPECT_EQ(exchange.sumReproducibly({ -0.0, 0.0 }), 0.0);
  const bool last = exchange.rank() == exchange.size() - 1;
  EXPECT_TRUE(std::isnan(exchange.sumReproducibly({ last ? NAN : 1.0 })));
  EXPECT_TRUE(std::isnan(exchange.sumReproducibly({ last ? INFINITY : 1.0 })));
  EXPECT_EQ(
    exchange.sumReproducibly(last ? std::vector<double>{ 0.25 } : std::vector<double>{}), 0.25);
}

TEST_F(RankExchangeTest, sendFromAllToAll)
{
  checkAllToAll(exchange);
}

TEST_F(RankExchangeTest, sendLongMessagesInParts)
{
  RankExchange shortMessages(worldController(), 64);
  checkAllToAll(shortMessages);
  std::vector<char> text(1000);
  std::iota(text.begin(), text.end(), '\0');
  const int root = shortMessages.size() - 1;
  EXPECT_EQ(
    shortMessages.broadcast(shortMessages.rank() == root ? text : std::vector<char>(), root), text);
  EXPECT_THROW(RankExchange(nullptr, 8), Error);
}

TEST_F(RankExchangeTest, exchangeWithNeighboursOnly)
{
  std::vector<int> neighbours; // on a ring
  for (const int step : { exchange.size() - 1, 1 })
  {
    neighbours.push_back((exchange.rank() + step) % exchange.size());
  }
  sortUniquely(neighbours);

  std::vector<std::vector<double>> outgoing;
  outgoing.reserve(neighbours.size());
  for (const int to : neighbours)
  {
    outgoing.push_back(letter(exchange.rank(), to));
  }
  const std::int64_t before = exchange.messagesSent();
  for (int round = 0; round < 10; ++round)
  {
    const auto incoming = exchange.exchange(neighbours, outgoing);
    EXPECT_EQ(incoming.size(), neighbours.size());
    for (std::size_t n = 0; n < incoming.size(); ++n)
    {
      EXPECT_EQ(incoming[n], letter(neighbours[n], exchange.rank()));
    }
  }
  const std::int64_t others = exchange.size() == 1 ? 0 : static_cast<int>(neighbours.size());
  EXPECT_EQ(exchange.messagesSent() - before, 10 * others);
}

TEST_F(RankExchangeTest, sendStructuresAndNothing)
{
  struct Plain
  {
    char kind;
    double value;
  };
  std::vector<std::vector<Plain>> outgoing(static_cast<std::size_t>(exchange.size()));
  for (std::vector<Plain>& list : outgoing)
  {
    list.push_back({ 'x', 0.5 * exchange.rank() });
  }
  const auto incoming = exchange.allToAll(outgoing);
  for (int from = 0; from < exchange.size(); ++from)
  {
    const std::vector<Plain>& list = incoming[static_cast<std::size_t>(from)];
    EXPECT_EQ(list.size(), 1u);
    EXPECT_EQ(list.front().value, 0.5 * from);
  }
  const std::int64_t before = exchange.messagesSent();
  exchange.allToAll(std::vector<std::vector<int>>(static_cast<std::size_t>(exchange.size())));
  EXPECT_EQ(exchange.messagesSent(), before);
  EXPECT_THROW(
    exchange.allToAll(std::vector<std::vector<int>>(static_cast<std::size_t>(exchange.size() + 1))),
    Error);
}

TEST_F(RankExchangeTest, broadcastFromEachRank)
{
  for (int root = 0; root < exchange.size(); ++root)
  {
    const std::vector<char> expected(static_cast<std::size_t>(root) * 3, 'b');
    const std::vector<char> mine = exchange.rank() == root ? expected : std::vector<char>(5, 'x');
    EXPECT_EQ(exchange.broadcast(mine, root), expected);
  }
}

} // namespace

} // namespace cadrefine
