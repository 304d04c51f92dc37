#include "MeshChecks.h"

#include <cadrefine/mesh/Orientation.h>
#include <cadrefine/mesh/Quality.h>

#include <algorithm>
#include <map>

namespace cadtest
{

using namespace cadrefine;

namespace
{

using Side = std::vector<Index>; // ascending

template<std::size_t Corners>
void countSides(const Simplices<Corners>& cells, std::map<Side, int>& counts)
{
  for (const auto& cell : cells)
  {
    for (std::size_t left = 0; left < Corners; ++left)
    {
      Side side;
      for (std::size_t k = 0; k < Corners; ++k)
      {
        if (k != left)
        {
          side.push_back(cell[k]);
        }
      }
      std::sort(side.begin(), side.end());
      ++counts[side];
    }
  }
}

/// How often each side of the cells of the mesh's own dimension is met.
std::map<Side, int> sidesOf(const SimplexMesh& mesh)
{
  std::map<Side, int> counts;
  if (mesh.dimension == 3)
  {
    countSides(mesh.tetrahedra, counts);
  }
  else
  {
    countSides(mesh.triangles, counts);
  }
  return counts;
}

std::set<std::array<Index, 2>> edgesOf(const SimplexMesh& mesh)
{
  std::set<std::array<Index, 2>> edges;
  for (const auto& cell : mesh.tetrahedra)
  {
    for (const auto& edge : tetrahedronEdges)
    {
      edges.insert({ cell[edge[0]], cell[edge[1]] });
    }
  }
  for (const auto& cell : mesh.triangles)
  {
    for (const auto& edge : triangleEdges)
    {
      edges.insert({ cell[edge[0]], cell[edge[1]] });
    }
  }
  return edges;
}

double signedMeasure(const SimplexMesh& mesh, const std::array<Index, 4>& cell)
{
  const auto& p = mesh.points;
  return sixfoldVolume(p[cell[0]], p[cell[1]], p[cell[2]], p[cell[3]]) / 6;
}

/// Signed in the plane z = 0.
double signedMeasure(const SimplexMesh& mesh, const std::array<Index, 3>& cell)
{
  const auto& p = mesh.points;
  const Vector3 area = twofoldAreaVector(p[cell[0]], p[cell[1]], p[cell[2]]);
  return area[0] == 0 && area[1] == 0 ? area[2] / 2 : norm(area) / 2;
}

int signOf(const SimplexMesh& mesh, const std::array<Index, 4>& cell)
{
  const auto& p = mesh.points;
  return orientation(p[cell[0]], p[cell[1]], p[cell[2]], p[cell[3]]);
}

/// Signed in the plane z = 0; in space, 1 where the triangle has an area.
int signOf(const SimplexMesh& mesh, const std::array<Index, 3>& cell)
{
  const auto& p = mesh.points;
  const auto signs = normalSigns(p[cell[0]], p[cell[1]], p[cell[2]]);
  return signs[0] == 0 && signs[1] == 0 ? signs[2] : 1;
}

template<std::size_t Corners>
testing::AssertionResult areAllPositive(const SimplexMesh& mesh, const Simplices<Corners>& cells)
{
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    if (signOf(mesh, cells[c]) <= 0)
    {
      return testing::AssertionFailure()
             << "cell " << c << " has the measure " << signedMeasure(mesh, cells[c]);
    }
  }
  return testing::AssertionSuccess();
}

} // namespace

double measureOf(const SimplexMesh& mesh)
{
  double sum = 0;
  if (mesh.dimension == 3)
  {
    for (const auto& cell : mesh.tetrahedra)
    {
      sum += signedMeasure(mesh, cell);
    }
    return sum;
  }
  for (const auto& cell : mesh.triangles)
  {
    sum += signedMeasure(mesh, cell);
  }
  return sum;
}

double volumeInside(const SimplexMesh& mesh)
{
  double sum = 0;
  for (const auto& cell : mesh.triangles)
  {
    const auto& p = mesh.points;
    sum += dot(p[cell[0]], cross(p[cell[1]], p[cell[2]])) / 6;
  }
  return sum;
}

testing::AssertionResult areCellsValid(const SimplexMesh& mesh)
{
  return mesh.dimension == 3 ? areAllPositive(mesh, mesh.tetrahedra)
                             : areAllPositive(mesh, mesh.triangles);
}

testing::AssertionResult isValid(const SimplexMesh& mesh)
{
  return mesh.tetrahedra.empty() && mesh.triangles.empty()
           ? testing::AssertionFailure() << "there are no cells"
           : areCellsValid(mesh);
}

testing::AssertionResult isWatertight(
  const SimplexMesh& mesh, const std::function<bool(const std::vector<Point3>&)>& onBoundary)
{
  const auto sides = sidesOf(mesh);
  for (const auto& [side, count] : sides)
  {
    std::vector<Point3> corners;
    for (const Index vertex : side)
    {
      corners.push_back(mesh.points[vertex]);
    }
    const bool mayBranch = corners.size() == 2;
    if (count != 2 && ((count > 2 && !mayBranch) || !onBoundary(corners)))
    {
      return testing::AssertionFailure()
             << "a side at (" << corners[0][0] << ", " << corners[0][1] << ", " << corners[0][2]
             << ") is met " << count << " times";
    }
  }
  return sides.empty() ? testing::AssertionFailure() << "there are no cells"
                       : testing::AssertionSuccess();
}

bool onUnitCube(const std::vector<Point3>& points, int dimension)
{
  for (int k = 0; k < dimension; ++k)
  {
    for (const double plane : { 0.0, 1.0 })
    {
      if (std::all_of(points.begin(), points.end(), [&](const Point3& p) { return p[k] == plane; }))
      {
        return true;
      }
    }
  }
  return false;
}

testing::AssertionResult hasNoHangingVertex(const SimplexMesh& mesh)
{
  const std::set<Point3> points(mesh.points.begin(), mesh.points.end());
  for (const auto& [a, b] : edgesOf(mesh))
  {
    const Point3 middle = 0.5 * (mesh.points[a] + mesh.points[b]);
    if (points.count(middle))
    {
      return testing::AssertionFailure() << "vertex at (" << middle[0] << ", " << middle[1] << ", "
                                         << middle[2] << ") hangs in the middle of an edge";
    }
  }
  return testing::AssertionSuccess();
}

std::size_t countOuterSides(const SimplexMesh& mesh)
{
  const auto sides = sidesOf(mesh);
  return static_cast<std::size_t>(
    std::count_if(sides.begin(), sides.end(), [](const auto& side) { return side.second == 1; }));
}

std::set<Index> outerVertices(const SimplexMesh& mesh)
{
  std::set<Index> vertices;
  for (const auto& [side, count] : sidesOf(mesh))
  {
    if (count == 1)
    {
      vertices.insert(side.begin(), side.end());
    }
  }
  return vertices;
}

} // namespace cadtest
