#include "mesh/MeshPlane.h"

#include <cadrefine/mesh/CellState.h>

namespace cadrefine
{

Vector3 planeNormal(RankExchange& exchange, const Mesh& mesh)
{
  if (mesh.dimension != 2)
  {
    return {};
  }
  std::vector<std::int64_t> turns(3, 0);
  std::vector<std::int64_t> outside(3, 0);
  visitShapes(mesh, 2,
    [&](auto shape, const auto& cells)
    {
      for (const auto& cell : cells)
      {
        const Vector3 area = sideOf(shape, cornersOf(cell, mesh.points), {});
        for (int k = 0; k < 3; ++k)
        {
          turns[k] += (area[k] > 0) - (area[k] < 0);
          outside[k] += area[(k + 1) % 3] != 0 || area[(k + 2) % 3] != 0;
        }
      }
    });
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
