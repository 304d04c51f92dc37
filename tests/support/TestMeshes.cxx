#include "TestMeshes.h"

#include <cadrefine/mesh/Quality.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

namespace cadtest
{

using namespace cadrefine;

namespace
{

constexpr double pi = 3.14159265358979323846;

std::vector<GlobalId> consecutiveIds(std::size_t count)
{
  std::vector<GlobalId> ids(count);
  std::iota(ids.begin(), ids.end(), GlobalId{ 0 });
  return ids;
}

std::vector<GlobalId> shuffledIds(std::size_t count, std::mt19937_64& random)
{
  std::vector<GlobalId> ids = consecutiveIds(count);
  std::shuffle(ids.begin(), ids.end(), random);
  return ids;
}

/// Points of a grid on the unit square or cube, x fastest; inner ones moved.
std::vector<Point3> gridPoints(int n, int dimension, double jitter, std::mt19937_64& random)
{
  std::uniform_real_distribution<double> move(-jitter / n, jitter / n);
  std::vector<Point3> points;
  const int layers = dimension == 3 ? n + 1 : 1;
  for (int i = 0; i < layers * (n + 1) * (n + 1); ++i)
  {
    const std::array<int, 3> place{ i % (n + 1), i / (n + 1) % (n + 1), i / (n + 1) / (n + 1) };
    Point3 point{};
    bool inner = true;
    for (int k = 0; k < dimension; ++k)
    {
      point[k] = static_cast<double>(place[k]) / n;
      inner = inner && place[k] > 0 && place[k] < n;
    }
    for (int k = 0; inner && k < dimension; ++k)
    {
      point[k] += move(random);
    }
    points.push_back(point);
  }
  return points;
}

/// The simplices of a box: along each order of the axes a path from its first corner to its last.
template<std::size_t Corners>
void addBox(Index first, const std::array<Index, 3>& strides, Cells<Corners>& cells)
{
  std::array<int, Corners - 1> axes;
  std::iota(axes.begin(), axes.end(), 0);
  do
  {
    auto& cell = cells.emplace_back();
    cell[0] = first;
    for (std::size_t k = 1; k < Corners; ++k)
    {
      cell[k] = cell[k - 1] + strides[axes[k - 1]];
    }
  } while (std::next_permutation(axes.begin(), axes.end()));
}

/// Turns the cells whose measure is negative.
void orient(Mesh& mesh)
{
  const auto& p = mesh.points;
  for (auto& cell : mesh.tetrahedra)
  {
    if (sixfoldVolume(p[cell[0]], p[cell[1]], p[cell[2]], p[cell[3]]) < 0)
    {
      std::swap(cell[2], cell[3]);
    }
  }
  for (auto& cell : mesh.triangles)
  {
    if (mesh.dimension == 2 && twofoldAreaVector(p[cell[0]], p[cell[1]], p[cell[2]])[2] < 0)
    {
      std::swap(cell[1], cell[2]);
    }
  }
}

std::vector<Point3> icosahedron(double radius, double offset)
{
  const double golden = (1 + std::sqrt(5.0)) / 2;
  std::vector<Point3> points;
  for (int axis = 0; axis < 3; ++axis)
  {
    for (const double one : { -1.0, 1.0 })
    {
      for (const double two : { -golden, golden })
      {
        Point3 point{};
        point[(axis + 1) % 3] = one;
        point[(axis + 2) % 3] = two;
        const double off = offset * (static_cast<double>(points.size() % 3) - 1);
        points.push_back(radius * (1 + off) * normalized(point));
      }
    }
  }
  return points;
}

/// The 20 sides, with outward normals: corners at the distance of an edge (1.05 radii) from each
/// other.
Cells<3> icosahedronSides(const std::vector<Point3>& points)
{
  const double limit = 1.3 * norm(points[0]);
  const auto near = [&](Index a, Index b) { return distance(points[a], points[b]) < limit; };
  Cells<3> sides;
  for (Index a = 0; a < 12; ++a)
  {
    for (Index b = a + 1; b < 12; ++b)
    {
      for (Index c = b + 1; c < 12; ++c)
      {
        if (near(a, b) && near(b, c) && near(a, c))
        {
          const Vector3 normal = twofoldAreaVector(points[a], points[b], points[c]);
          sides.push_back(
            { a, dot(normal, points[a]) > 0 ? b : c, dot(normal, points[a]) > 0 ? c : b });
        }
      }
    }
  }
  return sides;
}

} // namespace

Mesh oneTetrahedron(const std::array<Point3, 4>& points)
{
  Mesh mesh;
  mesh.dimension = 3;
  mesh.points.assign(points.begin(), points.end());
  mesh.ids = consecutiveIds(4);
  mesh.tetrahedra = { { 0, 1, 2, 3 } };
  return mesh;
}

Mesh oneTriangle(const std::array<Point3, 3>& points)
{
  Mesh mesh;
  mesh.dimension = 2;
  mesh.points.assign(points.begin(), points.end());
  mesh.ids = consecutiveIds(3);
  mesh.triangles = { { 0, 1, 2 } };
  return mesh;
}

Mesh cubeMesh(int n, double jitter, std::uint64_t seed)
{
  std::mt19937_64 random(seed);
  Mesh mesh;
  mesh.dimension = 3;
  mesh.points = gridPoints(n, 3, jitter, random);
  mesh.ids = shuffledIds(mesh.points.size(), random);
  const std::array<Index, 3> strides{ 1, n + 1, (n + 1) * (n + 1) };
  for (Index box = 0; box < n * n * n; ++box)
  {
    addBox<4>(box % n * strides[0] + box / n % n * strides[1] + box / n / n * strides[2], strides,
      mesh.tetrahedra);
  }
  orient(mesh);
  return mesh;
}

Mesh squareMesh(int n, double jitter, std::uint64_t seed)
{
  std::mt19937_64 random(seed);
  Mesh mesh;
  mesh.dimension = 2;
  mesh.points = gridPoints(n, 2, jitter, random);
  mesh.ids = shuffledIds(mesh.points.size(), random);
  for (Index box = 0; box < n * n; ++box)
  {
    addBox<3>(box % n + box / n * (n + 1), { 1, n + 1, 0 }, mesh.triangles);
  }
  orient(mesh);
  return mesh;
}

Mesh withShuffledCells(Mesh mesh, std::uint64_t seed)
{
  std::mt19937_64 random(seed);
  std::shuffle(mesh.tetrahedra.begin(), mesh.tetrahedra.end(), random);
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
  std::shuffle(mesh.segments.begin(), mesh.segments.end(), random);
  return mesh;
}

Mesh sphereMesh(double radius, double offset)
{
  Mesh mesh;
  mesh.dimension = 2;
  mesh.points = icosahedron(radius, offset);
  mesh.ids = consecutiveIds(12);
  mesh.triangles = icosahedronSides(mesh.points);
  return mesh;
}

Mesh ballMesh(double radius, double offset)
{
  Mesh mesh = sphereMesh(radius, offset);
  mesh.dimension = 3;
  mesh.points.push_back({ 0, 0, 0 });
  mesh.ids.push_back(12);
  for (const auto& side : mesh.triangles)
  {
    mesh.tetrahedra.push_back({ side[0], side[2], side[1], 12 });
  }
  mesh.triangles.clear();
  orient(mesh);
  return mesh;
}

Mesh crowdedBallMesh(double radius)
{
  Mesh mesh = ballMesh(radius, 0);
  const auto side = sphereMesh(radius, 0).triangles.front();
  Point3& centre = mesh.points[12];
  for (const Index corner : side)
  {
    mesh.points[corner] = 1.1 * mesh.points[corner];
    centre = centre + (1.0 / 3.0 * 0.95) * mesh.points[corner];
  }
  return mesh;
}

Mesh torusMesh(double majorRadius, double minorRadius, int around, int corners)
{
  Mesh mesh;
  mesh.dimension = 3;
  for (int s = 0; s < around; ++s)
  {
    for (int c = 0; c <= corners; ++c) // the last is the centre
    {
      const double turn = 2 * pi * s / around;
      const double angle = 2 * pi * (c + 0.25) / corners;
      const double minor = c < corners ? minorRadius * (1 + 0.02 * ((s + c) % 3 - 1)) : 0;
      const double r = majorRadius + minor * std::cos(angle);
      mesh.points.push_back({ r * std::cos(turn), r * std::sin(turn), minor * std::sin(angle) });
    }
  }
  mesh.ids = consecutiveIds(mesh.points.size());
  for (Index s = 0; s < around; ++s)
  {
    const Index here = s * (corners + 1);
    const Index there = (s + 1) % around * (corners + 1);
    for (Index c = 0; c < corners; ++c)
    {
      // A prism; the diagonals of its sides run from the smaller corner here to the larger there.
      const Index a = std::min(c, (c + 1) % corners);
      const Index b = std::max(c, (c + 1) % corners);
      mesh.tetrahedra.push_back({ here + a, here + b, here + corners, there + corners });
      mesh.tetrahedra.push_back({ here + a, here + b, there + b, there + corners });
      mesh.tetrahedra.push_back({ here + a, there + a, there + b, there + corners });
    }
  }
  orient(mesh);
  return mesh;
}

Mesh discMesh(double radius, double offset, int corners)
{
  Mesh mesh;
  mesh.dimension = 2;
  for (int c = 0; c < corners; ++c)
  {
    const double angle = 2 * pi * c / corners;
    const double r = radius * (1 + offset * (c % 3 - 1));
    mesh.points.push_back({ r * std::cos(angle), r * std::sin(angle), 0 });
    mesh.triangles.push_back({ c, (c + 1) % corners, corners });
  }
  mesh.points.push_back({ 0, 0, 0 });
  mesh.ids = consecutiveIds(mesh.points.size());
  return mesh;
}

namespace
{

/// The mesh with a copy of its boundary, three times as large, outside: new points follow the old
/// ones in their order. Returns the number of the first.
Index addOuterPoints(Mesh& mesh, Index boundaryPoints)
{
  const auto first = static_cast<Index>(mesh.points.size());
  for (Index v = 0; v < boundaryPoints; ++v)
  {
    mesh.points.push_back(3.0 * mesh.points[v]);
  }
  mesh.ids = consecutiveIds(mesh.points.size());
  return first;
}

} // namespace

Mesh ballInShellMesh(double radius, double offset)
{
  Mesh mesh = ballMesh(radius, offset);
  mesh.triangles = sphereMesh(radius, offset).triangles;
  const Index outside = addOuterPoints(mesh, 12);
  for (std::array<Index, 3> side : mesh.triangles)
  {
    // A prism; its sides are cut from the smaller number below to the larger one above, so that
    // neighbours fit.
    std::sort(side.begin(), side.end());
    mesh.tetrahedra.push_back({ side[0], side[1], side[2], outside + side[2] });
    mesh.tetrahedra.push_back({ side[0], side[1], outside + side[1], outside + side[2] });
    mesh.tetrahedra.push_back({ side[0], outside + side[0], outside + side[1], outside + side[2] });
  }
  orient(mesh);
  return mesh;
}

Mesh discInRingMesh(double radius, double offset, int corners)
{
  Mesh mesh = discMesh(radius, offset, corners);
  const Index outside = addOuterPoints(mesh, corners);
  for (Index a = 0; a < corners; ++a)
  {
    const Index b = (a + 1) % corners;
    mesh.segments.push_back({ a, b });
    mesh.triangles.push_back({ a, outside + a, outside + b });
    mesh.triangles.push_back({ a, outside + b, b });
  }
  return mesh;
}

Mesh twoSquaresMesh()
{
  Mesh mesh;
  mesh.dimension = 2;
  mesh.points = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 },
    { 1, 1, 1 }, { 0, 1, 1 } };
  mesh.triangles = { { 0, 1, 2 }, { 0, 2, 3 }, { 4, 5, 6 }, { 4, 6, 7 } };
  return mesh;
}

namespace
{

/// Adds the other mesh; where points are the same, there is one vertex.
void join(Mesh& mesh, const Mesh& other)
{
  std::map<Point3, Index> vertexAt;
  for (const Point3& point : mesh.points)
  {
    vertexAt.emplace(point, static_cast<Index>(vertexAt.size()));
  }
  std::vector<Index> numbers;
  for (const Point3& point : other.points)
  {
    const auto [vertex, isNew] = vertexAt.emplace(point, static_cast<Index>(mesh.points.size()));
    numbers.push_back(vertex->second);
    if (isNew)
    {
      mesh.points.push_back(point);
    }
  }
  const auto append = [&](const auto& cells, auto& all)
  {
    for (auto cell : cells)
    {
      std::transform(cell.begin(), cell.end(), cell.begin(), [&](Index v) { return numbers[v]; });
      all.push_back(cell);
    }
  };
  append(other.triangles, mesh.triangles);
  append(other.tetrahedra, mesh.tetrahedra);
  mesh.ids = consecutiveIds(mesh.points.size());
}

Mesh twoCubes(int n, const Point3& second)
{
  Mesh mesh = cubeMesh(n, 0, 1);
  Mesh other = mesh;
  std::transform(other.points.begin(), other.points.end(), other.points.begin(),
    [&](const Point3& point) { return point + second; });
  join(mesh, other);
  return mesh;
}

} // namespace

Mesh prismMesh(double radius, double height, int corners, int layers)
{
  Mesh mesh;
  for (int level = 0; level <= layers; ++level)
  {
    for (int c = 0; c < corners; ++c)
    {
      const double angle = 2 * pi * c / corners;
      mesh.points.push_back(
        { radius * std::cos(angle), radius * std::sin(angle), height * level / layers });
    }
  }
  for (int level = 0; level < layers; ++level)
  {
    for (int c = 1; c + 1 < corners; ++c)
    {
      const Index a = level * corners;
      const Index b = a + c;
      const Index d = b + 1;
      mesh.tetrahedra.push_back({ a, b, d, d + corners });
      mesh.tetrahedra.push_back({ a, b, d + corners, b + corners });
      mesh.tetrahedra.push_back({ a, b + corners, d + corners, a + corners });
    }
  }
  mesh.ids = consecutiveIds(mesh.points.size());
  return mesh;
}

Mesh cubesAtAnEdgeMesh(int n)
{
  return twoCubes(n, { 1, 1, 0 });
}

Mesh cubesAtACornerMesh(int n)
{
  return twoCubes(n, { 1, 1, 1 });
}

Mesh threeSheetsMesh(int n)
{
  Mesh mesh;
  mesh.dimension = 2;
  for (int s = 0; s < 3; ++s)
  {
    const double angle = 2 * pi * s / 3;
    Mesh sheet = squareMesh(n, 0, 1);
    for (Point3& point : sheet.points)
    {
      point = { point[0] * std::cos(angle), point[0] * std::sin(angle), point[1] };
    }
    join(mesh, sheet);
  }
  return mesh;
}

} // namespace cadtest
