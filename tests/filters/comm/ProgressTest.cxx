// How far a run is.
#include "ParallelTest.h"

#include "comm/LoadBalancedMap.h"

#include <numeric>
#include <utility>

namespace cadrefine
{

namespace
{

using Said = std::vector<std::pair<double, std::string>>;

class ProgressTest : public ParallelTest
{
protected:
  void SetUp() override
  {
    exchange.progress().tell(
      [this](double fraction, const std::string& text) { said.emplace_back(fraction, text); });
  }
  void TearDown() override { exchange.progress().tell(nullptr); }

  Said said;
};

TEST_F(ProgressTest, partsHaveTheirShareAndTheirName)
{
  Progress& progress = exchange.progress();
  progress.say(0.25, "first");
  {
    const Progress::Part step(progress, 0.5, 1, "Step 2: ");
    progress.say(0.5, "marking");
    const Progress::Part half(progress, 0.5, 1, "level 1: ");
    progress.say(1, "cutting");
    progress.say(7, "too far");
  }
  progress.say(1, "last");
  EXPECT_EQ(
    said, (Said{ { 0.25, "first" }, { 0.75, "Step 2: marking" }, { 1, "Step 2: level 1: cutting" },
            { 1, "Step 2: level 1: too far" }, { 1, "last" } }));
}

TEST_F(ProgressTest, numbersAreReadable)
{
  Progress& progress = exchange.progress();
  progress.count({ "projecting", "vertices" }, 1200000, 4000000);
  progress.count({ "projecting", "vertices" }, 0, 999);
  progress.count({ "projecting", "vertices" }, 12345, 999999);
  progress.count({ "projecting", "vertices" }, 0, 0);
  ASSERT_EQ(said.size(), 3u);
  EXPECT_EQ(said[0].second, "projecting 1.2 of 4.0 million vertices");
  EXPECT_DOUBLE_EQ(said[0].first, 0.3);
  EXPECT_EQ(said[1].second, "projecting 0 of 999 vertices");
  EXPECT_EQ(said[2].second, "projecting 12,345 of 999,999 vertices");
}

TEST_F(ProgressTest, workIsCountedAndAllDoneOnce)
{
  std::vector<int> queries(10000 + exchange.rank());
  std::iota(queries.begin(), queries.end(), 0);
  const auto answers =
    mapBalanced<int>(exchange, queries, [](int query) { return query; }, { "asking", "queries" });
  EXPECT_EQ(answers.values, queries);
  const std::int64_t total = exchange.sum(queries.size());
  ASSERT_GE(said.size(), 2u);
  EXPECT_EQ(said[0].second.rfind("asking 0 of ", 0), 0u) << said[0].second;
  EXPECT_EQ(said[0].first, 0);
  EXPECT_NEAR(said[1].first, 4096.0 * exchange.size() / static_cast<double>(total), 0.01);

  exchange.progress().tell(nullptr);
  const std::size_t before = said.size();
  EXPECT_EQ(
    mapBalanced<int>(exchange, queries, [](int query) { return query; }, { "asking", "queries" })
      .values,
    queries);
  EXPECT_EQ(said.size(), before);
}

} // namespace

} // namespace cadrefine
