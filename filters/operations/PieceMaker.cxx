#include "operations/PieceMaker.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace cadrefine
{
namespace
{

/// By their parents; where those of each begin.
template<std::size_t Corners>
void order(std::vector<Descendant<Corners>>& descendants, std::size_t parentCount,
  Simplices<Corners>& cells, std::vector<Index>& firsts)
{
  std::stable_sort(descendants.begin(), descendants.end(),
    [](const auto& a, const auto& b) { return a.parent < b.parent; });
  firsts.assign(parentCount + 1, 0);
  for (const auto& descendant : descendants)
  {
    cells.push_back(descendant.corners);
    ++firsts[descendant.parent + 1];
  }
  std::partial_sum(firsts.begin(), firsts.end(), firsts.begin());
}

} // namespace

void PieceMaker::keep(const Members& others)
{
  const auto keepAll = [](const auto& cells, const std::vector<Index>& kept, auto& into)
  {
    for (const Index cell : kept)
    {
      into.push_back({ cell, cells[cell] });
    }
  };
  if (mesh_.dimension == 3)
  {
    keepAll(mesh_.tetrahedra, others.cells, tetrahedra_);
  }
  keepAll(mesh_.triangles, mesh_.dimension == 3 ? others.triangles : others.cells, triangles_);
  keepAll(mesh_.segments, others.segments, segments_);
}

void PieceMaker::add(
  const BlockMesh& block, const std::vector<AddedVertex>& added, std::int64_t number)
{
  const EditableMesh& result = block.mesh();
  std::vector<Index> vertices = block.vertices();
  for (std::size_t v = 0; v < vertices.size(); ++v)
  {
    points_[vertices[v]] = result.vertex(static_cast<Index>(v)).point;
  }
  for (const AddedVertex& vertex : added)
  {
    points_.push_back(result.vertex(static_cast<Index>(vertices.size())).point);
    vertices.push_back(static_cast<Index>(points_.size()) - 1);
    std::array<Index, 2> ends{ vertices[vertex.parents[0]], vertices[vertex.parents[1]] };
    if (comesBefore(ends[1], ends[0]))
    {
      std::swap(ends[0], ends[1]);
    }
    parents_.push_back(ends);
    places_.push_back(vertex.where);
    blocks_.push_back(number);
  }
  const auto take = [&](const auto& store, auto& into)
  {
    for (std::size_t s = 0; s < store.size(); ++s)
    {
      const auto simplex = static_cast<Index>(s);
      if (store.exists(simplex) && store[simplex].parent >= 0)
      {
        auto corners = store[simplex].corners;
        std::transform(
          corners.begin(), corners.end(), corners.begin(), [&](Index v) { return vertices[v]; });
        into.push_back({ store[simplex].parent, corners });
      }
    }
  };
  take(result.cells(), tetrahedra_);
  take(result.facets(), triangles_);
  take(result.segments(), segments_);
}

SimplexMesh PieceMaker::make(ChildRanges& firstChildren)
{
  SimplexMesh result;
  result.dimension = mesh_.dimension;
  result.points = points_;
  result.ids = mesh_.ids;
  result.vertices = mesh_.vertices;
  firstChildren[0].resize(mesh_.vertices.size() + 1);
  std::iota(firstChildren[0].begin(), firstChildren[0].end(), 0);
  order(segments_, mesh_.segments.size(), result.segments, firstChildren[1]);
  order(triangles_, mesh_.triangles.size(), result.triangles, firstChildren[2]);
  order(tetrahedra_, mesh_.tetrahedra.size(), result.tetrahedra, firstChildren[3]);
  return result;
}

/// By ids, which grow with the numbers of new vertices.
bool PieceMaker::comesBefore(Index a, Index b) const
{
  const auto old = static_cast<Index>(mesh_.ids.size());
  return a < old && b < old ? mesh_.ids[a] < mesh_.ids[b] : a < b;
}

} // namespace cadrefine
