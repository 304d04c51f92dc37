#include "HexahedralMeshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <utility>

namespace cadtest
{

using namespace cadrefine;

namespace
{

constexpr double pi = 3.14159265358979323846;

/// One vertex for each place.
template<class Place>
class Lattice
{
public:
  explicit Lattice(Mesh& mesh) : mesh_(mesh) {}

  template<class PointAt>
  Index at(const Place& place, const PointAt& pointAt)
  {
    const auto [entry, isNew] = vertices_.emplace(place, static_cast<Index>(mesh_.points.size()));
    if (isNew)
    {
      mesh_.points.push_back(pointAt());
    }
    return entry->second;
  }

private:
  Mesh& mesh_;
  std::map<Place, Index> vertices_;
};

using GridPlace = std::array<int, 3>;

/// The six sides of a grid of n * n * n boxes: use(corners) of each square on them, which turn
/// counter-clockwise as seen from outside.
template<class Use>
void forSquares(int n, const Use& use)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    for (const int end : { 0, n })
    {
      for (int i = 0; i < n; ++i)
      {
        for (int j = 0; j < n; ++j)
        {
          const auto at = [&](int a, int b)
          {
            GridPlace place{};
            place[axis] = end;
            place[u] = a;
            place[v] = b;
            return place;
          };
          std::array<GridPlace, 4> corners{ at(i, j), at(i + 1, j), at(i + 1, j + 1),
            at(i, j + 1) };
          if (end == 0)
          {
            std::reverse(corners.begin(), corners.end());
          }
          use(corners);
        }
      }
    }
  }
}

/// As many shells of hexahedra round a grid, at(level, place) being their vertices, the lowest
/// first.
template<class At>
void addShells(Mesh& mesh, int n, std::size_t shells, const At& at)
{
  for (std::size_t level = 0; level < shells; ++level)
  {
    forSquares(n,
      [&](const std::array<GridPlace, 4>& s)
      {
        mesh.hexahedra.push_back(
          { at(level, s[0]), at(level, s[1]), at(level, s[2]), at(level, s[3]), at(level + 1, s[0]),
            at(level + 1, s[1]), at(level + 1, s[2]), at(level + 1, s[3]) });
      });
  }
}

/// A place on the grid's sides as one round the origin, in the cube from -1 to 1.
Vector3 fromMiddle(const GridPlace& place, int n)
{
  return { std::tan(pi / 4 * (2.0 * place[0] / n - 1)), std::tan(pi / 4 * (2.0 * place[1] / n - 1)),
    std::tan(pi / 4 * (2.0 * place[2] / n - 1)) };
}

double radiusNear(double radius, double offset, const GridPlace& place)
{
  return radius * (1 + offset * ((place[0] + 2 * place[1] + 3 * place[2]) % 3 - 1));
}

/// The cells all of whose corners are accepted.
Mesh partOf(const Mesh& hexahedra, const std::function<bool(const Point3&)>& accepts)
{
  Mesh result;
  Lattice<Index> lattice(result);
  const auto isInside = [&](Index v) { return accepts(hexahedra.points[v]); };
  for (auto cell : hexahedra.hexahedra)
  {
    if (std::all_of(cell.begin(), cell.end(), isInside))
    {
      for (Index& v : cell)
      {
        v = lattice.at(v, [&] { return hexahedra.points[v]; });
      }
      result.hexahedra.push_back(cell);
    }
  }
  std::mt19937_64 random(1);
  shuffleIds(result, random);
  return result;
}

} // namespace

Mesh hexahedraMesh(int n, double jitter, std::uint64_t seed)
{
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> move(-jitter / n, jitter / n);
  Mesh mesh;
  Lattice<GridPlace> lattice(mesh);
  for (int box = 0; box < n * n * n; ++box)
  {
    auto& cell = mesh.hexahedra.emplace_back();
    for (int k = 0; k < 8; ++k)
    {
      const GridPlace place{ box % n + (k % 4 == 1 || k % 4 == 2), box / n % n + (k % 4 > 1),
        box / n / n + k / 4 };
      cell[k] = lattice.at(place,
        [&]
        {
          const bool isInner =
            std::all_of(place.begin(), place.end(), [n](int i) { return i > 0 && i < n; });
          Point3 point{ 1.0 * place[0] / n, 1.0 * place[1] / n, 1.0 * place[2] / n };
          return isInner ? point + Vector3{ move(random), move(random), move(random) } : point;
        });
    }
  }
  shuffleIds(mesh, random);
  return mesh;
}

Mesh quadrilateralsMesh(int n, double jitter, std::uint64_t seed)
{
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> move(-jitter / n, jitter / n);
  Mesh mesh;
  mesh.dimension = 2;
  Lattice<std::array<int, 2>> lattice(mesh);
  for (int box = 0; box < n * n; ++box)
  {
    auto& cell = mesh.quadrilaterals.emplace_back();
    for (int k = 0; k < 4; ++k)
    {
      const std::array<int, 2> place{ box % n + (k == 1 || k == 2), box / n + (k > 1) };
      cell[k] = lattice.at(place,
        [&]
        {
          const bool isInner =
            std::all_of(place.begin(), place.end(), [n](int i) { return i > 0 && i < n; });
          Point3 point{ 1.0 * place[0] / n, 1.0 * place[1] / n, 0 };
          return isInner ? point + Vector3{ move(random), move(random), 0 } : point;
        });
    }
  }
  shuffleIds(mesh, random);
  return mesh;
}

Mesh hexahedralBallMesh(double radius, double offset, int n, const std::vector<double>& parts)
{
  constexpr double inner = 0.4; // of the radius
  Mesh mesh = hexahedraMesh(n, 0, 1);
  for (Point3& point : mesh.points)
  {
    for (double& x : point)
    {
      x = inner * radius * std::tan(pi / 4 * (2 * x - 1)) * std::sqrt(0.5);
    }
  }
  std::map<Point3, Index> vertexAt;
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
  {
    vertexAt.emplace(mesh.points[v], static_cast<Index>(v));
  }
  // Those of the middle have their own places.
  Lattice<std::pair<std::size_t, GridPlace>> lattice(mesh);
  const auto cornerAt = [&](const GridPlace& place)
  {
    Index best = 0;
    const Point3 wanted = inner * radius * std::sqrt(0.5) * fromMiddle(place, n);
    for (const auto& [point, vertex] : vertexAt)
    {
      best = distance(point, wanted) < distance(mesh.points[best], wanted) ? vertex : best;
    }
    return best;
  };
  const auto at = [&](std::size_t level, const GridPlace& place)
  {
    const Index below = cornerAt(place);
    return level == 0 ? below
                      : lattice.at({ level, place },
                          [&]
                          {
                            const double part = parts[level - 1];
                            const double r = radiusNear(radius, offset, place);
                            return (1 - part) * mesh.points[below] +
                                   part * r * normalized(mesh.points[below]);
                          });
  };
  addShells(mesh, n, parts.size(), at);
  std::mt19937_64 random(1);
  shuffleIds(mesh, random);
  return mesh;
}

Mesh hexahedralShellMesh(double radius, double offset, int n, const std::vector<double>& heights)
{
  Mesh mesh;
  Lattice<std::pair<std::size_t, GridPlace>> lattice(mesh);
  const auto at = [&](std::size_t level, const GridPlace& place)
  {
    return lattice.at({ level, place },
      [&]
      {
        const double wall = radiusNear(radius, offset, place);
        const double r = level == 0                ? wall
                         : level <= heights.size() ? wall + heights[level - 1]
                                                   : 3 * radius;
        return r * normalized(fromMiddle(place, n));
      });
  };
  addShells(mesh, n, heights.size() + 1, at);
  std::mt19937_64 random(1);
  shuffleIds(mesh, random);
  return mesh;
}

Mesh eighthOf(const Mesh& hexahedra)
{
  return partOf(hexahedra, [](const Point3& p) { return p[0] >= 0 && p[1] >= 0 && p[2] >= 0; });
}

Mesh hexahedralWallMesh(double radius, int n, const std::vector<double>& heights)
{
  return partOf(hexahedralShellMesh(radius, 0, n, heights),
    [&](const Point3& p) { return norm(p) < radius + 2 * heights.back(); });
}

void shuffleIds(Mesh& mesh, std::mt19937_64& random)
{
  mesh.ids.resize(mesh.points.size());
  std::iota(mesh.ids.begin(), mesh.ids.end(), GlobalId{ 0 });
  std::shuffle(mesh.ids.begin(), mesh.ids.end(), random);
}

} // namespace cadtest
