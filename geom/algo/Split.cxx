#include "Split.h"

#include <algorithm>

namespace cadrefine
{
namespace
{

/// The split mesh with its points but without cells.
SplitMesh withNewPoints(
  const SimplexMesh& mesh, const Midpoints& midpoints, const std::vector<GlobalId>& ids)
{
  SplitMesh result;
  result.mesh.dimension = mesh.dimension;
  result.mesh.points = mesh.points;
  result.mesh.ids = mesh.ids;
  result.mesh.points.reserve(mesh.points.size() + midpoints.edges.size());
  for (const auto& ends : midpoints.parentEdges)
  {
    result.mesh.points.push_back(0.5 * (mesh.points[ends[0]] + mesh.points[ends[1]]));
  }
  result.mesh.ids.insert(result.mesh.ids.end(), ids.begin(), ids.end());
  result.parentEdges = midpoints.parentEdges;
  return result;
}

void copyVertices(const SimplexMesh& mesh, SplitMesh& result)
{
  result.mesh.vertices = mesh.vertices;
  for (std::size_t c = 0; c < mesh.vertices.size(); ++c)
  {
    result.parentCells[0].push_back(static_cast<Index>(c));
  }
}

void splitSegments(
  const SimplexMesh& mesh, const EdgeTable& table, const Midpoints& midpoints, SplitMesh& result)
{
  for (std::size_t c = 0; c < mesh.segments.size(); ++c)
  {
    const auto& cell = mesh.segments[c];
    const Index m = midpoints.ofEdge[table.ofSegments[c]];
    if (m < 0)
    {
      result.mesh.segments.push_back(cell);
    }
    else
    {
      result.mesh.segments.push_back({ cell[0], m });
      result.mesh.segments.push_back({ m, cell[1] });
    }
    result.parentCells[1].resize(result.mesh.segments.size(), static_cast<Index>(c));
  }
}

/// A part of a cell under bisection: its vertices, and which of its edges are whole edges of the
/// mesh (-1: cut from one, or new).
template<std::size_t Corners, std::size_t Edges>
struct Part
{
  std::array<Index, Corners> vertices;
  std::array<Index, Edges> edges;
};

const int (*edgesOf(Part<3, 3>))[2]
{
  return triangleEdges;
}

const int (*edgesOf(Part<4, 6>))[2]
{
  return tetrahedronEdges;
}

/// `part` with corner `corner` moved to vertex `to`: edges at that corner are no longer whole.
template<std::size_t Corners, std::size_t Edges>
Part<Corners, Edges> withCornerAt(Part<Corners, Edges> part, int corner, Index to)
{
  const auto ends = edgesOf(part);
  for (int k = 0; k < static_cast<int>(Edges); ++k)
  {
    if (ends[k][0] == corner || ends[k][1] == corner)
    {
      part.edges[k] = -1;
    }
  }
  part.vertices[corner] = to;
  return part;
}

template<std::size_t Corners, std::size_t Edges>
void bisect(const Part<Corners, Edges>& part, const EdgeOrder& order, const Midpoints& midpoints,
  Simplices<Corners>& cells)
{
  int cut = -1;
  for (int k = 0; k < static_cast<int>(Edges); ++k)
  {
    const Index edge = part.edges[k];
    if (edge >= 0 && midpoints.ofEdge[edge] >= 0 &&
        (cut < 0 || order.longer(edge, part.edges[cut])))
    {
      cut = k;
    }
  }
  if (cut < 0)
  {
    cells.push_back(part.vertices);
    return;
  }
  const Index m = midpoints.ofEdge[part.edges[cut]];
  const auto ends = edgesOf(part)[cut];
  bisect(withCornerAt(part, ends[1], m), order, midpoints, cells);
  bisect(withCornerAt(part, ends[0], m), order, midpoints, cells);
}

template<std::size_t Corners, std::size_t Edges>
void bisectAll(const Simplices<Corners>& cells, const std::vector<std::array<Index, Edges>>& edges,
  const EdgeOrder& order, const Midpoints& midpoints, Simplices<Corners>& children,
  std::vector<Index>& parents)
{
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    bisect(Part<Corners, Edges>{ cells[c], edges[c] }, order, midpoints, children);
    parents.resize(children.size(), static_cast<Index>(c));
  }
}

void splitTriangleUniformly(
  const std::array<Index, 3>& v, const std::array<Index, 3>& m, Simplices<3>& children)
{
  children.push_back({ v[0], m[0], m[2] });
  children.push_back({ m[0], v[1], m[1] });
  children.push_back({ m[2], m[1], v[2] });
  children.push_back({ m[0], m[1], m[2] });
}

/// The three diagonals of the octahedron between the corners, each as two midpoints and the ring of
/// the other four, in terms of the tetrahedron's local edges.
constexpr int diagonals[3][2] = { { 0, 5 }, { 1, 4 }, { 2, 3 } };
constexpr int rings[3][4] = { { 1, 3, 4, 2 }, { 2, 5, 3, 0 }, { 0, 4, 5, 1 } };

/// Whether diagonal (a, b) is shorter than (c, d); ties by the ids of their ends.
bool shorterDiagonal(const SimplexMesh& mesh, std::array<Index, 2> ab, std::array<Index, 2> cd)
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

void splitTetrahedronUniformly(const SimplexMesh& mesh, const std::array<Index, 4>& v,
  const std::array<Index, 6>& m, Simplices<4>& children)
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

template<std::size_t Edges>
std::array<Index, Edges> midpointsOf(
  const std::array<Index, Edges>& edges, const Midpoints& midpoints)
{
  std::array<Index, Edges> result;
  std::transform(
    edges.begin(), edges.end(), result.begin(), [&](Index edge) { return midpoints.ofEdge[edge]; });
  return result;
}

} // namespace

Midpoints makeMidpoints(const SimplexMesh& mesh, const EdgeTable& table, const EdgeMarks& marks)
{
  Midpoints result;
  result.ofEdge.assign(table.edges().size(), -1);
  for (std::size_t e = 0; e < table.edges().size(); ++e)
  {
    if (marks[e])
    {
      result.ofEdge[e] = static_cast<Index>(mesh.points.size() + result.edges.size());
      result.edges.push_back(static_cast<Index>(e));
      result.parentEdges.push_back(table.edges()[e]);
    }
  }
  return result;
}

SplitMesh splitMarked(const SimplexMesh& mesh, const EdgeTable& table, const Midpoints& midpoints,
  const std::vector<GlobalId>& ids)
{
  SplitMesh result = withNewPoints(mesh, midpoints, ids);
  const EdgeOrder order(table, mesh.ids);
  copyVertices(mesh, result);
  splitSegments(mesh, table, midpoints, result);
  bisectAll<3, 3>(mesh.triangles, table.ofTriangles, order, midpoints, result.mesh.triangles,
    result.parentCells[2]);
  bisectAll<4, 6>(mesh.tetrahedra, table.ofTetrahedra, order, midpoints, result.mesh.tetrahedra,
    result.parentCells[3]);
  return result;
}

SplitMesh splitUniformly(const SimplexMesh& mesh, const EdgeTable& table,
  const Midpoints& midpoints, const std::vector<GlobalId>& ids)
{
  SplitMesh result = withNewPoints(mesh, midpoints, ids);
  copyVertices(mesh, result);
  splitSegments(mesh, table, midpoints, result);
  for (std::size_t c = 0; c < mesh.triangles.size(); ++c)
  {
    splitTriangleUniformly(
      mesh.triangles[c], midpointsOf(table.ofTriangles[c], midpoints), result.mesh.triangles);
    result.parentCells[2].resize(result.mesh.triangles.size(), static_cast<Index>(c));
  }
  for (std::size_t c = 0; c < mesh.tetrahedra.size(); ++c)
  {
    splitTetrahedronUniformly(result.mesh, mesh.tetrahedra[c],
      midpointsOf(table.ofTetrahedra[c], midpoints), result.mesh.tetrahedra);
    result.parentCells[3].resize(result.mesh.tetrahedra.size(), static_cast<Index>(c));
  }
  return result;
}

} // namespace cadrefine
