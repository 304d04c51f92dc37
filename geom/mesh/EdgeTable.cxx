#include "EdgeTable.h"

#include <utility>

namespace cadrefine
{

Index EdgeList::find(Index a, Index b) const
{
  if ((*ids_)[b] < (*ids_)[a])
  {
    std::swap(a, b);
  }
  Index edge = firstOfVertex_[a];
  while (edge >= 0 && edges_[edge][1] != b)
  {
    edge = next_[edge];
  }
  return edge;
}

Index EdgeList::findOrAdd(Index a, Index b)
{
  const Index found = find(a, b);
  if (found >= 0)
  {
    return found;
  }
  if ((*ids_)[b] < (*ids_)[a])
  {
    std::swap(a, b);
  }
  const auto edge = static_cast<Index>(edges_.size());
  edges_.push_back({ a, b });
  next_.push_back(firstOfVertex_[a]);
  firstOfVertex_[a] = edge;
  return edge;
}

EdgeTable buildEdgeTable(const SimplexMesh& mesh)
{
  EdgeTable table;
  table.list = EdgeList(mesh.ids);
  EdgeList& builder = table.list;
  table.ofTetrahedra.reserve(mesh.tetrahedra.size());
  for (const auto& cell : mesh.tetrahedra)
  {
    auto& edges = table.ofTetrahedra.emplace_back();
    for (int k = 0; k < 6; ++k)
    {
      edges[k] = builder.findOrAdd(cell[tetrahedronEdges[k][0]], cell[tetrahedronEdges[k][1]]);
    }
  }
  table.ofTriangles.reserve(mesh.triangles.size());
  for (const auto& cell : mesh.triangles)
  {
    auto& edges = table.ofTriangles.emplace_back();
    for (int k = 0; k < 3; ++k)
    {
      edges[k] = builder.findOrAdd(cell[triangleEdges[k][0]], cell[triangleEdges[k][1]]);
    }
  }
  for (const auto& cell : mesh.segments)
  {
    table.ofSegments.push_back(builder.findOrAdd(cell[0], cell[1]));
  }
  table.squaredLengths.reserve(table.edges().size());
  for (const auto& ends : table.edges())
  {
    table.squaredLengths.push_back(squaredNorm(mesh.points[ends[1]] - mesh.points[ends[0]]));
  }
  return table;
}

} // namespace cadrefine
