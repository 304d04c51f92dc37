#include <cadrefine/refinement/CellCutting.h>

#include <cadrefine/refinement/Bisection.h>

#include <algorithm>
#include <iterator>

namespace cadrefine
{
namespace
{

/// The local edge between two local corners; -1: none.
template<class Shape>
int edgeBetween(Shape, int a, int b)
{
  for (int e = 0; e < static_cast<int>(std::size(Shape::edges)); ++e)
  {
    const auto& [i, k] = Shape::edges[e];
    if ((i == a && k == b) || (i == b && k == a))
    {
      return e;
    }
  }
  return -1;
}

/// Which of a shape's quadrilaterals has both local edges; -1: none.
template<class Shape>
int quadWith(Shape, int edge, int other)
{
  for (int q = 0; q < static_cast<int>(std::size(Shape::quadEdges)); ++q)
  {
    const auto& edges = Shape::quadEdges[q];
    const auto has = [&](int wanted)
    { return std::find(std::begin(edges), std::end(edges), wanted) != std::end(edges); };
    if (has(edge) && has(other))
    {
      return q;
    }
  }
  return -1;
}

int cornersOf(const int (&face)[4])
{
  return face[3] < 0 ? 3 : 4;
}

/// The parts of a quadrilateral with corners v, with the new vertex m[k] on the edge from corner k
/// on (-1: not marked), and with `middle` inside it if all are marked.
std::vector<std::array<Index, 4>> piecesOfQuad(
  const std::array<Index, 4>& v, const std::array<Index, 4>& m, Index middle)
{
  const auto isMarked = [&](int k) { return m[k % 4] >= 0; };
  int marked = 0;
  for (int k = 0; k < 4; ++k)
  {
    marked += isMarked(k);
  }
  // From corner `first` on, so that the marked edges come first.
  int first = 0;
  while (marked > 0 && marked < 4 && !(isMarked(first) && !isMarked(first + 3)))
  {
    ++first;
  }
  const auto corner = [&](int k) { return v[(first + k) % 4]; };
  const auto mid = [&](int k) { return m[(first + k) % 4]; };
  switch (marked)
  {
    case 0:
      return { v };
    case 1:
      return { { corner(0), mid(0), corner(3), -1 }, { mid(0), corner(1), corner(2), -1 },
        { mid(0), corner(2), corner(3), -1 } };
    case 2:
      if (isMarked(first + 2))
      {
        return { { corner(0), mid(0), mid(2), corner(3) },
          { mid(0), corner(1), corner(2), mid(2) } };
      }
      return { { mid(0), corner(1), mid(1), -1 }, { corner(3), corner(0), mid(0), -1 },
        { corner(3), mid(0), mid(1), -1 }, { corner(3), mid(1), corner(2), -1 } };
    case 3:
      return { { corner(0), mid(0), mid(2), corner(3) }, { mid(0), corner(1), mid(1), -1 },
        { mid(1), corner(2), mid(2), -1 }, { mid(0), mid(1), mid(2), -1 } };
    default:
      return { { v[0], m[0], middle, m[3] }, { m[0], v[1], m[1], middle },
        { middle, m[1], v[2], m[2] }, { m[3], middle, m[2], v[3] } };
  }
}

/// Adds a tetrahedron or pyramid over a base whose normal points to the apex.
void addOver(const std::array<Index, 4>& base, Index apex, Mesh& children)
{
  if (base[3] < 0)
  {
    children.tetrahedra.push_back({ base[0], base[1], base[2], apex });
  }
  else
  {
    children.pyramids.push_back({ base[0], base[1], base[2], base[3], apex });
  }
}

void addBetween(const std::array<Index, 4>& low, const std::array<Index, 4>& high, Mesh& children)
{
  if (low[3] < 0)
  {
    children.wedges.push_back({ low[0], low[1], low[2], high[0], high[1], high[2] });
  }
  else
  {
    children.hexahedra.push_back(
      { low[0], low[1], low[2], low[3], high[0], high[1], high[2], high[3] });
  }
}

void addFlat(const std::array<Index, 4>& piece, Mesh& children)
{
  if (piece[3] < 0)
  {
    children.triangles.push_back({ piece[0], piece[1], piece[2] });
  }
  else
  {
    children.quadrilaterals.push_back(piece);
  }
}

/// Two opposite sides of a shape, corner over corner; seen from the second one, the first one turns
/// counter-clockwise.
struct Opposite
{
  int low[4];
  int high[4];
};

constexpr Opposite oppositeSides(shapes::Wedge, int)
{
  return { { 0, 1, 2, -1 }, { 3, 4, 5, -1 } };
}

constexpr Opposite oppositeSides(shapes::Hexahedron, int direction)
{
  constexpr Opposite sides[3] = { { { 0, 1, 2, 3 }, { 4, 5, 6, 7 } },
    { { 0, 3, 7, 4 }, { 1, 2, 6, 5 } }, { { 0, 4, 5, 1 }, { 3, 7, 6, 2 } } };
  return sides[direction];
}

constexpr int directionsOf(shapes::Wedge)
{
  return 1;
}

constexpr int directionsOf(shapes::Hexahedron)
{
  return 3;
}

} // namespace

/// The parts of two opposite sides of a cell that are cut alike, and where its edges between them
/// are marked the parts halfway.
struct CellCutting::Stack
{
  std::vector<Piece> low;
  std::vector<Piece> middle;
  std::vector<Piece> high;
};

CellCutting::CellCutting(
  const Mesh& mesh, const EdgeTable& table, const QuadTable& quads, const Midpoints& midpoints)
  : mesh_(mesh), table_(table), quads_(quads), midpoints_(midpoints), order_(table)
{
}

/// The new vertex on the edge between two local corners of a cell; -1: the edge is not marked.
template<class Shape>
Index CellCutting::midpointOf(Shape shape, Index cell, int a, int b) const
{
  return midpoints_.ofEdge[(table_.*edgesOfCells(shape))[cell][edgeBetween(shape, a, b)]];
}

/// The new vertex in one of a cell's quadrilaterals; -1: not all of its edges are marked.
template<class Shape>
Index CellCutting::middleOf(Shape shape, Index cell, int quad) const
{
  return midpoints_.ofQuad[(quads_.*quadsOfCells(shape))[cell][quad]];
}

/// The parts of the side with these local corners, turning as they do.
template<class Shape>
std::vector<CellCutting::Piece> CellCutting::piecesOf(
  Shape shape, Index cell, const int* corners, int count) const
{
  const auto& vertices = (mesh_.*Shape::cells)[cell];
  const auto& edges = (table_.*edgesOfCells(shape))[cell];
  const auto edgeAt = [&](int k)
  { return edgeBetween(shape, corners[k], corners[(k + 1) % count]); };
  if (count == 3)
  {
    std::vector<Piece> pieces;
    bisect(
      Part<3, 3>{ { vertices[corners[0]], vertices[corners[1]], vertices[corners[2]] },
        { edges[edgeAt(0)], edges[edgeAt(1)], edges[edgeAt(2)] } },
      order_, [&](Index edge) { return midpoints_.ofEdge[edge]; },
      [&](const std::array<Index, 3>& part) {
        pieces.push_back({ part[0], part[1], part[2], -1 });
      });
    return pieces;
  }
  std::array<Index, 4> v;
  std::array<Index, 4> m;
  for (int k = 0; k < 4; ++k)
  {
    v[k] = vertices[corners[k]];
    m[k] = midpoints_.ofEdge[edges[edgeAt(k)]];
  }
  return piecesOfQuad(v, m, middleOf(shape, cell, quadWith(shape, edgeAt(0), edgeAt(2))));
}

template<class Shape>
bool CellCutting::isCut(Shape shape, Index cell) const
{
  const auto& edges = (table_.*edgesOfCells(shape))[cell];
  return std::any_of(
    edges.begin(), edges.end(), [&](Index edge) { return midpoints_.ofEdge[edge] >= 0; });
}

/// Finds the stack between these sides. Returns false where they are not cut alike, or some edges
/// between them are marked and others not.
template<class Shape>
bool CellCutting::findStack(
  Shape shape, Index cell, const int* low, const int* high, int count, Stack& stack) const
{
  const auto& vertices = (mesh_.*Shape::cells)[cell];
  std::vector<std::array<Index, 3>> over; // low, middle, high
  int cutUp = 0;
  for (int k = 0; k < count; ++k)
  {
    const int next = (k + 1) % count;
    const Index up = midpointOf(shape, cell, low[k], high[k]);
    over.push_back({ vertices[low[k]], up, vertices[high[k]] });
    cutUp += up >= 0;
    const Index below = midpointOf(shape, cell, low[k], low[next]);
    const Index above = midpointOf(shape, cell, high[k], high[next]);
    if ((below >= 0) != (above >= 0))
    {
      return false;
    }
    if (below >= 0)
    {
      const int side = quadWith(
        shape, edgeBetween(shape, low[k], low[next]), edgeBetween(shape, high[k], high[next]));
      over.push_back({ below, middleOf(shape, cell, side), above });
    }
  }
  if (cutUp != 0 && cutUp != count)
  {
    return false;
  }
  stack.low = piecesOf(shape, cell, low, count);
  stack.high = piecesOf(shape, cell, high, count);
  if constexpr (Shape::corners == shapes::Hexahedron::corners)
  {
    const auto middleOfSide = [&](const int* side)
    {
      return middleOf(shape, cell,
        quadWith(
          shape, edgeBetween(shape, side[0], side[1]), edgeBetween(shape, side[2], side[3])));
    };
    over.push_back({ middleOfSide(low), midpoints_.ofHexahedron[cell], middleOfSide(high) });
  }
  const auto lifted = [&](const Piece& piece, int level)
  {
    Piece result = piece;
    for (Index& vertex : result)
    {
      const auto found = std::find_if(over.begin(), over.end(),
        [&](const std::array<Index, 3>& column) { return column[0] == vertex; });
      vertex = vertex < 0 ? -1 : (*found)[level];
    }
    return result;
  };
  for (std::size_t i = 0; i < stack.low.size(); ++i)
  {
    if (lifted(stack.low[i], 2) != stack.high[i])
    {
      return false;
    }
    if (cutUp > 0)
    {
      stack.middle.push_back(lifted(stack.low[i], 1));
    }
  }
  return true;
}

template<class Shape>
bool CellCutting::findStack(Shape shape, Index cell, Stack& stack) const
{
  for (int direction = 0; direction < directionsOf(shape); ++direction)
  {
    const Opposite sides = oppositeSides(shape, direction);
    stack = {};
    if (findStack(shape, cell, sides.low, sides.high, cornersOf(sides.low), stack))
    {
      return true;
    }
  }
  return false;
}

void CellCutting::cutStack(const Stack& stack, Mesh& children) const
{
  for (std::size_t i = 0; i < stack.low.size(); ++i)
  {
    if (stack.middle.empty())
    {
      addBetween(stack.low[i], stack.high[i], children);
    }
    else
    {
      addBetween(stack.low[i], stack.middle[i], children);
      addBetween(stack.middle[i], stack.high[i], children);
    }
  }
}

template<class Shape>
void CellCutting::cutAround(Shape shape, Index cell, Index apex, Mesh& children) const
{
  for (const auto& face : Shape::faces)
  {
    const int count = cornersOf(face);
    int inward[4];
    std::reverse_copy(face, face + count, inward);
    for (const Piece& piece : piecesOf(shape, cell, inward, count))
    {
      addOver(piece, apex, children);
    }
  }
}

template<class Shape>
void CellCutting::cutVolume(Shape shape, Index cell, Index apex, Mesh& children) const
{
  Stack stack;
  if (!isCut(shape, cell))
  {
    (children.*Shape::cells).push_back((mesh_.*Shape::cells)[cell]);
  }
  else if (findStack(shape, cell, stack))
  {
    cutStack(stack, children);
  }
  else
  {
    cutAround(shape, cell, apex, children);
  }
}

bool CellCutting::isCutInBaseAlone(Index pyramid) const
{
  const auto& edges = table_.ofPyramids[pyramid];
  return std::all_of(
    edges.begin() + 4, edges.end(), [&](Index edge) { return midpoints_.ofEdge[edge] < 0; });
}

bool CellCutting::needsApex(shapes::Pyramid, Index cell) const
{
  return !isCutInBaseAlone(cell);
}

bool CellCutting::needsApex(shapes::Wedge shape, Index cell) const
{
  Stack stack;
  return isCut(shape, cell) && !findStack(shape, cell, stack);
}

bool CellCutting::needsApex(shapes::Hexahedron shape, Index cell) const
{
  Stack stack;
  return isCut(shape, cell) && !findStack(shape, cell, stack);
}

void CellCutting::cut(shapes::Pyramid shape, Index cell, Index apex, Mesh& children) const
{
  if (!isCutInBaseAlone(cell))
  {
    cutAround(shape, cell, apex, children);
    return;
  }
  constexpr int base[4] = { 0, 1, 2, 3 };
  for (const Piece& piece : piecesOf(shape, cell, base, 4))
  {
    addOver(piece, mesh_.pyramids[cell][4], children);
  }
}

void CellCutting::cut(shapes::Wedge shape, Index cell, Index apex, Mesh& children) const
{
  cutVolume(shape, cell, apex, children);
}

void CellCutting::cut(shapes::Hexahedron shape, Index cell, Index apex, Mesh& children) const
{
  cutVolume(shape, cell, apex, children);
}

void CellCutting::cut(shapes::Quadrilateral shape, Index cell, Mesh& children) const
{
  constexpr int corners[4] = { 0, 1, 2, 3 };
  for (const Piece& piece : piecesOf(shape, cell, corners, 4))
  {
    addFlat(piece, children);
  }
}

} // namespace cadrefine
