#include <cadrefine/refinement/UniformCutting.h>

#include <cadrefine/mesh/CellState.h>
#include <cadrefine/mesh/Orientation.h>
#include <cadrefine/mesh/Quality.h>

#include <algorithm>
#include <utility>

namespace cadrefine
{
namespace
{

/// The three diagonals of the octahedron between a tetrahedron's corners, each as two midpoints and
/// the ring of the other four, in terms of the tetrahedron's local edges.
constexpr int diagonals[3][2] = { { 0, 5 }, { 1, 4 }, { 2, 3 } };
constexpr int rings[3][4] = { { 1, 3, 4, 2 }, { 2, 5, 3, 0 }, { 0, 4, 5, 1 } };

/// Whether diagonal (a, b) is shorter than (c, d); ties by the ids of their ends.
bool shorterDiagonal(const Mesh& mesh, std::array<Index, 2> ab, std::array<Index, 2> cd)
{
  const auto inIdOrder = [&](std::array<Index, 2>& ends)
  {
    if (mesh.ids[ends[1]] < mesh.ids[ends[0]])
    {
      std::swap(ends[0], ends[1]);
    }
    return squaredNorm(mesh.points[ends[1]] - mesh.points[ends[0]]);
  };
  const double first = inIdOrder(ab);
  const double second = inIdOrder(cd);
  return first != second ? first < second : mesh.ids[ab[0]] < mesh.ids[cd[0]];
}

/// Corners of a hexahedron in steps along its three directions.
constexpr int cornerSteps[8][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 },
  { 1, 0, 1 }, { 1, 1, 1 }, { 0, 1, 1 } };

} // namespace

void splitTriangleUniformly(
  const std::array<Index, 3>& v, const std::array<Index, 3>& m, Cells<3>& children)
{
  children.push_back({ v[0], m[0], m[2] });
  children.push_back({ m[0], v[1], m[1] });
  children.push_back({ m[2], m[1], v[2] });
  children.push_back({ m[0], m[1], m[2] });
}

void splitQuadrilateralUniformly(
  const std::array<Index, 4>& v, const std::array<Index, 4>& m, Index middle, Cells<4>& children)
{
  children.push_back({ v[0], m[0], middle, m[3] });
  children.push_back({ m[0], v[1], m[1], middle });
  children.push_back({ middle, m[1], v[2], m[2] });
  children.push_back({ m[3], middle, m[2], v[3] });
}

void splitTetrahedronUniformly(const Mesh& mesh, const std::array<Index, 4>& v,
  const std::array<Index, 6>& m, Cells<4>& children)
{
  children.push_back({ v[0], m[0], m[1], m[2] });
  children.push_back({ m[0], v[1], m[3], m[4] });
  children.push_back({ m[1], m[3], v[2], m[5] });
  children.push_back({ m[2], m[4], m[5], v[3] });
  int best = 0;
  for (int k = 1; k < 3; ++k)
  {
    if (shorterDiagonal(mesh, { m[diagonals[k][0]], m[diagonals[k][1]] },
          { m[diagonals[best][0]], m[diagonals[best][1]] }))
    {
      best = k;
    }
  }
  for (int k = 0; k < 4; ++k)
  {
    children.push_back({ m[diagonals[best][0]], m[diagonals[best][1]], m[rings[best][(k + 1) % 4]],
      m[rings[best][k]] });
  }
}

std::optional<int> partingDiagonal(const Mesh& mesh, const std::array<Index, 5>& v)
{
  const auto corners = cornersOf(v, mesh.points);
  const Point3 base = centroidOf({ corners[0], corners[1], corners[2], corners[3] }, 4);
  std::array<Point3, 4> inner;
  std::transform(corners.begin(), corners.end() - 1, inner.begin(),
    [&](const Point3& corner) { return 0.5 * (corner + corners[4]); });
  const auto& [a, b, c, d] = inner;
  if (stateAt(shapes::Pyramid{}, { a, d, c, b, base }).valid)
  {
    return std::nullopt;
  }
  // The diagonals are half of those of the base.
  const int shorter = shorterDiagonal(mesh, { v[0], v[2] }, { v[1], v[3] }) ? 0 : 1;
  for (const int k : { shorter, 1 - shorter })
  {
    const Point3& next = inner[k + 1];
    const Point3& last = inner[(k + 3) % 4];
    if (isPositive(inner[k], inner[k + 2], next, base) &&
        isPositive(inner[k], last, inner[k + 2], base))
    {
      return k;
    }
  }
  return std::nullopt;
}

void splitPyramidUniformly(const Mesh& mesh, const std::array<Index, 5>& v,
  const std::array<Index, 8>& m, Index base, Cells<5>& pyramids, Cells<4>& tetrahedra)
{
  pyramids.push_back({ v[0], m[0], base, m[3], m[4] });
  pyramids.push_back({ m[0], v[1], m[1], base, m[5] });
  pyramids.push_back({ base, m[1], v[2], m[2], m[6] });
  pyramids.push_back({ m[3], base, m[2], v[3], m[7] });
  if (const auto diagonal = partingDiagonal(mesh, v))
  {
    const Index from = m[4 + *diagonal];
    const Index next = m[5 + *diagonal];
    const Index to = m[6 + *diagonal];
    const Index last = m[4 + (*diagonal + 3) % 4];
    tetrahedra.push_back({ from, next, to, v[4] });
    tetrahedra.push_back({ from, to, last, v[4] });
    tetrahedra.push_back({ from, to, next, base });
    tetrahedra.push_back({ from, last, to, base });
  }
  else
  {
    pyramids.push_back({ m[4], m[5], m[6], m[7], v[4] });
    pyramids.push_back({ m[4], m[7], m[6], m[5], base });
  }
  for (int k = 0; k < 4; ++k)
  {
    tetrahedra.push_back({ m[k], base, m[4 + k], m[4 + (k + 1) % 4] });
  }
}

void splitWedgeUniformly(const std::array<Index, 6>& v, const std::array<Index, 9>& m,
  const std::array<Index, 3>& q, Cells<6>& children)
{
  const std::array<Index, 6> levels[3] = { { v[0], v[1], v[2], m[0], m[1], m[2] },
    { m[6], m[7], m[8], q[0], q[1], q[2] }, { v[3], v[4], v[5], m[3], m[4], m[5] } };
  constexpr int triangles[4][3] = { { 0, 3, 5 }, { 3, 1, 4 }, { 5, 4, 2 }, { 3, 4, 5 } };
  for (int level = 0; level < 2; ++level)
  {
    for (const auto& [a, b, c] : triangles)
    {
      const auto& low = levels[level];
      const auto& high = levels[level + 1];
      children.push_back({ low[a], low[b], low[c], high[a], high[b], high[c] });
    }
  }
}

void splitHexahedronUniformly(const std::array<Index, 8>& v, const std::array<Index, 12>& m,
  const std::array<Index, 6>& q, Index middle, Cells<8>& children)
{
  Index lattice[3][3][3]; // of half the size of the hexahedron
  const auto at = [&](const int* corners, int count) -> Index&
  {
    int place[3] = { 0, 0, 0 };
    for (int k = 0; k < count; ++k)
    {
      for (int i = 0; i < 3; ++i)
      {
        place[i] += 2 * cornerSteps[corners[k]][i];
      }
    }
    return lattice[place[0] / count][place[1] / count][place[2] / count];
  };
  for (int k = 0; k < 8; ++k)
  {
    at(&k, 1) = v[k];
  }
  for (int e = 0; e < 12; ++e)
  {
    at(shapes::Hexahedron::edges[e], 2) = m[e];
  }
  for (int f = 0; f < 6; ++f)
  {
    at(shapes::Hexahedron::faces[f], 4) = q[f];
  }
  lattice[1][1][1] = middle;
  for (const auto& first : cornerSteps)
  {
    auto& child = children.emplace_back();
    for (int k = 0; k < 8; ++k)
    {
      const auto& step = cornerSteps[k];
      child[k] = lattice[first[0] + step[0]][first[1] + step[1]][first[2] + step[2]];
    }
  }
}

} // namespace cadrefine
