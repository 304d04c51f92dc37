#include "LongestEdgeMarking.h"

namespace cadrefine
{
namespace
{

/// The longest of `count` edges.
Index longest(const EdgeOrder& order, const Index* edges, int count)
{
  Index result = edges[0];
  for (int k = 1; k < count; ++k)
  {
    result = order.longer(edges[k], result) ? edges[k] : result;
  }
  return result;
}

bool mark(EdgeMarks& marks, Index edge)
{
  const bool isNew = marks[edge] == 0;
  marks[edge] = 1;
  return isNew;
}

bool closeTriangle(const EdgeOrder& order, const std::array<Index, 3>& edges, EdgeMarks& marks)
{
  const int marked = marks[edges[0]] + marks[edges[1]] + marks[edges[2]];
  return marked != 0 && marked != 3 && mark(marks, longest(order, edges.data(), 3));
}

bool closeTetrahedron(const EdgeOrder& order, const std::array<Index, 6>& edges, EdgeMarks& marks)
{
  int marked = 0;
  for (const Index edge : edges)
  {
    marked += marks[edge];
  }
  if (marked == 0 || marked == 6)
  {
    return false;
  }
  bool changed = mark(marks, longest(order, edges.data(), 6));
  for (const auto& face : tetrahedronFaceEdges)
  {
    changed |= closeTriangle(order, { edges[face[0]], edges[face[1]], edges[face[2]] }, marks);
  }
  return changed;
}

} // namespace

void markLongestEdges(const SimplexMesh& mesh, const EdgeTable& table,
  const std::vector<unsigned char>& cellMarks, EdgeMarks& marks)
{
  const EdgeOrder order(table);
  for (std::size_t c = 0; c < cellMarks.size(); ++c)
  {
    if (cellMarks[c])
    {
      marks[mesh.dimension == 3 ? longest(order, table.ofTetrahedra[c].data(), 6)
                                : longest(order, table.ofTriangles[c].data(), 3)] = 1;
    }
  }
}

bool closeMarks(const EdgeTable& table, EdgeMarks& marks)
{
  const EdgeOrder order(table);
  bool changedEver = false;
  for (bool changed = true; changed;)
  {
    changed = false;
    for (const auto& edges : table.ofTetrahedra)
    {
      changed |= closeTetrahedron(order, edges, marks);
    }
    for (const auto& edges : table.ofTriangles)
    {
      changed |= closeTriangle(order, edges, marks);
    }
    changedEver |= changed;
  }
  return changedEver;
}

} // namespace cadrefine
