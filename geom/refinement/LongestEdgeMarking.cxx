#include <cadrefine/refinement/LongestEdgeMarking.h>

#include <cadrefine/base/DisjointSets.h>
#include <cadrefine/mesh/ThinCells.h>

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

template<std::size_t Count, std::size_t Edges>
std::array<Index, Count> chosen(
  const std::array<Index, Edges>& edges, const std::array<int, Count>& places)
{
  std::array<Index, Count> result;
  std::transform(places.begin(), places.end(), result.begin(), [&](int k) { return edges[k]; });
  return result;
}

/// A triangle of a wedge or pyramid, by its local edges.
using LocalTriangle = std::array<int, 3>;
constexpr LocalTriangle wedgeTriangles[2] = { { 0, 1, 2 }, { 3, 4, 5 } };
constexpr LocalTriangle pyramidTriangles[4] = { { 0, 5, 4 }, { 1, 6, 5 }, { 2, 7, 6 },
  { 3, 4, 7 } };

/// Two edges that lie over each other, seen along one direction, and their own direction.
struct EdgePair
{
  int direction;
  int edge;
  int over;
};
constexpr EdgePair hexahedronPairs[3][4] = { { { 1, 3, 1 }, { 1, 7, 5 }, { 2, 8, 9 },
                                               { 2, 11, 10 } },
  { { 0, 0, 2 }, { 0, 4, 6 }, { 2, 8, 11 }, { 2, 9, 10 } },
  { { 0, 0, 4 }, { 0, 2, 6 }, { 1, 1, 5 }, { 1, 3, 7 } } };

/// The mean of the squared lengths of some of a cell's edges.
template<std::size_t Edges, std::size_t Count>
double meanSquareOf(
  const EdgeTable& table, const std::array<Index, Edges>& edges, const int (&places)[Count])
{
  double sum = 0;
  for (const int place : places)
  {
    sum += table.squaredLengths[edges[place]];
  }
  return sum / Count;
}

/// That mean for each direction of a cell.
template<std::size_t Edges, std::size_t Directions, std::size_t Parallel>
std::array<double, Directions> meanSquaresIn(const EdgeTable& table,
  const std::array<Index, Edges>& edges, const int (&directions)[Directions][Parallel])
{
  std::array<double, Directions> meanSquares;
  std::transform(std::begin(directions), std::end(directions), meanSquares.begin(),
    [&](const auto& places) { return meanSquareOf(table, edges, places); });
  return meanSquares;
}

/// Marks all edges of a marked cell, except those in the direction in which it is thin if layers
/// are kept.
template<std::size_t Edges, std::size_t Directions, std::size_t Parallel>
void markAcross(const EdgeTable& table, const std::array<Index, Edges>& edges,
  const int (&directions)[Directions][Parallel], bool keepLayers, EdgeMarks& marks)
{
  const int thin = keepLayers ? thinDirection(meanSquaresIn(table, edges, directions)) : -1;
  for (int d = 0; d < static_cast<int>(Directions); ++d)
  {
    for (const int edge : directions[d])
    {
      marks[edges[edge]] |= d != thin;
    }
  }
}

} // namespace

void markLongestEdges(const Mesh& mesh, const EdgeTable& table,
  const std::vector<unsigned char>& cellMarks, bool keepLayers, EdgeMarks& marks)
{
  const EdgeOrder order(table);
  auto isMarked = cellMarks.begin();
  visitOwnShapes(mesh,
    [&](auto shape, const auto& cells)
    {
      constexpr std::size_t corners = decltype(shape)::corners;
      const auto& edgesOf = table.*edgesOfCells(shape);
      for (std::size_t c = 0; c < cells.size(); ++c)
      {
        if (!*isMarked++)
        {
          continue;
        }
        if constexpr (corners == shapes::Hexahedron::corners)
        {
          markAcross(table, edgesOf[c], shapes::Hexahedron::directions, keepLayers, marks);
        }
        else if constexpr (corners == 4 && decltype(shape)::dimension == 2)
        {
          markAcross(table, edgesOf[c], shapes::Quadrilateral::directions, keepLayers, marks);
        }
        else if constexpr (corners == shapes::Wedge::corners)
        {
          const std::array<int, 6> ofTriangles{ 0, 1, 2, 3, 4, 5 };
          marks[keepLayers ? order.longest(chosen(edgesOf[c], ofTriangles))
                           : order.longest(edgesOf[c])] = 1;
        }
        else
        {
          marks[order.longest(edgesOf[c])] = 1;
        }
      }
    });
}

EdgeStacks::EdgeStacks(const EdgeTable& table, const std::vector<GlobalId>& ids)
{
  DisjointSets sets(table.edges.size());
  for (const auto& edges : table.ofWedges)
  {
    for (int k = 0; k < 3; ++k)
    {
      sets.join(edges[k], edges[3 + k]);
    }
  }
  stackOf_ = sets.representatives();
  for (std::size_t e = 0; e < table.edges.size(); ++e)
  {
    const auto& [a, b] = table.edges[e];
    lengths_.push_back({ table.squaredLengths[e], { ids[a], ids[b] } });
  }
}

bool EdgeStacks::spread()
{
  std::vector<StackLength> largest = lengths_;
  for (std::size_t e = 0; e < lengths_.size(); ++e)
  {
    largest[stackOf_[e]] = std::max(largest[stackOf_[e]], lengths_[e]);
  }
  bool changed = false;
  for (std::size_t e = 0; e < lengths_.size(); ++e)
  {
    const StackLength& ofStack = largest[stackOf_[e]];
    changed = changed || lengths_[e] < ofStack;
    lengths_[e] = ofStack;
  }
  return changed;
}

void EdgeStacks::writeTo(EdgeTable& table) const
{
  table.idsInStack.resize(lengths_.size());
  for (std::size_t e = 0; e < lengths_.size(); ++e)
  {
    table.squaredLengths[e] = lengths_[e].squaredLength;
    table.idsInStack[e] = lengths_[e].ids;
  }
}

MarkClosure::MarkClosure(const EdgeTable& table, int dimension, bool keepLayers, EdgeMarks& marks)
  : table_(table), dimension_(dimension), keepLayers_(keepLayers), order_(table), marks_(marks)
{
}

/// Calls visit(edges of the cells of a shape) for one shape after the other.
template<class Visit>
void MarkClosure::visitLists(const Visit& visit) const
{
  visit(table_.ofTetrahedra);
  visit(table_.ofTriangles);
  visit(table_.ofPyramids);
  visit(table_.ofWedges);
  visit(table_.ofHexahedra);
  visit(table_.ofQuadrilaterals);
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

/// Looks at cells until none waits for a look. Returns true where an edge was marked.
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

/// Looks at every cell; edges that were fresh before no longer are.
void MarkClosure::sweep()
{
  --sweepsLeft_;
  fresh_.clear();
  visitLists(
    [&](const auto& cells)
    {
      looks_ += cells.size();
      for (const auto& edges : cells)
      {
        lookAt(edges);
      }
    });
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
      visitLists(
        [&](const auto& cells)
        {
          for (const auto& edges : cells)
          {
            std::for_each(edges.begin(), edges.end(), [&](Index edge) { use(edge, cell); });
            ++cell;
          }
        });
    });
}

void MarkClosure::lookAtCell(std::uint32_t cell)
{
  ++looks_;
  std::size_t first = 0;
  visitLists(
    [&](const auto& cells)
    {
      const std::size_t place = cell - first; // huge where it is below
      if (place < cells.size())
      {
        lookAt(cells[place]);
      }
      first += cells.size();
    });
}

/// Marks the longest edge, and those of the faces, where some edges are marked and others not.
void MarkClosure::lookAt(const std::array<Index, 6>& tetrahedron)
{
  if (isPartlyMarked(marks_, tetrahedron))
  {
    mark(order_.longest(tetrahedron));
    for (const auto& [a, b, c] : tetrahedronFaceEdges)
    {
      lookAt(std::array<Index, 3>{ tetrahedron[a], tetrahedron[b], tetrahedron[c] });
    }
  }
}

void MarkClosure::lookAt(const std::array<Index, 3>& triangle)
{
  if (isPartlyMarked(marks_, triangle))
  {
    mark(order_.longest(triangle));
  }
}

void MarkClosure::lookAt(const std::array<Index, 8>& pyramid)
{
  for (const LocalTriangle& triangle : pyramidTriangles)
  {
    lookAt(chosen(pyramid, triangle));
  }
}

void MarkClosure::lookAt(const std::array<Index, 9>& wedge)
{
  if (keepLayers_)
  {
    for (int k = 0; k < 3; ++k)
    {
      markTogether(wedge[k], wedge[3 + k]);
    }
    const auto uprights = chosen(wedge, std::array{ 6, 7, 8 });
    if (isPartlyMarked(marks_, uprights) &&
        longDirection(std::array{ meanSquareOf(table_, wedge, { 0, 1, 2, 3, 4, 5 }),
          meanSquareOf(table_, wedge, { 6, 7, 8 }) }) == 1)
    {
      std::for_each(uprights.begin(), uprights.end(), [this](Index edge) { mark(edge); });
    }
  }
  for (const LocalTriangle& triangle : wedgeTriangles)
  {
    lookAt(chosen(wedge, triangle));
  }
}

void MarkClosure::lookAt(const std::array<Index, 12>& hexahedron)
{
  if (keepLayers_ && isPartlyMarked(marks_, hexahedron))
  {
    const auto meanSquares = meanSquaresIn(table_, hexahedron, shapes::Hexahedron::directions);
    const int thin = thinDirection(meanSquares);
    const int longest = longDirection(meanSquares);
    for (int along = 0; along < 3; ++along)
    {
      for (const auto& [direction, edge, over] : hexahedronPairs[along])
      {
        if (along == thin || along == longest || direction == longest)
        {
          markTogether(hexahedron[edge], hexahedron[over]);
        }
      }
    }
  }
}

/// Applies the rule of thin cells; quadrilaterals of a mesh of volume have no rules of their own.
void MarkClosure::lookAt(const std::array<Index, 4>& quadrilateral)
{
  if (keepLayers_ && dimension_ == 2 && isPartlyMarked(marks_, quadrilateral))
  {
    const int thin =
      thinDirection(meanSquaresIn(table_, quadrilateral, shapes::Quadrilateral::directions));
    if (thin >= 0)
    {
      markTogether(quadrilateral[1 - thin], quadrilateral[3 - thin]);
    }
  }
}

void MarkClosure::markTogether(Index edge, Index over)
{
  if (marks_[edge] || marks_[over])
  {
    mark(edge);
    mark(over);
  }
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
