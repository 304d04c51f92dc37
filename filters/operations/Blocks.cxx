#include "operations/Blocks.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace cadrefine
{
namespace
{

constexpr int levels = 20;

/// Finds the octant of the finest level that a point lies in, as three bits a level, the coarsest
/// first.
class Octants
{
public:
  Octants(const BoundingBox& box, int round)
  {
    constexpr double goldenRatio = 0.618033988749895; // its multiples spread evenly
    const double shift = (0.5 + goldenRatio * round) - std::floor(0.5 + goldenRatio * round);
    double extent = 0;
    for (int k = 0; k < 3; ++k)
    {
      extent = std::max(extent, box.high[k] - box.low[k]);
    }
    size_ = extent > 0 ? 2 * extent : 1;
    for (int k = 0; k < 3; ++k)
    {
      origin_[k] = box.low[k] - shift * 0.5 * size_;
    }
  }

  std::int64_t of(const Point3& point) const
  {
    std::int64_t octant = 0;
    std::array<std::int64_t, 3> steps{};
    for (int k = 0; k < 3; ++k)
    {
      constexpr auto count = static_cast<double>(std::int64_t{ 1 } << levels);
      steps[k] =
        static_cast<std::int64_t>(std::clamp((point[k] - origin_[k]) / size_, 0.0, 1.0) * count);
      steps[k] = std::min(steps[k], (std::int64_t{ 1 } << levels) - 1);
    }
    for (int bit = levels - 1; bit >= 0; --bit)
    {
      for (int k = 0; k < 3; ++k)
      {
        octant = 2 * octant + ((steps[k] >> bit) & 1);
      }
    }
    return octant;
  }

private:
  double size_ = 1;
  Point3 origin_{};
};

/// An octant of some level, by the first of the finest level in it.
struct Octant
{
  std::int64_t first;
  std::int64_t size;
};

} // namespace

Blocks findBlocks(RankExchange& exchange, const std::vector<Point3>& points, const BoundingBox& box,
  int round, std::int64_t largest)
{
  const Octants octants(box, round);
  std::vector<std::int64_t> places;
  places.reserve(points.size());
  for (const Point3& point : points)
  {
    places.push_back(octants.of(point));
  }
  std::vector<std::int64_t> sorted = places;
  std::sort(sorted.begin(), sorted.end());
  const auto countIn = [&](const Octant& octant)
  {
    const auto first = std::lower_bound(sorted.begin(), sorted.end(), octant.first);
    return std::lower_bound(first, sorted.end(), octant.first + octant.size) - first;
  };

  std::vector<Octant> open{ { 0, std::int64_t{ 1 } << (3 * levels) } };
  std::vector<std::pair<std::int64_t, std::int64_t>> leaves; // first octant, points
  while (!open.empty())
  {
    std::vector<std::int64_t> counts;
    std::transform(open.begin(), open.end(), std::back_inserter(counts), countIn);
    counts = exchange.sum(counts);
    std::vector<Octant> next;
    for (std::size_t i = 0; i < open.size(); ++i)
    {
      if (counts[i] > largest && open[i].size > 1)
      {
        const std::int64_t size = open[i].size / 8;
        for (int child = 0; child < 8; ++child)
        {
          next.push_back({ open[i].first + child * size, size });
        }
      }
      else if (counts[i] > 0)
      {
        leaves.emplace_back(open[i].first, counts[i]);
      }
    }
    open = std::move(next);
  }
  std::sort(leaves.begin(), leaves.end());

  Blocks blocks;
  for (const auto& [first, count] : leaves)
  {
    blocks.sizes.push_back(count);
  }
  for (const std::int64_t place : places)
  {
    const auto after = std::upper_bound(leaves.begin(), leaves.end(), place,
      [](std::int64_t value, const auto& leaf) { return value < leaf.first; });
    blocks.ofPoints.push_back(after - leaves.begin() - 1);
  }
  return blocks;
}

} // namespace cadrefine
