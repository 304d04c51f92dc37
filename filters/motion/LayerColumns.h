// The cells of boundary layers move along with the wall that they stand on.
#pragma once

#include "motion/Columns.h"

#include <vector>

namespace cadrefine
{

/// Columns of nodes over the moving nodes of walls, through the wedges, hexahedra or quadrilaterals
/// that stand on a boundary facet at such a node, on whatever ranks, to where the stack ends, or
/// another column comes closer to its wall (by height; ties by the ids of the walls' nodes), or the
/// column is a hundred times as high as the move. Columns of vertices go up edges, those of mid
/// nodes from edge to edge. Of several facets at the node, the one counts whose normal is nearest
/// to the direction of the move.
///
/// A wall's node takes its column along: the first node of it all the way, so that the height
/// of the first cell stays, the others less and less (by 3 x^2 - 2 x^3 of the height over the
/// first), the last one not at all. On a stack that is lower than six moves what follows has to
/// make way: so much less fades out that no cell of the stack loses more than a quarter of its
/// height. A column halfway between two that are not parallel has a lower first cell than they:
/// where theirs are equally high (see findFirstEdges), its nodes go on until its own is.
/// Nodes of a column that are on a boundary keep to it: those on the CAD to their entity, others
/// move if they stay in the planes of their facets; where the last one cannot go along, all of the
/// move fades out. Where the last one is on another wall, from which a column comes back, the move
/// fades into that of this wall, and the two columns go as one. Where a height
/// is less than twice the move that fades out, the profile blends from the cubic to scaling all
/// heights in proportion. A node that is to move along the boundary itself, as on a plane of
/// symmetry, goes with a column that does so too. On a surface in space the walls are its CAD
/// edges, where columns also end.
///
/// Work: linear in the cells that are not simplices, and one closest point for each facet inside
/// the mesh (see findBoundaryFacets) that is off the CAD. Messages: one to and from each neighbour
/// for every time that columns cross between ranks, and a few more.
class LayerColumns
{
public:
  /// Finds the columns: none, unless some rank has cells that are not simplices. `plane`: see
  /// planeNormal. `moves`: of the nodes. Keeps references to the mesh and to what the nodes refer
  /// to. Collective.
  LayerColumns(RankExchange& exchange, const DistributedMesh& mesh, ColumnNodes nodes,
    const Moves& moves, const BoundaryProjector& projector, const BoundarySearch& boundary,
    const Vector3& plane);

  /// Whether there may be columns, on any rank.
  bool any() const { return any_; }

  /// Nodes of columns.
  struct Followers
  {
    std::vector<Index> joining;    ///< Nodes that did not move before.
    std::vector<Index> redirected; ///< Nodes that were to move to other places.
  };

  /// Adds the moves of the columns' nodes to those of their walls. Collective.
  Followers follow(RankExchange& exchange, Moves& moves);

  /// Makes all nodes of a column that follow, and that of its wall, go the same part of their
  /// way: the smallest. So do facing columns. Collective.
  void tie(RankExchange& exchange, Moves& moves) const;

private:
  template<class Use>
  void forAllTied(const Use& use) const;

  Columns columns_;
  bool any_ = false;
  std::vector<ColumnMember> following_; ///< Those of the columns' members that move.
};

} // namespace cadrefine
