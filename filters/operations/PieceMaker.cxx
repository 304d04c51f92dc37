#include "operations/PieceMaker.h"

#include <cadrefine/base/LargeMemory.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace cadrefine
{
namespace
{

/// Puts together the cells that are kept and, in place of the others, their descendants, those of
/// one cell in the order in which they came. `firsts`: where the descendants of each cell begin.
/// Sorts the descendants by parents.
template<std::size_t Corners>
void merge(const Cells<Corners>& cells, const std::vector<Index>& kept,
  std::vector<Descendant<Corners>>& descendants, Cells<Corners>& result, std::vector<Index>& firsts)
{
  std::stable_sort(descendants.begin(), descendants.end(),
    [](const auto& a, const auto& b) { return a.parent < b.parent; });
  reserveLong(result, kept.size() + descendants.size());
  reserveLong(firsts, cells.size() + 1);
  auto nextKept = kept.begin();
  auto next = descendants.begin();
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    const auto cell = static_cast<Index>(c);
    firsts.push_back(static_cast<Index>(result.size()));
    if (nextKept != kept.end() && *nextKept == cell)
    {
      result.push_back(cells[c]);
      ++nextKept;
    }
    for (; next != descendants.end() && next->parent == cell; ++next)
    {
      result.push_back(next->corners);
    }
  }
  firsts.push_back(static_cast<Index>(result.size()));
}

/// Appends rows, with targets and sources mapped by functions.
template<class Target, class Source>
void append(
  const WeightedRows& rows, const Target& targetOf, const Source& sourceOf, WeightedRows& into)
{
  for (std::size_t r = 0; r < rows.size(); ++r)
  {
    for (Index k = rows.firsts[r]; k < rows.firsts[r + 1]; ++k)
    {
      into.add(sourceOf(rows.sources[k]), rows.weights[k]);
    }
    into.endRow(targetOf(rows.targets[r]));
  }
}

/// A row, and the target that it gets.
struct PlacedRow
{
  Index target;
  Index row;
};

/// These rows in this order, with `firstSource` added to their sources; empty if there are none.
WeightedRows inOrder(
  const WeightedRows& rows, const std::vector<PlacedRow>& order, Index firstSource)
{
  WeightedRows result;
  for (const auto& [target, row] : rows.empty() ? std::vector<PlacedRow>() : order)
  {
    for (Index k = rows.firsts[row]; k < rows.firsts[row + 1]; ++k)
    {
      result.add(firstSource + rows.sources[k], rows.weights[k]);
    }
    result.endRow(target);
  }
  return result;
}

} // namespace

void PieceMaker::add(const BlockMesh& block, const std::vector<AddedVertex>& added,
  const FieldRows& rows, std::int64_t number)
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
    onBoundary_.push_back(vertex.onBoundary);
    blocks_.push_back(number);
  }
  const auto firstRow = static_cast<Index>(rows_.ofCells.size());
  const auto take = [&](const auto& store, auto& into, bool hasRows)
  {
    const std::vector<Index>& withRow = rows.ofCells.targets;
    for (std::size_t s = 0; s < store.size(); ++s)
    {
      const auto simplex = static_cast<Index>(s);
      if (store.exists(simplex) && store[simplex].parent >= 0)
      {
        auto corners = store[simplex].corners;
        std::transform(
          corners.begin(), corners.end(), corners.begin(), [&](Index v) { return vertices[v]; });
        const auto row = std::lower_bound(withRow.begin(), withRow.end(), simplex);
        const bool hasOne = hasRows && row != withRow.end() && *row == simplex;
        into.push_back({ store[simplex].parent, corners,
          hasOne ? firstRow + static_cast<Index>(row - withRow.begin()) : -1 });
      }
    }
  };
  take(result.cells(), tetrahedra_, mesh_.dimension == 3);
  take(result.facets(), triangles_, mesh_.dimension == 2);
  take(result.segments(), segments_, false);
  addRows(block, vertices, rows);
}

/// Adds the rows of a block. Those of cells get their targets later, when the cells have their
/// numbers.
void PieceMaker::addRows(
  const BlockMesh& block, const std::vector<Index>& vertices, const FieldRows& rows)
{
  const auto vertexOf = [&](Index vertex) { return vertices[vertex]; };
  append(rows.ofVertices, vertexOf, vertexOf, rows_.ofVertices);
  const EditableMesh& mesh = block.mesh();
  const auto parentOf = [&](Index cell)
  { return mesh_.dimension == 3 ? mesh.cells()[cell].parent : mesh.facets()[cell].parent; };
  const auto later = [](Index) { return Index{ -1 }; };
  append(rows.ofCells, later, parentOf, rows_.ofCells);
  append(rows.ofDensities, later, parentOf, rows_.ofDensities);
}

Mesh PieceMaker::make(RefinementTrace& trace)
{
  Mesh result;
  result.dimension = mesh_.dimension;
  result.wedgesAsDocumented = mesh_.wedgesAsDocumented;
  result.points = std::move(points_);
  result.ids = mesh_.ids;
  result.vertices = mesh_.vertices;
  ChildRanges& firstChildren = trace.firstChildren;
  firstChildren[0].resize(mesh_.vertices.size() + 1);
  std::iota(firstChildren[0].begin(), firstChildren[0].end(), 0);
  merge(mesh_.segments, others_.segments, segments_, result.segments, firstChildren[1]);
  merge(mesh_.triangles, mesh_.dimension == 3 ? others_.triangles : others_.cells, triangles_,
    result.triangles, firstChildren[2]);
  merge(mesh_.tetrahedra, mesh_.dimension == 3 ? others_.cells : std::vector<Index>(), tetrahedra_,
    result.tetrahedra, firstChildren[3]);
  result.quadrilaterals = mesh_.quadrilaterals;
  result.pyramids = mesh_.pyramids;
  result.wedges = mesh_.wedges;
  result.hexahedra = mesh_.hexahedra;
  for (int d = 2; d < 4; ++d)
  {
    const std::size_t others = mesh_.cellCount(d) - (firstChildren[d].size() - 1);
    for (std::size_t c = 0; c < others; ++c)
    {
      firstChildren[d].push_back(firstChildren[d].back() + 1);
    }
  }
  trace.parentEdges = parents_;
  placeRows(result, trace);
  return result;
}

/// Writes the rows into the trace, in the order of their targets.
void PieceMaker::placeRows(const Mesh& made, RefinementTrace& trace) const
{
  std::vector<PlacedRow> ofVertices;
  for (std::size_t r = 0; r < rows_.ofVertices.size(); ++r)
  {
    ofVertices.push_back({ rows_.ofVertices.targets[r], static_cast<Index>(r) });
  }
  std::sort(ofVertices.begin(), ofVertices.end(),
    [](const PlacedRow& a, const PlacedRow& b) { return a.target < b.target; });
  trace.ofVertices = inOrder(rows_.ofVertices, ofVertices, 0);

  std::vector<PlacedRow> ofCells;
  const auto firstCell = static_cast<Index>(firstCellOfDimension(made, made.dimension));
  const std::vector<Index>& firstChildren = trace.firstChildren[made.dimension];
  const auto find = [&](const auto& descendants)
  {
    Index sibling = 0;
    for (std::size_t i = 0; i < descendants.size(); ++i)
    {
      const auto& [parent, corners, row] = descendants[i];
      sibling = i > 0 && parent == descendants[i - 1].parent ? sibling + 1 : 0;
      if (row >= 0)
      {
        ofCells.push_back({ firstCell + firstChildren[parent] + sibling, row });
      }
    }
  };
  made.dimension == 3 ? find(tetrahedra_) : find(triangles_);
  const auto firstSource = static_cast<Index>(firstCellOfDimension(mesh_, mesh_.dimension));
  trace.ofCells = inOrder(rows_.ofCells, ofCells, firstSource);
  trace.ofDensities = inOrder(rows_.ofDensities, ofCells, firstSource);
}

/// Whether vertex `a` has the smaller id; the ids of new vertices grow with their numbers.
bool PieceMaker::comesBefore(Index a, Index b) const
{
  const auto old = static_cast<Index>(mesh_.ids.size());
  return a < old && b < old ? mesh_.ids[a] < mesh_.ids[b] : a < b;
}

} // namespace cadrefine
