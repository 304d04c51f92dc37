#include <cadrefine/refinement/LongestEdgeMarking.h>

#include <algorithm>

namespace cadrefine
{
namespace
{

template<std::size_t Edges>
bool isPartlyMarked(const EdgeMarks& marks, const std::array<Index, Edges>& edges)
{
  std::size_t marked = 0;
  for (const Index edge : edges)
  {
    marked += marks[edge];
  }
  return marked != 0 && marked != Edges;
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
      marks[mesh.dimension == 3 ? order.longest(table.ofTetrahedra[c])
                                : order.longest(table.ofTriangles[c])] = 1;
    }
  }
}

MarkClosure::MarkClosure(const EdgeTable& table, EdgeMarks& marks)
  : table_(table), order_(table), marks_(marks)
{
}

bool MarkClosure::closeAll()
{
  sweep();
  const bool changed = !fresh_.empty();
  close();
  return changed;
}

bool MarkClosure::closeFrom(const std::vector<Index>& edges)
{
  fresh_ = edges;
  return close();
}

/// Until no cell waits for a look. Returns true where an edge was marked.
bool MarkClosure::close()
{
  bool changed = false;
  while (!fresh_.empty() && sweepsLeft_ > 0)
  {
    sweep();
    changed |= !fresh_.empty();
  }
  return spread() || changed;
}

/// Looks at every cell; what was fresh before is not any more.
void MarkClosure::sweep()
{
  --sweepsLeft_;
  fresh_.clear();
  looks_ += table_.ofTetrahedra.size() + table_.ofTriangles.size();
  for (const auto& edges : table_.ofTetrahedra)
  {
    lookAt(edges);
  }
  for (const auto& edges : table_.ofTriangles)
  {
    lookAt(edges);
  }
}

/// Looks at the cells at fresh edges only. Returns true where an edge was marked.
bool MarkClosure::spread()
{
  if (fresh_.empty())
  {
    return false;
  }
  if (!cellsAt_)
  {
    listCells();
  }
  const std::size_t begun = fresh_.size();
  for (std::size_t i = 0; i < fresh_.size(); ++i)
  {
    const auto [first, last] = cellsAt_->at(fresh_[i]);
    std::for_each(first, last, [&](std::uint32_t cell) { lookAtCell(cell); });
  }
  const bool changed = fresh_.size() > begun;
  fresh_.clear();
  return changed;
}

void MarkClosure::listCells()
{
  cellsAt_.emplace(table_.edges.size(),
    [&](const auto& use)
    {
      std::uint32_t cell = 0;
      const auto useAll = [&](const auto& edges)
      {
        std::for_each(edges.begin(), edges.end(), [&](Index edge) { use(edge, cell); });
        ++cell;
      };
      std::for_each(table_.ofTetrahedra.begin(), table_.ofTetrahedra.end(), useAll);
      std::for_each(table_.ofTriangles.begin(), table_.ofTriangles.end(), useAll);
    });
}

void MarkClosure::lookAtCell(std::uint32_t cell)
{
  ++looks_;
  const std::size_t tetrahedra = table_.ofTetrahedra.size();
  if (cell < tetrahedra)
  {
    lookAt(table_.ofTetrahedra[cell]);
  }
  else
  {
    lookAt(table_.ofTriangles[cell - tetrahedra]);
  }
}

template<class Edges>
void MarkClosure::lookAt(const Edges& edges)
{
  if (isPartlyMarked(marks_, edges))
  {
    markLongest(edges);
  }
}

/// Of the tetrahedron, and of its faces.
void MarkClosure::markLongest(const std::array<Index, 6>& edges)
{
  mark(order_.longest(edges));
  for (const auto& face : tetrahedronFaceEdges)
  {
    lookAt(std::array<Index, 3>{ edges[face[0]], edges[face[1]], edges[face[2]] });
  }
}

void MarkClosure::markLongest(const std::array<Index, 3>& edges)
{
  mark(order_.longest(edges));
}

void MarkClosure::mark(Index edge)
{
  if (!marks_[edge])
  {
    marks_[edge] = 1;
    fresh_.push_back(edge);
  }
}

} // namespace cadrefine
