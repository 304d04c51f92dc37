#include <cadrefine/refinement/Split.h>

#include <cadrefine/base/LargeMemory.h>
#include <cadrefine/base/PieceLimit.h>

#include <algorithm>
#include <utility>

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
  const std::size_t count = mesh.points.size() + midpoints.edges.size();
  reserveLong(result.mesh.points, count);
  reserveLong(result.mesh.ids, count);
  result.mesh.points.assign(mesh.points.begin(), mesh.points.end());
  result.mesh.ids.assign(mesh.ids.begin(), mesh.ids.end());
  for (const auto& ends : midpoints.parentEdges)
  {
    result.mesh.points.push_back(0.5 * (mesh.points[ends[0]] + mesh.points[ends[1]]));
  }
  result.mesh.ids.insert(result.mesh.ids.end(), ids.begin(), ids.end());
  result.parentEdges = midpoints.parentEdges;
  return result;
}

/// Children of one cell after the other.
class ChildCount
{
public:
  explicit ChildCount(std::size_t cells)
  {
    reserveLong(firsts_, cells + 1);
    firsts_.push_back(0);
  }

  void add(std::size_t children)
  {
    total_ += children;
    firsts_.push_back(static_cast<Index>(total_));
  }

  /// Where those of each cell begin. Throws Error where they are too many for one rank.
  std::vector<Index> finish()
  {
    requireAtMost(total_, "cells");
    return std::move(firsts_);
  }

private:
  std::vector<Index> firsts_;
  std::size_t total_ = 0;
};

/// Every cell has as many children.
std::vector<Index> evenChildren(std::size_t cells, Index children)
{
  requireAtMost(cells * static_cast<std::size_t>(children), "cells");
  std::vector<Index> firsts(cells + 1);
  for (std::size_t c = 0; c < firsts.size(); ++c)
  {
    firsts[c] = static_cast<Index>(c) * children;
  }
  return firsts;
}

void splitSegments(
  const SimplexMesh& mesh, const EdgeTable& table, const Midpoints& midpoints, SplitMesh& result)
{
  result.mesh.segments.reserve(result.firstChildren[1].back());
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

/// The longest of the edges that are whole and marked, as a place in `edges`, or -1.
template<std::size_t Edges, class IsMarked>
int longestMarked(
  const std::array<Index, Edges>& edges, const EdgeOrder& order, const IsMarked& isMarked)
{
  int longest = -1;
  for (int k = 0; k < static_cast<int>(Edges); ++k)
  {
    if (edges[k] >= 0 && isMarked(edges[k]) &&
        (longest < 0 || order.longer(edges[k], edges[longest])))
    {
      longest = k;
    }
  }
  return longest;
}

/// Calls use(vertices) for each leaf of the recursive bisection; vertexOf(edge) is its new vertex.
template<std::size_t Corners, std::size_t Edges, class VertexOf, class Use>
void bisect(const Part<Corners, Edges>& part, const EdgeOrder& order, const VertexOf& vertexOf,
  const Use& use)
{
  const int cut = longestMarked(part.edges, order, [&](Index edge) { return vertexOf(edge) >= 0; });
  if (cut < 0)
  {
    use(part.vertices);
    return;
  }
  const Index m = vertexOf(part.edges[cut]);
  const auto ends = edgesOf(part)[cut];
  bisect(withCornerAt(part, ends[1], m), order, vertexOf, use);
  bisect(withCornerAt(part, ends[0], m), order, vertexOf, use);
}

template<std::size_t Corners, std::size_t Edges>
void bisectAll(const Simplices<Corners>& cells, const std::vector<std::array<Index, Edges>>& edges,
  const EdgeOrder& order, const Midpoints& midpoints, const std::vector<Index>& firstChildren,
  Simplices<Corners>& children)
{
  reserveLong(children, firstChildren.back());
  const auto vertexOf = [&](Index edge) { return midpoints.ofEdge[edge]; };
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    if (firstChildren[c + 1] - firstChildren[c] == 1)
    {
      children.push_back(cells[c]);
    }
    else
    {
      bisect(Part<Corners, Edges>{ cells[c], edges[c] }, order, vertexOf,
        [&](const std::array<Index, Corners>& child) { children.push_back(child); });
    }
  }
}

template<std::size_t Corners, std::size_t Edges>
std::vector<Index> countParts(const std::vector<std::array<Index, Edges>>& cellEdges,
  const EdgeOrder& order, const EdgeMarks& marks)
{
  const auto vertexOf = [&](Index edge) { return marks[edge] ? 0 : -1; };
  ChildCount count(cellEdges.size());
  for (const auto& edges : cellEdges)
  {
    std::size_t children = 1;
    if (std::any_of(edges.begin(), edges.end(), [&](Index edge) { return marks[edge] != 0; }))
    {
      children = 0;
      bisect(Part<Corners, Edges>{ {}, edges }, order, vertexOf, [&](const auto&) { ++children; });
    }
    count.add(children);
  }
  return count.finish();
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
  const std::size_t count = marks.size() - std::count(marks.begin(), marks.end(), 0);
  requireAtMost(mesh.points.size() + count, "points");
  reserveLong(result.edges, count);
  reserveLong(result.parentEdges, count);
  reserveLong(result.ofEdge, table.edges.size());
  result.ofEdge.assign(table.edges.size(), -1);
  for (std::size_t e = 0; e < table.edges.size(); ++e)
  {
    if (marks[e])
    {
      result.ofEdge[e] = static_cast<Index>(mesh.points.size() + result.edges.size());
      result.edges.push_back(static_cast<Index>(e));
      result.parentEdges.push_back(table.edges[e]);
    }
  }
  return result;
}

ChildRanges countMarkedChildren(
  const SimplexMesh& mesh, const EdgeTable& table, const EdgeMarks& marks)
{
  const EdgeOrder order(table);
  ChildRanges firsts;
  firsts[0] = evenChildren(mesh.vertices.size(), 1);
  ChildCount ofSegments(table.ofSegments.size());
  for (const Index edge : table.ofSegments)
  {
    ofSegments.add(marks[edge] ? 2 : 1);
  }
  firsts[1] = ofSegments.finish();
  firsts[2] = countParts<3>(table.ofTriangles, order, marks);
  firsts[3] = countParts<4>(table.ofTetrahedra, order, marks);
  return firsts;
}

ChildRanges countUniformChildren(const SimplexMesh& mesh)
{
  return { evenChildren(mesh.vertices.size(), 1), evenChildren(mesh.segments.size(), 2),
    evenChildren(mesh.triangles.size(), 4), evenChildren(mesh.tetrahedra.size(), 8) };
}

SplitMesh splitMarked(const SimplexMesh& mesh, const EdgeTable& table, const EdgeMarks& marks,
  const Midpoints& midpoints, const std::vector<GlobalId>& ids)
{
  SplitMesh result = withNewPoints(mesh, midpoints, ids);
  const EdgeOrder order(table);
  result.firstChildren = countMarkedChildren(mesh, table, marks);
  result.mesh.vertices = mesh.vertices;
  splitSegments(mesh, table, midpoints, result);
  bisectAll<3, 3>(mesh.triangles, table.ofTriangles, order, midpoints, result.firstChildren[2],
    result.mesh.triangles);
  bisectAll<4, 6>(mesh.tetrahedra, table.ofTetrahedra, order, midpoints, result.firstChildren[3],
    result.mesh.tetrahedra);
  return result;
}

SplitMesh splitUniformly(const SimplexMesh& mesh, const EdgeTable& table,
  const Midpoints& midpoints, const std::vector<GlobalId>& ids)
{
  SplitMesh result = withNewPoints(mesh, midpoints, ids);
  result.firstChildren = countUniformChildren(mesh);
  result.mesh.vertices = mesh.vertices;
  splitSegments(mesh, table, midpoints, result);
  reserveLong(result.mesh.triangles, result.firstChildren[2].back());
  for (std::size_t c = 0; c < mesh.triangles.size(); ++c)
  {
    splitTriangleUniformly(
      mesh.triangles[c], midpointsOf(table.ofTriangles[c], midpoints), result.mesh.triangles);
  }
  reserveLong(result.mesh.tetrahedra, result.firstChildren[3].back());
  for (std::size_t c = 0; c < mesh.tetrahedra.size(); ++c)
  {
    splitTetrahedronUniformly(result.mesh, mesh.tetrahedra[c],
      midpointsOf(table.ofTetrahedra[c], midpoints), result.mesh.tetrahedra);
  }
  return result;
}

} // namespace cadrefine
