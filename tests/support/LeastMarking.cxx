#include "LeastMarking.h"

#include <cadrefine/base/Vector3.h>

#include <algorithm>
#include <tuple>

namespace cadtest
{

using namespace cadrefine;

namespace
{

/// Length and ids of an edge, by which edges are ordered.
struct OrderedEdge
{
  double squaredLength;
  IdPair ids;
  friend bool operator<(const OrderedEdge& a, const OrderedEdge& b)
  {
    return std::tie(a.squaredLength, a.ids) < std::tie(b.squaredLength, b.ids);
  }
};

OrderedEdge orderedEdge(const Mesh& mesh, Index a, Index b)
{
  if (mesh.ids[b] < mesh.ids[a])
  {
    std::swap(a, b);
  }
  return { squaredNorm(mesh.points[b] - mesh.points[a]), { mesh.ids[a], mesh.ids[b] } };
}

/// All edges of a cell, and the triangles among its corners, as the rules say it.
std::vector<std::vector<OrderedEdge>> simplicesOf(const Mesh& mesh, const std::vector<Index>& cell)
{
  std::vector<std::vector<OrderedEdge>> result;
  for (unsigned subset = 1; subset < 1u << cell.size(); ++subset)
  {
    std::vector<Index> corners;
    for (std::size_t k = 0; k < cell.size(); ++k)
    {
      if (subset & (1u << k))
      {
        corners.push_back(cell[k]);
      }
    }
    if (corners.size() >= 3)
    {
      auto& edges = result.emplace_back();
      for (std::size_t i = 0; i < corners.size(); ++i)
      {
        for (std::size_t j = 0; j < i; ++j)
        {
          edges.push_back(orderedEdge(mesh, corners[i], corners[j]));
        }
      }
    }
  }
  return result;
}

} // namespace

std::vector<std::vector<Index>> cellsOf(const Mesh& mesh)
{
  std::vector<std::vector<Index>> cells;
  for (const auto& cell : mesh.tetrahedra)
  {
    cells.emplace_back(cell.begin(), cell.end());
  }
  for (const auto& cell : mesh.triangles)
  {
    cells.emplace_back(cell.begin(), cell.end());
  }
  return cells;
}

std::set<IdPair> leastMarking(const Mesh& mesh, const std::vector<unsigned char>& cellMarks)
{
  std::vector<std::vector<OrderedEdge>> simplices;
  std::set<IdPair> marked;
  const auto cells = cellsOf(mesh);
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    const auto ofCell = simplicesOf(mesh, cells[c]);
    simplices.insert(simplices.end(), ofCell.begin(), ofCell.end());
    if (cellMarks[c])
    {
      marked.insert(std::max_element(ofCell.back().begin(), ofCell.back().end())->ids);
    }
  }
  for (std::size_t before = 0; before != marked.size();)
  {
    before = marked.size();
    for (const auto& edges : simplices)
    {
      if (std::any_of(edges.begin(), edges.end(),
            [&](const OrderedEdge& edge) { return marked.count(edge.ids) > 0; }))
      {
        marked.insert(std::max_element(edges.begin(), edges.end())->ids);
      }
    }
  }
  return marked;
}

} // namespace cadtest
