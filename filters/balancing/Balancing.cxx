#include "balancing/Balancing.h"

#include "balancing/WeightedPartition.h"

#include <numeric>

namespace cadrefine
{
namespace
{

template<std::size_t Corners>
void appendCentres(const Mesh& mesh, const std::vector<std::array<Index, Corners>>& cells,
  std::vector<Point3>& centres)
{
  for (const auto& cell : cells)
  {
    Point3& centre = centres.emplace_back(Point3{});
    for (const Index vertex : cell)
    {
      centre = centre + (1.0 / Corners) * mesh.points[vertex];
    }
  }
}

/// Centres of all cells, those of dimension 0 first.
std::vector<Point3> cellCentres(const Mesh& mesh)
{
  std::vector<Point3> centres;
  centres.reserve(mesh.cellCount());
  visitShapes(mesh, [&](auto, const auto& cells) { appendCentres(mesh, cells, centres); });
  return centres;
}

} // namespace

bool isBalanced(
  RankExchange& exchange, const DistributedMesh& mesh, const std::vector<std::int64_t>& weights)
{
  constexpr double tolerance = 1.02;  // as good as partitionByWeight promises
  constexpr std::int64_t compact = 4; // times as many vertices as the interface has
  const std::int64_t mine = std::accumulate(weights.begin(), weights.end(), std::int64_t{ 0 });
  const std::int64_t largest = exchange.max(mine);
  const auto sums = exchange.sum({ mine, static_cast<std::int64_t>(mesh.shared.all.size()),
    static_cast<std::int64_t>(mesh.mesh().points.size()) });
  const double mean = static_cast<double>(sums[0]) / exchange.size();
  return static_cast<double>(largest) <= tolerance * mean && compact * sums[1] <= sums[2];
}

std::vector<int> ranksByWeight(
  RankExchange& exchange, const DistributedMesh& mesh, const std::vector<std::int64_t>& weights)
{
  return partitionByWeight(exchange, cellCentres(mesh.mesh()), weights);
}

} // namespace cadrefine
