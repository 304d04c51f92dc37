// Threads, and work shared out evenly.
#include "ParallelTest.h"

#include "comm/LoadBalancedMap.h"

#include <cadrefine/base/Error.h>

#include <vtkSMPTools.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <numeric>
#include <sched.h>
#include <set>
#include <string>
#include <thread>

namespace cadrefine
{

namespace
{

class EvenWorkTest : public ParallelTest
{
protected:
  // Queries of this rank: consecutive numbers, `count` of them.
  std::vector<std::int64_t> queries(std::size_t count)
  {
    std::vector<std::int64_t> result(count);
    std::iota(result.begin(), result.end(), 1000000 * std::int64_t{ exchange.rank() });
    return result;
  }

  // Every rank asks `count` queries: all are answered, in order, and no rank answers more than
  // its share.
  void checkSquares(std::size_t count)
  {
    std::atomic<std::int64_t> answeredHere{ 0 };
    const auto mine = queries(count);
    const auto answers = mapBalanced<double>(exchange, mine,
      [&](std::int64_t query)
      {
        ++answeredHere;
        return 0.5 * static_cast<double>(query);
      });
    std::vector<double> expected(mine.size());
    std::transform(mine.begin(), mine.end(), expected.begin(),
      [](std::int64_t query) { return 0.5 * static_cast<double>(query); });
    EXPECT_EQ(answers.values, expected);

    const std::int64_t total = exchange.sum(count);
    const std::int64_t largest = exchange.max(static_cast<std::int64_t>(count));
    const std::int64_t answeredMost = exchange.max(answeredHere.load());
    const auto mean = static_cast<double>(total) / exchange.size();
    EXPECT_EQ(answers.balance.total, total);
    EXPECT_EQ(exchange.sum(answeredHere.load()), total);
    EXPECT_LE(answeredMost, (total + exchange.size() - 1) / exchange.size());
    EXPECT_DOUBLE_EQ(answers.balance.before, total > 0 ? static_cast<double>(largest) / mean : 1);
    EXPECT_DOUBLE_EQ(
      answers.balance.after, total > 0 ? static_cast<double>(answeredMost) / mean : 1);
  }
};

TEST_F(EvenWorkTest, nothingToDo)
{
  checkSquares(0);
}

TEST_F(EvenWorkTest, evenAlready)
{
  checkSquares(1000);
  EXPECT_EQ(exchange.messagesSent(), 0);
}

TEST_F(EvenWorkTest, allOnOneRank)
{
  for (int loaded = 0; loaded < exchange.size(); ++loaded)
  {
    checkSquares(exchange.rank() == loaded ? 1001 : 0);
  }
}

TEST_F(EvenWorkTest, anyDistribution)
{
  for (int round = 0; round < 20; ++round)
  {
    checkSquares(ownRandom() % (round % 2 == 0 ? 3 : 3000));
  }
}

TEST_F(EvenWorkTest, messagesAreFewerThanTwiceTheRanksEachWay)
{
  checkSquares(100 * static_cast<std::size_t>(exchange.size() - exchange.rank()));
  EXPECT_LT(exchange.sum(exchange.messagesSent()), 4 * exchange.size());
}

TEST_F(EvenWorkTest, aFailureOnOneRankIsOneOnAll)
{
  const auto mine = queries(exchange.rank() == exchange.size() - 1 ? 500 : 0);
  const auto failing = [&](std::int64_t query) -> double
  {
    if (query % 1000 == 3)
    {
      throw Error("query 3 has no answer");
    }
    return 0;
  };
  EXPECT_THROW(mapBalanced<double>(exchange, mine, failing), Error);
}

class ThreadsTest : public ParallelTest
{
protected:
  void SetUp() override
  {
    forgetTheUsersSettings();
    ASSERT_EQ(sched_getaffinity(0, sizeof(allCores), &allCores), 0);
  }

  void TearDown() override
  {
    forgetTheUsersSettings();
    EXPECT_EQ(sched_setaffinity(0, sizeof(allCores), &allCores), 0);
    ParallelTest::TearDown();
  }

  static void forgetTheUsersSettings()
  {
    unsetenv("VTK_SMP_BACKEND_IN_USE");
    unsetenv("VTK_SMP_MAX_THREADS");
  }

  // To one of the cores that this rank may run on.
  void bindToOneCore()
  {
    int core = 0;
    while (!CPU_ISSET(core, &allCores))
    {
      ++core;
    }
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(core, &one);
    EXPECT_EQ(sched_setaffinity(0, sizeof(one), &one), 0);
  }

  cpu_set_t allCores; // as this rank was bound before the test
};

TEST_F(ThreadsTest, ranksShareTheirCores)
{
  const int threads = findThreads(exchange);
  const int cores = CPU_COUNT(&allCores);
  EXPECT_GE(threads, std::max(1, cores / exchange.size()));
  EXPECT_LE(threads, cores);
}

TEST_F(ThreadsTest, noMoreThreadsThanCoresARankIsBoundTo)
{
  bindToOneCore();
  EXPECT_EQ(findThreads(exchange), 1);
}

TEST_F(ThreadsTest, aRankBoundElsewhereTakesNoShare)
{
  const bool elsewhere = exchange.rank() == 0;
  if (elsewhere)
  {
    bindToOneCore();
  }
  const int threads = findThreads(exchange);
  const int others = std::max(1, exchange.size() - 1);
  EXPECT_GE(threads, elsewhere ? 1 : std::max(1, CPU_COUNT(&allCores) / others));
  EXPECT_LE(threads, elsewhere ? 1 : CPU_COUNT(&allCores));
}

TEST_F(ThreadsTest, theUsersSettingsAreKept)
{
  setenv("VTK_SMP_MAX_THREADS", "1", 1);
  EXPECT_EQ(findThreads(exchange), 1);
  setenv("VTK_SMP_BACKEND_IN_USE", "Sequential", 1);
  EXPECT_EQ(findThreads(exchange), 0);
}

TEST_F(ThreadsTest, everyItemOnceInSeveralThreads)
{
  for (const int threads : { 0, 1, 2, 5 })
  {
    std::vector<int> visits(10007, 0);
    std::mutex mutex;
    std::set<std::thread::id> used;
    forOnThreads(threads)(visits.size(), coarseGrain,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t i = begin; i < end; ++i)
        {
          ++visits[i];
        }
        const std::lock_guard<std::mutex> lock(mutex);
        used.insert(std::this_thread::get_id());
      });
    EXPECT_EQ(visits, std::vector<int>(visits.size(), 1));
    EXPECT_LE(used.size(), static_cast<std::size_t>(std::max(1, threads)));
  }
  EXPECT_STREQ(vtkSMPTools::GetBackend(), "Sequential");
}

TEST_F(ThreadsTest, theCallerGetsAnExceptionOfAThread)
{
  const auto failing = [](std::size_t, std::size_t end)
  {
    if (end > 5000)
    {
      throw Error("too far");
    }
  };
  EXPECT_THROW(forOnThreads(2)(10000, coarseGrain, failing), Error);
}

TEST_F(ThreadsTest, ofSeveralExceptionsTheLowestRangesIsThrown)
{
  const auto failing = [](std::size_t begin, std::size_t end)
  {
    if (end > 5000)
    {
      throw Error(std::to_string(begin));
    }
  };
  constexpr std::size_t grain = 1000;
  for (const int threads : { 0, 2, 5 })
  {
    try
    {
      forOnThreads(threads)(20000, grain, failing);
      ADD_FAILURE() << "no exception";
    }
    catch (const Error& error)
    {
      EXPECT_STREQ(error.what(), "5000");
    }
  }
}

} // namespace

} // namespace cadrefine
