// Which edges longest edge bisection cuts.
#pragma once

#include <cadrefine/base/VertexBuckets.h>
#include <cadrefine/mesh/EdgeTable.h>
#include <cadrefine/mesh/Mesh.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace cadrefine
{

/// Marks of edges: 1 where the edge will be cut, else 0. (A vector of bytes, so that ranks can
/// exchange entries.)
using EdgeMarks = std::vector<unsigned char>;

/// Longest edge bisection of marked cells until no vertex hangs, as a least fixpoint:
///   1. a marked cell marks its longest edge;
///   2. a cell that has a marked edge marks its longest edge, and so does each of its faces;
///   3. repeat 2 until nothing changes.
/// The rules are monotone and the edges finite, so the fixpoint exists, is unique, and does not
/// depend on the order in which cells are visited or on how they are spread over ranks: over ranks,
/// close locally, exchange the marks of shared edges, and repeat until no rank changes any.
/// Recursive bisection of a cell at the longest of its marked edges (see splitMarked) then gives
/// conforming meshes, since each face is cut in an order that its own edges fix.
///
/// Algorithm 3.1 of S. Strunk, KTH 2013, as a fixpoint on the edges of the mesh at hand;
/// M.-C. Rivara, "Algorithms for refining triangular grids suitable for adaptive and multigrid
/// techniques", Int. J. Numer. Meth. Eng. 20, 1984 (4-triangle partition and its conforming partial
/// versions); A. Plaza, G. F. Carey, "Local refinement of simplicial grids based on the skeleton",
/// Appl. Numer. Math. 32, 2000 (its form in three dimensions).

/// Other cells than simplices take any marks (see CellCutting), and have further rules:
///   1. a marked hexahedron or quadrilateral marks all its edges, a marked wedge or pyramid its
///      longest edge;
///   2. each triangle of a wedge or pyramid that has a marked edge marks its longest edge.
/// Where layers are kept, all cells over each other are cut alike, and along the wall alone:
///   1. a marked wedge marks the longest edge of its triangles; a thin hexahedron or quadrilateral
///      (its edges in one direction are less than half as long as those in each other one, by the
///      means of their squares) marks its edges in the others;
///   2. an edge of a wedge's triangle that is marked marks the one over it, an edge of a thin cell
///      the one over it.
/// Long hexahedra and wedges (more than twice as long in one direction as in each other one, or as
/// the triangles' edges) are cut from end to end, as their transition cells would be slivers:
///   3. a marked edge in the long direction marks all others in it, any other one of a hexahedron
///      the one that lies over it, seen along that direction.
/// These are monotone too.

/// Marks edges by rule 1 for the cells of the mesh's own dimension; `cellMarks` has one entry for
/// each of them.
void markLongestEdges(const Mesh& mesh, const EdgeTable& table,
  const std::vector<unsigned char>& cellMarks, bool keepLayers, EdgeMarks& marks);

/// What an edge counts as in the order of edges (see EdgeOrder).
struct StackLength
{
  double squaredLength;
  std::array<GlobalId, 2> ids; ///< Global ids of its ends, smaller first.

  friend bool operator<(const StackLength& a, const StackLength& b)
  {
    return a.squaredLength != b.squaredLength ? a.squaredLength < b.squaredLength : a.ids < b.ids;
  }
};

/// Edges that stand over each other in the wedges of a piece.
class EdgeStacks
{
public:
  EdgeStacks(const EdgeTable& table, const std::vector<GlobalId>& ids);

  /// Makes each edge count as the longest of those over and below it. Returns whether any has
  /// changed.
  bool spread();
  /// What each edge counts as; over ranks, give shared edges the largest and spread again, until
  /// none changes.
  std::vector<StackLength>& lengths() { return lengths_; }
  /// Makes these lengths the order of the table's edges.
  void writeTo(EdgeTable& table) const;

private:
  /// For each edge, the first of those that stand over each other with it.
  std::vector<Index> stackOf_;
  std::vector<StackLength> lengths_;
};

/// Spreads marks by rules 2 and 3 within this piece. Where few marks spread, as is usual, a few
/// sweeps over all cells do; what they leave is spread from edge to edge, through lists of the
/// cells at each edge.
///
/// Work: linear in the number of cells, whatever their order and however often marks come from
/// other ranks: at most 6 sweeps, and one look at a cell for each of its edges. In a sweep only the
/// marks of cells without a mark are looked at. Memory: none, or, once sweeps have not been enough,
/// 8 bytes an edge and 24 a tetrahedron.
class MarkClosure
{
public:
  /// Sweeps before the cells at each edge are listed, which costs as much as some five of them.
  static constexpr int maximumSweeps = 6;

  /// `table` and `marks` must outlive this object. Meanwhile, others may set marks, but not reset
  /// them. `dimension` is that of the mesh: layers of quadrilaterals are those of a mesh of area.
  MarkClosure(const EdgeTable& table, int dimension, bool keepLayers, EdgeMarks& marks);

  /// Closes all marks. Returns true where an edge was marked.
  bool closeAll();
  /// As closeAll, given that all marks were closed before these edges were marked.
  bool closeFrom(const std::vector<Index>& edges);

  /// How many cells were looked at so far, counting each as often as it was.
  std::size_t looks() const { return looks_; }

private:
  bool close();
  void sweep();
  bool spread();
  void listCells();
  template<class Visit>
  void visitLists(const Visit& visit) const;
  void lookAtCell(std::uint32_t cell);
  void lookAt(const std::array<Index, 6>& tetrahedron);
  void lookAt(const std::array<Index, 3>& triangle);
  void lookAt(const std::array<Index, 8>& pyramid);
  void lookAt(const std::array<Index, 9>& wedge);
  void lookAt(const std::array<Index, 12>& hexahedron);
  void lookAt(const std::array<Index, 4>& quadrilateral);
  void markTogether(Index edge, Index over);
  void mark(Index edge);

  const EdgeTable& table_;
  const int dimension_;
  const bool keepLayers_;
  const EdgeOrder order_;
  EdgeMarks& marks_;
  std::vector<Index> fresh_; ///< Marked edges at which cells wait for a look.
  int sweepsLeft_ = maximumSweeps;
  /// The cells at each edge, by their numbers in the order of visitLists.
  std::optional<VertexBuckets<std::uint32_t>> cellsAt_;
  std::size_t looks_ = 0;
};

} // namespace cadrefine
