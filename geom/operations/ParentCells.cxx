#include <cadrefine/operations/ParentCells.h>

#include <cadrefine/mesh/Quality.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

namespace cadrefine
{
namespace
{

/// How far a point is within a tetrahedron, in parts of it: the smallest of its four coordinates.
double depthIn(const std::array<Point3, 4>& cell, const Point3& point)
{
  const double volume = sixfoldVolume(cell[0], cell[1], cell[2], cell[3]);
  double depth = std::numeric_limits<double>::infinity();
  for (const auto& face : tetrahedronFaces)
  {
    const double part = -sixfoldVolume(cell[face[0]], cell[face[1]], cell[face[2]], point);
    depth = std::min(depth, volume > 0 ? part / volume : part);
  }
  return depth;
}

/// How far a point is within a triangle, seen along its normal, in the same terms.
double depthIn(const std::array<Point3, 3>& cell, const Point3& point)
{
  const Vector3 whole = twofoldAreaVector(cell[0], cell[1], cell[2]);
  const double area = squaredNorm(whole);
  double depth = std::numeric_limits<double>::infinity();
  for (const auto& [i, j] : triangleEdges)
  {
    const double part = dot(whole, twofoldAreaVector(cell[i], cell[j], point));
    depth = std::min(depth, area > 0 ? part / area : part);
  }
  return depth;
}

template<std::size_t Corners>
std::array<Point3, Corners> pointsOf(
  const EditableMesh& mesh, const std::array<Index, Corners>& corners)
{
  std::array<Point3, Corners> points;
  std::transform(corners.begin(), corners.end(), points.begin(),
    [&](Index vertex) { return mesh.vertex(vertex).point; });
  return points;
}

template<std::size_t Corners>
Index findParent(const EditableMesh& mesh, const SimplexStore<Corners>& cells,
  const std::array<Index, Corners>& corners, const std::vector<Index>& numbers)
{
  const auto points = pointsOf(mesh, corners);
  Point3 sum = points[0];
  for (std::size_t k = 1; k < Corners; ++k)
  {
    sum = sum + points[k];
  }
  const Point3 centroid = (1.0 / Corners) * sum;
  Index parent = -1;
  double deepest = -std::numeric_limits<double>::infinity();
  for (const Index cell : numbers)
  {
    const double depth = depthIn(pointsOf(mesh, cells[cell].corners), centroid);
    if (depth > deepest)
    {
      deepest = depth;
      parent = cells[cell].parent;
    }
  }
  return parent;
}

} // namespace

Index parentOf(const EditableMesh& mesh, const SimplexStore<4>& cells,
  const std::array<Index, 4>& corners, const std::vector<Index>& numbers)
{
  return findParent(mesh, cells, corners, numbers);
}

Index parentOf(const EditableMesh& mesh, const SimplexStore<3>& cells,
  const std::array<Index, 3>& corners, const std::vector<Index>& numbers)
{
  return findParent(mesh, cells, corners, numbers);
}

} // namespace cadrefine
