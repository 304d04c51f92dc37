#include "mesh/MeshPlane.h"

#include <cadrefine/mesh/Quality.h>

namespace cadrefine
{

Vector3 planeNormal(RankExchange& exchange, const SimplexMesh& mesh)
{
  std::vector<std::int64_t> turns(3, 0);
  std::vector<std::int64_t> outside(3, 0);
  for (const auto& cell : mesh.triangles)
  {
    const Vector3 area =
      twofoldAreaVector(mesh.points[cell[0]], mesh.points[cell[1]], mesh.points[cell[2]]);
    for (int k = 0; k < 3; ++k)
    {
      turns[k] += (area[k] > 0) - (area[k] < 0);
      outside[k] += area[(k + 1) % 3] != 0 || area[(k + 2) % 3] != 0;
    }
  }
  turns = exchange.sum(turns);
  outside = exchange.sum(outside);
  Vector3 normal{};
  for (int k = 0; k < 3; ++k)
  {
    normal[k] = outside[k] == 0 ? (turns[k] < 0 ? -1 : 1) : 0;
  }
  return squaredNorm(normal) == 1 ? normal : Vector3{};
}

} // namespace cadrefine
