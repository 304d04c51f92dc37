#include <cadrefine/mesh/EdgeTable.h>

#include <cadrefine/base/LargeMemory.h>
#include <cadrefine/base/PieceLimit.h>
#include <cadrefine/base/RadixOrder.h>
#include <cadrefine/base/VertexBuckets.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

namespace cadrefine
{
namespace
{

/// Vertices in the order of their ids.
std::vector<Index> orderByIds(const std::vector<GlobalId>& ids)
{
  std::vector<PlacedKey> keys(ids.size());
  for (std::size_t v = 0; v < ids.size(); ++v)
  {
    keys[v] = { orderedBits(ids[v]), static_cast<std::uint32_t>(v) };
  }
  radixSort(keys);
  std::vector<Index> order(ids.size());
  std::transform(keys.begin(), keys.end(), order.begin(),
    [](const PlacedKey& key) { return static_cast<Index>(key.place); });
  return order;
}

/// Calls use(place, a, b) for the edges of the cells in turn, `place` counting where the number of
/// the edge is to stand.
template<std::size_t Corners, std::size_t Edges, class Use>
void forEachCellEdge(
  const Cells<Corners>& cells, const int (&ends)[Edges][2], std::size_t& place, const Use& use)
{
  for (const auto& cell : cells)
  {
    for (const auto& [i, k] : ends)
    {
      use(place++, cell[i], cell[k]);
    }
  }
}

/// Calls visit(shape, cells) for the shapes that have edges, those of the highest dimension first.
template<class Visit>
void visitWithEdges(const Mesh& mesh, const Visit& visit)
{
  for (int d = 3; d > 0; --d)
  {
    visitShapes(mesh, d,
      [&](auto shape, const auto& cells)
      {
        if constexpr (decltype(shape)::dimension > 0)
        {
          visit(shape, cells);
        }
      });
  }
}

template<class Use>
void forEachCellEdge(const Mesh& mesh, const Use& use)
{
  std::size_t place = 0;
  visitWithEdges(mesh, [&](auto shape, const auto& cells)
    { forEachCellEdge(cells, decltype(shape)::edges, place, use); });
}

std::size_t countCellEdges(const Mesh& mesh)
{
  std::size_t count = 0;
  visitWithEdges(mesh, [&](auto shape, const auto& cells)
    { count += std::size(decltype(shape)::edges) * cells.size(); });
  return count;
}

/// A cell's edge in the bucket of its end of lower position.
struct CellEdge
{
  Index other; ///< Position of its other end.
  std::uint32_t place;

  static constexpr std::size_t most = std::numeric_limits<std::uint32_t>::max();
};

/// Finds where the number of a cell's edge stands in the table.
class CellEdgePlaces
{
public:
  CellEdgePlaces(const Mesh& mesh, EdgeTable& table)
  {
    std::size_t place = 0;
    visitWithEdges(mesh,
      [&](auto shape, const auto& cells)
      {
        auto& edges = table.*edgesOfCells(shape);
        resizeLong(edges, cells.size());
        place += std::size(decltype(shape)::edges) * cells.size();
        if (!cells.empty())
        {
          runs_.push_back({ place, edges.front().data() });
        }
      });
    // Nearly as many edges as there are, by Euler: a ball has one for each vertex and tetrahedron,
    // and one for two boundary triangles; a disc one for each vertex and triangle. Hexahedra have
    // some three for each vertex.
    reserveLong(table.edges, mesh.points.size() + mesh.cellCount());
  }

  Index& operator[](std::size_t place)
  {
    std::size_t first = 0;
    const Run* run = runs_.data();
    for (; place >= run->end; ++run)
    {
      first = run->end;
    }
    return run->edges[place - first];
  }

private:
  /// The edges of the cells of one shape.
  struct Run
  {
    std::size_t end; ///< Place after the last one.
    Index* edges;
  };
  std::vector<Run> runs_;
};

/// Numbers the edges of each bucket in turn, in the order of their other ends.
class EdgeNumberer
{
public:
  EdgeNumberer(const Mesh& mesh, const std::vector<Index>& order, EdgeTable& table)
    : order_(order), table_(table), places_(mesh, table), edgeTo_(order.size(), -1)
  {
    table_.firstOfPosition.reserve(order.size() + 1);
    table_.firstOfPosition.push_back(0);
  }

  void operator()(Index position, const CellEdge* first, const CellEdge* last)
  {
    const Index firstEdge = table_.firstOfPosition.back();
    others_.clear();
    for (const CellEdge* edge = first; edge != last; ++edge)
    {
      if (edgeTo_[edge->other] < firstEdge)
      {
        edgeTo_[edge->other] = firstEdge; // seen; which edge it is follows below
        others_.push_back(edge->other);
      }
    }
    std::sort(others_.begin(), others_.end());
    for (const Index other : others_)
    {
      edgeTo_[other] = static_cast<Index>(table_.edges.size());
      table_.edges.push_back({ order_[position], order_[other] });
    }
    for (const CellEdge* edge = first; edge != last; ++edge)
    {
      places_[edge->place] = edgeTo_[edge->other];
    }
    table_.firstOfPosition.push_back(static_cast<Index>(table_.edges.size()));
  }

private:
  const std::vector<Index>& order_;
  EdgeTable& table_;
  CellEdgePlaces places_;
  std::vector<Index> edgeTo_; ///< The last edge that was found to end at a position.
  std::vector<Index> others_;
};

void measureLengths(const Mesh& mesh, EdgeTable& table)
{
  resizeLong(table.squaredLengths, table.edges.size());
  std::transform(table.edges.begin(), table.edges.end(), table.squaredLengths.begin(),
    [&](const std::array<Index, 2>& ends)
    { return squaredNorm(mesh.points[ends[1]] - mesh.points[ends[0]]); });
}

} // namespace

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

Index EdgeTable::find(Index a, Index b) const
{
  const auto [low, high] = std::minmax(positionOfVertex[a], positionOfVertex[b]);
  const auto last = edges.begin() + firstOfPosition[low + 1];
  const auto found = std::lower_bound(edges.begin() + firstOfPosition[low], last, high,
    [&](const std::array<Index, 2>& ends, Index position)
    { return positionOfVertex[ends[1]] < position; });
  return found != last && positionOfVertex[(*found)[1]] == high
           ? static_cast<Index>(found - edges.begin())
           : -1;
}

EdgeTable buildEdgeTable(const Mesh& mesh)
{
  requireAtMost(countCellEdges(mesh), "edges of cells", CellEdge::most);
  EdgeTable table;
  const std::vector<Index> order = orderByIds(mesh.ids);
  table.positionOfVertex.resize(order.size());
  for (std::size_t position = 0; position < order.size(); ++position)
  {
    table.positionOfVertex[order[position]] = static_cast<Index>(position);
  }
  const auto& positions = table.positionOfVertex;
  VertexBuckets<CellEdge> cellEdges(order.size(),
    [&](const auto& use)
    {
      forEachCellEdge(mesh,
        [&](std::size_t place, Index a, Index b)
        {
          const auto [low, high] = std::minmax(positions[a], positions[b]);
          use(low, { high, static_cast<std::uint32_t>(place) });
        });
    });

  EdgeNumberer numberer(mesh, order, table);
  cellEdges.forEach([&](Index position, const CellEdge* first, const CellEdge* last)
    { numberer(position, first, last); });
  requireAtMost(table.edges.size(), "edges");
  measureLengths(mesh, table);
  return table;
}

} // namespace cadrefine
