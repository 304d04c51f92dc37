#include "MeshChecks.h"

#include <cadrefine/mesh/CellJacobian.h>
#include <cadrefine/mesh/CellState.h>
#include <cadrefine/mesh/Facets.h>
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

/// How often each side of the cells of the mesh's own dimension is met.
std::map<Side, int> sidesOf(const Mesh& mesh)
{
  std::map<Side, int> counts;
  forEachSide(mesh,
    [&](const Facet& facet)
    {
      Side side(facet.begin(), facet.end());
      std::sort(side.begin(), side.end());
      ++counts[side];
    });
  return counts;
}

std::set<std::array<Index, 2>> edgesOf(const Mesh& mesh)
{
  std::set<std::array<Index, 2>> edges;
  for (const int dimension : { 2, 3 })
  {
    visitShapes(mesh, dimension,
      [&](auto shape, const auto& cells)
      {
        if constexpr (decltype(shape)::dimension > 1)
        {
          for (const auto& cell : cells)
          {
            for (const auto& edge : decltype(shape)::edges)
            {
              edges.insert({ cell[edge[0]], cell[edge[1]] });
            }
          }
        }
      });
  }
  return edges;
}

double signedMeasure(shapes::Tetrahedron, const std::array<Point3, 4>& p)
{
  return sixfoldVolume(p[0], p[1], p[2], p[3]) / 6;
}

template<class Shape, std::size_t Corners>
double signedMeasure(Shape, const std::array<Point3, Corners>& p)
{
  if constexpr (Shape::dimension == 3)
  {
    return volume(p);
  }
  else // signed in the plane z = 0
  {
    const Vector3 area = Corners == 4 ? cross(p[2] - p[0], p[Corners - 1] - p[1])
                                      : twofoldAreaVector(p[0], p[1], p[2]);
    return area[0] == 0 && area[1] == 0 ? area[2] / 2 : norm(area) / 2;
  }
}

bool isPositive(shapes::Tetrahedron, const std::array<Point3, 4>& p)
{
  return orientation(p[0], p[1], p[2], p[3]) > 0;
}

/// Signed in the plane z = 0; in space, where the triangle has an area.
bool isPositive(shapes::Triangle, const std::array<Point3, 3>& p)
{
  const auto signs = normalSigns(p[0], p[1], p[2]);
  return signs[0] != 0 || signs[1] != 0 || signs[2] > 0;
}

template<class Shape, std::size_t Corners>
bool isPositive(Shape shape, const std::array<Point3, Corners>& p)
{
  const bool isFlat =
    std::all_of(p.begin(), p.end(), [&](const Point3& point) { return point[2] == p[0][2]; });
  return stateAt(shape, p, sideOf(shape, p, isFlat ? Vector3{ 0, 0, 1 } : Vector3{})).valid;
}

} // namespace

double measureOf(const Mesh& mesh)
{
  double sum = 0;
  visitOwnShapes(mesh,
    [&](auto shape, const auto& cells)
    {
      for (const auto& cell : cells)
      {
        sum += signedMeasure(shape, cornersOf(cell, mesh.points));
      }
    });
  return sum;
}

double volumeInside(const Mesh& mesh)
{
  double sum = 0;
  for (const auto& cell : mesh.triangles)
  {
    const auto& p = mesh.points;
    sum += dot(p[cell[0]], cross(p[cell[1]], p[cell[2]])) / 6;
  }
  return sum;
}

testing::AssertionResult areCellsValid(const Mesh& mesh)
{
  testing::AssertionResult result = testing::AssertionSuccess();
  visitOwnShapes(mesh,
    [&](auto shape, const auto& cells)
    {
      for (std::size_t c = 0; result && c < cells.size(); ++c)
      {
        const auto corners = cornersOf(cells[c], mesh.points);
        if (!isPositive(shape, corners))
        {
          result = testing::AssertionFailure()
                   << "cell " << c << " with " << corners.size() << " corners, from ("
                   << corners[0][0] << ", " << corners[0][1] << ", " << corners[0][2]
                   << ") on, has the measure " << signedMeasure(shape, corners);
        }
      }
    });
  return result;
}

testing::AssertionResult isValid(const Mesh& mesh)
{
  return mesh.cellCount(mesh.dimension) == 0 ? testing::AssertionFailure() << "there are no cells"
                                             : areCellsValid(mesh);
}

testing::AssertionResult isWatertight(
  const Mesh& mesh, const std::function<bool(const std::vector<Point3>&)>& onBoundary)
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

testing::AssertionResult isBoundedByListedCells(const Mesh& mesh)
{
  auto sides = sidesOf(mesh);
  testing::AssertionResult result = testing::AssertionSuccess();
  visitShapes(mesh, mesh.dimension - 1,
    [&](auto, const auto& cells)
    {
      for (const auto& cell : cells)
      {
        Side side(cell.begin(), cell.end());
        std::sort(side.begin(), side.end());
        const int count = sides.count(side) ? sides[side]++ : -1;
        if (count != 1)
        {
          result = testing::AssertionFailure()
                   << "a listed cell with vertex " << side[0] << " is a side of "
                   << (count < 0 ? "no" : std::to_string(count)) << " cells";
        }
      }
    });
  for (const auto& [side, count] : sides)
  {
    if (count != 2)
    {
      result = testing::AssertionFailure()
               << "a side with vertex " << side[0] << " is met " << count << " times";
    }
  }
  return result;
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

testing::AssertionResult hasNoHangingVertex(const Mesh& mesh)
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

std::size_t countOuterSides(const Mesh& mesh)
{
  const auto sides = sidesOf(mesh);
  return static_cast<std::size_t>(
    std::count_if(sides.begin(), sides.end(), [](const auto& side) { return side.second == 1; }));
}

std::set<Index> outerVertices(const Mesh& mesh)
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
