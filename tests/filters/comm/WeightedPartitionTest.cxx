// Sharing out weighted points.
#include "ParallelTest.h"

#include "balancing/WeightedPartition.h"

#include <algorithm>
#include <array>
#include <limits>

namespace cadrefine
{

namespace
{

class WeightedPartitionTest : public ParallelTest
{
protected:
  // `count` random points of the unit cube on this rank.
  std::vector<Point3> randomPoints(std::size_t count)
  {
    std::uniform_real_distribution<double> coordinate(0, 1);
    std::vector<Point3> points(count);
    for (Point3& point : points)
    {
      point = { coordinate(ownRandom), coordinate(ownRandom), coordinate(ownRandom) };
    }
    return points;
  }

  // Largest over mean of the weights that each rank would get.
  double imbalance(const std::vector<int>& ranks, const std::vector<std::int64_t>& weights)
  {
    std::vector<std::int64_t> sums(static_cast<std::size_t>(exchange.size()), 0);
    for (std::size_t i = 0; i < ranks.size(); ++i)
    {
      sums[static_cast<std::size_t>(ranks[i])] += weights[i];
    }
    sums = exchange.sum(sums);
    std::int64_t total = 0;
    for (const std::int64_t weight : sums)
    {
      total += weight;
    }
    return static_cast<double>(*std::max_element(sums.begin(), sums.end())) * exchange.size() /
           static_cast<double>(total);
  }
};

TEST_F(WeightedPartitionTest, weightsAreEvenWhereverThePointsWere)
{
  const bool loaded = exchange.rank() == exchange.size() - 1;
  const auto points = randomPoints(loaded ? 20000 : 10 * static_cast<std::size_t>(exchange.rank()));
  std::vector<std::int64_t> weights(points.size());
  std::transform(points.begin(), points.end(), weights.begin(),
    [](const Point3& point) { return point[0] < 0.1 ? 60 : 1; });
  const auto ranks = partitionByWeight(exchange, points, weights);
  EXPECT_EQ(ranks.size(), points.size());
  EXPECT_LE(imbalance(ranks, weights), 1.03);
}

TEST_F(WeightedPartitionTest, partsAreBoxes)
{
  const auto points = randomPoints(3000);
  const auto ranks =
    partitionByWeight(exchange, points, std::vector<std::int64_t>(points.size(), 1));
  const double infinity = std::numeric_limits<double>::infinity();
  std::vector<double> low(3 * static_cast<std::size_t>(exchange.size()), infinity);
  std::vector<double> high(low.size(), -infinity);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      const std::size_t bound = 3 * static_cast<std::size_t>(ranks[i]) + k;
      low[bound] = std::min(low[bound], points[i][k]);
      high[bound] = std::max(high[bound], points[i][k]);
    }
  }
  low = exchange.min(low);
  high = exchange.max(high);
  double volume = 0;
  for (std::size_t r = 0; r < low.size(); r += 3)
  {
    volume += (high[r] - low[r]) * (high[r + 1] - low[r + 1]) * (high[r + 2] - low[r + 2]);
  }
  EXPECT_LE(volume, 1.0); // they do not overlap
}

/// Fewer than ranks, in one place, with weights of any kind: Zoltan moves some, or none.
TEST_F(WeightedPartitionTest, fewPoints)
{
  const auto pick = [&](int count) { return static_cast<int>(commonRandom() % count); };
  for (int round = 0; round < 300; ++round)
  {
    const int places = 1 + pick(3);
    const int count = 1 + pick(6);
    std::vector<Point3> points;
    std::vector<std::int64_t> weights;
    for (int i = 0; i < count; ++i)
    {
      const Point3 point{ 0.5 * pick(places), 0.25 * pick(places), 1.0 * pick(places) };
      const std::int64_t weight = std::array{ 1000000, 0, 1, 2, 8 }[pick(5)];
      if (pick(exchange.size()) == exchange.rank())
      {
        points.push_back(point);
        weights.push_back(weight);
      }
    }
    const auto ranks = partitionByWeight(exchange, points, weights);
    EXPECT_EQ(ranks.size(), points.size());
    for (const int rank : ranks)
    {
      EXPECT_TRUE(rank >= 0 && rank < exchange.size()) << rank;
    }
  }
}

TEST_F(WeightedPartitionTest, nothingToShareOut)
{
  EXPECT_TRUE(partitionByWeight(exchange, {}, {}).empty());
}

} // namespace

} // namespace cadrefine
