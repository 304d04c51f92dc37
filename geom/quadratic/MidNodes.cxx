#include <cadrefine/quadratic/MidNodes.h>

namespace cadrefine
{

std::vector<Point3> middlesOf(const Mesh& mesh, const std::vector<std::array<Index, 2>>& edges)
{
  std::vector<Point3> middles;
  middles.reserve(edges.size());
  for (const auto& ends : edges)
  {
    middles.push_back(middleOf(mesh, ends));
  }
  return middles;
}

std::vector<unsigned char> findValidCells(
  const Mesh& mesh, const MidNodes& nodes, const Vector3& plane)
{
  std::vector<unsigned char> valid;
  const auto nodeAt = [&](Index edge) { return nodes.points[edge]; };
  visitOwnShapes(mesh,
    [&](auto shape, const auto& cells)
    {
      const auto& edgesOf = nodes.table.*edgesOfCells(shape);
      for (std::size_t c = 0; c < cells.size(); ++c)
      {
        valid.push_back(isCellValid(shape, mesh, cells[c], edgesOf[c], plane, nodeAt));
      }
    });
  return valid;
}

} // namespace cadrefine
