// The local operations on a mesh of tetrahedra or triangles: what each takes out, and what it puts
// there.
#pragma once

#include <cadrefine/nurbs/ClosestPointSearch.h>
#include <cadrefine/operations/EditableMesh.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace cadrefine
{

/// Each function below fills in the cavity of an operation, and returns whether the operation is
/// possible as far as corners and labels tell: cells of two labels do not become one, segments and
/// listed facets stay, as do the cells beyond the mesh. Whether the new cells are valid and well
/// shaped, and whether new facets follow the surface, is for the caller to judge. Work: the cells
/// at the vertices that are named.
///
/// (L. Freitag, C. Ollivier-Gooch, "Tetrahedral mesh improvement using swapping and smoothing",
/// Int. J. Numer. Meth. Engng 40, 1997.)

/// Which new tetrahedra are proposed: all that are valid, or, which takes less work, none where one
/// is worse than all cells before.
enum class NewCells
{
  Any,
  NoWorse
};

/// Removes the edge: the ring of at most `largestRing` vertices around it is triangulated again,
/// with the triangulation whose worst cell is best (G. Klincsek, "Minimal triangulations of
/// polygonal domains", Ann. Discrete Math. 9, 1980; work cubic in the ring). Three cells around the
/// edge become two. An edge between two boundary facets is replaced by their other diagonal; if
/// both are facets of one cell, which is flat where they are coplanar, that cell disappears. For a
/// mesh of triangles: proposeSwap.
bool proposeEdgeRemoval(
  const EditableMesh& mesh, Index a, Index b, Cavity& cavity, NewCells newCells = NewCells::Any);
constexpr std::size_t largestRing = 7;

/// Two cells become three round the edge between the vertices opposite to their common face, which
/// is opposite to corner `corner` of the cell.
bool proposeFaceRemoval(const EditableMesh& mesh, Index cell, int corner, Cavity& cavity);

/// The vertex `from` goes to `to`, at the other end of an edge: from inside the mesh anywhere, from
/// facets along a facet, from segments along their line. No other vertex is at both (the link
/// condition of T. Dey et al., "Topology preserving edge contraction", Publ. Inst. Math. 66, 1999).
bool proposeCollapse(const EditableMesh& mesh, Index from, Index to, Cavity& cavity);

/// The vertex `middle`, which has no cells yet, halves the edge.
bool proposeSplit(const EditableMesh& mesh, Index a, Index b, Index middle, Cavity& cavity);

/// Fills in the halves of the cavity's cells, facets and segments, which are all at the edge.
void halve(const EditableMesh& mesh, Index a, Index b, Index middle, Cavity& cavity);

/// A vertex that an operation made.
struct AddedVertex
{
  std::array<Index, 2> parents; ///< The ends of its edge.
  bool onBoundary = false;
  ClosestPoint where; ///< Its place on the CAD; without an entity if it is not on the CAD.
};

/// How often each operation was done.
struct OperationCounts
{
  std::int64_t edgeRemovals = 0;
  std::int64_t faceRemovals = 0;
  std::int64_t collapses = 0;
  std::int64_t splits = 0;
  std::int64_t moves = 0; ///< Moves of vertices.
  std::int64_t cells = 0; ///< Cells that were tried.

  std::int64_t operations() const
  {
    return edgeRemovals + faceRemovals + collapses + splits + moves;
  }
};

/// What operations did to a mesh.
struct OperationResult
{
  std::vector<AddedVertex> added; ///< New vertices; their numbers follow those of the old ones.
  OperationCounts counts;
};

} // namespace cadrefine
