// How cells that are not simplices are cut where some of their edges are marked.
#pragma once

#include <cadrefine/mesh/EdgeTable.h>
#include <cadrefine/mesh/Mesh.h>
#include <cadrefine/mesh/QuadTable.h>
#include <cadrefine/refinement/Midpoints.h>

namespace cadrefine
{

/// Calls visit(shape, first, cells) for each shape of cells of volume that are not simplices,
/// `first` being the number of the first one.
template<class Visit>
void visitOthers(const Mesh& mesh, const Visit& visit)
{
  auto first = static_cast<Index>(mesh.tetrahedra.size());
  const auto visitOne = [&](auto shape)
  {
    const auto& cells = mesh.*decltype(shape)::cells;
    visit(shape, first, cells);
    first += static_cast<Index>(cells.size());
  };
  visitOne(shapes::Pyramid{});
  visitOne(shapes::Wedge{});
  visitOne(shapes::Hexahedron{});
}

/// Cuts hexahedra, wedges, pyramids and quadrilaterals at the midpoints of their marked edges, so
/// that neighbours agree whatever edges are marked:
///   - A triangle is bisected as the face of a tetrahedron is. A quadrilateral becomes four where
///     all of its edges are marked, two where two opposite ones are; with one marked edge it
///     becomes three triangles, with two adjacent ones four, with three a quadrilateral and three
///     triangles.
///   - A cell whose two opposite sides are cut alike, and of whose edges between them all are
///     marked or none, is cut along these: wedges and hexahedra stand on the parts of the side, in
///     one layer or two.
///   - A pyramid with marked edges in its base alone becomes pyramids and tetrahedra on the parts
///     of the base.
///   - All others: pyramids and tetrahedra on the parts of their sides, with a new vertex in the
///     middle of their corners for the apex.
class CellCutting
{
public:
  /// All arguments must outlive this object.
  CellCutting(
    const Mesh& mesh, const EdgeTable& table, const QuadTable& quads, const Midpoints& midpoints);

  /// Whether a cell, by its number among those of its shape, is cut with a new vertex in the
  /// middle.
  bool needsApex(shapes::Pyramid, Index cell) const;
  bool needsApex(shapes::Wedge, Index cell) const;
  bool needsApex(shapes::Hexahedron, Index cell) const;

  /// Appends the children of a cell (itself where it is not cut), given by its number among those
  /// of its shape; `apex` is its new vertex, if it needs one.
  void cut(shapes::Pyramid, Index cell, Index apex, Mesh& children) const;
  void cut(shapes::Wedge, Index cell, Index apex, Mesh& children) const;
  void cut(shapes::Hexahedron, Index cell, Index apex, Mesh& children) const;
  void cut(shapes::Quadrilateral, Index cell, Mesh& children) const;

private:
  /// A part of a side; -1 for the fourth vertex of a triangle.
  using Piece = std::array<Index, 4>;
  struct Stack;

  template<class Shape>
  Index midpointOf(Shape, Index cell, int a, int b) const;
  template<class Shape>
  Index middleOf(Shape, Index cell, int quad) const;
  template<class Shape>
  std::vector<Piece> piecesOf(Shape, Index cell, const int* corners, int count) const;
  template<class Shape>
  bool isCut(Shape, Index cell) const;
  template<class Shape>
  bool findStack(Shape, Index cell, const int* low, const int* high, int count, Stack& stack) const;
  template<class Shape>
  bool findStack(Shape, Index cell, Stack& stack) const;
  void cutStack(const Stack& stack, Mesh& children) const;
  template<class Shape>
  void cutAround(Shape, Index cell, Index apex, Mesh& children) const;
  template<class Shape>
  void cutVolume(Shape, Index cell, Index apex, Mesh& children) const;
  bool isCutInBaseAlone(Index pyramid) const;

  const Mesh& mesh_;
  const EdgeTable& table_;
  const QuadTable& quads_;
  const Midpoints& midpoints_;
  EdgeOrder order_;
};

} // namespace cadrefine
