// Recursive bisection of a simplex at the longest of its marked edges.
#pragma once

#include <cadrefine/mesh/EdgeTable.h>
#include <cadrefine/mesh/Mesh.h>

#include <array>

namespace cadrefine
{

/// A part of a cell under bisection: its vertices, and which of its edges are whole edges of the
/// mesh (-1: cut from one, or new).
template<std::size_t Corners, std::size_t Edges>
struct Part
{
  std::array<Index, Corners> vertices;
  std::array<Index, Edges> edges;
};

inline const int (*edgesOf(Part<3, 3>))[2]
{
  return triangleEdges;
}

inline const int (*edgesOf(Part<4, 6>))[2]
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

} // namespace cadrefine
