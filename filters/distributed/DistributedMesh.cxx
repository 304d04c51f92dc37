#include "DistributedMesh.h"

#include "Facets.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace cadrefine
{
namespace
{

/// Vertices that other ranks may hold.
std::vector<Index> candidates(RankExchange& exchange, const SimplexMesh& mesh)
{
  const std::size_t own = mesh.dimension == 3   ? mesh.tetrahedra.size()
                          : mesh.dimension == 2 ? mesh.triangles.size()
                                                : 0;
  std::vector<Index> result;
  if (exchange.any(mesh.cellCount() > own))
  {
    result.resize(mesh.points.size());
    std::iota(result.begin(), result.end(), 0);
    return result;
  }
  for (const Facet& facet : findOuterFacets(mesh))
  {
    std::copy_if(facet.vertices.begin(), facet.vertices.end(), std::back_inserter(result),
      [](Index vertex) { return vertex >= 0; });
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

} // namespace

SharedVertices findShared(RankExchange& exchange, const SimplexMesh& mesh)
{
  if (exchange.size() == 1)
  {
    return {};
  }
  return findSharedVertices(exchange, mesh.ids, candidates(exchange, mesh));
}

DistributedMesh makeDistributedMesh(RankExchange& exchange, vtkPointSet* input)
{
  DistributedMesh result;
  result.converted = convert(exchange, input);
  result.shared = findShared(exchange, result.mesh());
  const auto& ids = result.mesh().ids;
  const GlobalId largest = ids.empty() ? -1 : *std::max_element(ids.begin(), ids.end());
  result.vertexIdBound = exchange.max(largest) + 1;
  return result;
}

MeshBounds findBounds(RankExchange& exchange, const SimplexMesh& mesh)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<double> low(3, infinity);
  std::vector<double> high(3, -infinity);
  for (const Point3& point : mesh.points)
  {
    for (int k = 0; k < 3; ++k)
    {
      low[k] = std::min(low[k], point[k]);
      high[k] = std::max(high[k], point[k]);
    }
  }
  low = exchange.min(low);
  high = exchange.max(high);
  return { { low[0], low[1], low[2] }, { high[0], high[1], high[2] } };
}

MeshCounts countMesh(RankExchange& exchange, const DistributedMesh& mesh)
{
  const auto owned = mesh.shared.ownedHere(static_cast<Index>(mesh.mesh().points.size()));
  const auto vertices = std::count(owned.begin(), owned.end(), 1);
  const auto& cellIds = mesh.converted.cellIds[mesh.mesh().dimension];
  const auto sums = exchange.sum(std::vector<std::int64_t>{
    static_cast<std::int64_t>(vertices), static_cast<std::int64_t>(cellIds.size()) });
  return { sums[0], sums[1] };
}

} // namespace cadrefine
