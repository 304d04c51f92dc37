// The cells of boundary layers move along with the wall that they stand on.
#pragma once

#include "mesh/DistributedMesh.h"
#include "motion/ColumnClimb.h"

#include <cadrefine/base/Moves.h>
#include <cadrefine/classification/BoundaryProjector.h>
#include <cadrefine/mesh/Facets.h>

#include <cstdint>
#include <vector>

namespace cadrefine
{

/// Columns of nodes over the moving nodes of walls, through the wedges, hexahedra or quadrilaterals
/// that stand on a boundary facet at such a node, on whatever ranks, to where the stack ends, or
/// another column comes closer to its wall (counted in cells; ties by the ids of the walls' nodes),
/// or the column is a hundred times as high as the move. Columns of vertices go up edges, those of
/// mid nodes from edge to edge. Of several facets at the node that counts whose normal is nearest
/// to the direction of the move.
///
/// A wall's node takes its column along: the first node of it all the way, so that the height
/// of the first cell stays, the others less and less (by 3 x^2 - 2 x^3 of the height over the
/// first), the last one not at all. On a stack that is lower than six moves what follows has to
/// make way: so much less fades out that no cell of the stack loses more than a quarter of its
/// height. Nodes of a column that are on a boundary keep to it: those on the CAD to their
/// entity, others move if they stay in the planes of their facets; where the last one cannot go
/// along, all of the move fades out. A node that is to move along the boundary itself, as on a
/// plane of symmetry, goes with a column that does so too.
///
/// Work: linear in the cells that are not simplices. Messages: one to and from each neighbour for
/// every time that columns cross between ranks, and a few more.
class LayerColumns
{
public:
  /// None, unless some rank has other cells than simplices; nor where `plane`, the normal of a
  /// planar mesh, is zero in 2D. `moves`: of the nodes. `fixed`: 1 for vertices on the boundary,
  /// over all ranks. Keeps references to the mesh and to what the nodes refer to. Collective.
  LayerColumns(RankExchange& exchange, const DistributedMesh& mesh, ColumnNodes nodes,
    const Moves& moves, const BoundaryProjector& projector, const std::vector<unsigned char>& fixed,
    const Vector3& plane);

  /// Whether there may be columns, on any rank.
  bool any() const { return any_; }

  /// Nodes of columns.
  struct Followers
  {
    std::vector<Index> joining;    ///< Did not move before.
    std::vector<Index> redirected; ///< Were to move to other places.
  };

  /// Adds the moves of the columns' nodes to those of their walls. Collective.
  Followers follow(RankExchange& exchange, Moves& moves);

  /// Makes all nodes of a column that follow, and that of its wall, go the same part of their
  /// way: the smallest. Collective.
  void tie(RankExchange& exchange, Moves& moves) const;

private:
  /// A node that a column comes to, see ColumnVisit.
  struct Member
  {
    Index node;
    Index column;
    std::int64_t level;
    double height;
    double part; ///< Of the move of the wall's node.
  };

  /// Heights of a column's first node, and of where it ends; what part of the move has faded out
  /// there.
  struct Span
  {
    double first;
    double end;
    double faded;
  };

  void listMembers(
    RankExchange& exchange, const std::vector<ColumnVisit>& visits, const Moves& moves);
  void findYielding(RankExchange& exchange, const Moves& moves, const std::vector<double>& cosines);
  std::vector<unsigned char> findLost(
    RankExchange& exchange, const Moves& moves, const std::vector<unsigned char>& isLeftOut) const;
  std::vector<Span> findSpans(RankExchange& exchange, const Moves& moves) const;

  /// The moves of the walls of all columns of this rank. Collective.
  std::vector<Vector3> movesOfWalls(RankExchange& exchange, const Moves& moves) const;
  std::vector<Vector3> movesOfMembers(RankExchange& exchange, const std::vector<Vector3>& ofWalls,
    const std::vector<unsigned char>& isLeftOut) const;
  std::vector<unsigned char> findBlocked(RankExchange& exchange,
    const std::vector<Vector3>& ofWalls, const std::vector<unsigned char>& isLost) const;
  Point3 placeOf(Index node, const Vector3& move) const;
  bool keepsDirection(Index node, const Vector3& move) const;
  template<class Use>
  void forAllFacets(const Use& use) const;
  template<class Use>
  void forAllTied(const Use& use) const;

  const DistributedMesh& mesh_;
  const ColumnNodes nodes_;
  const BoundaryProjector& projector_;
  Vector3 plane_;
  bool any_ = false;
  std::vector<Facet> facets_;     ///< Of the mesh's boundary.
  std::vector<GlobalId> columns_; ///< Ascending: twice the id of the wall's node, 1 more beyond.
  std::vector<Index> walls_; ///< The node of each column's wall; -1: only other ranks start it.
  SharedItems shared_;       ///< Columns.
  std::vector<unsigned char> yields_; ///< 1: a node that goes with a column, wherever it was to go.
  std::vector<Member> members_;
  std::vector<Member> following_; ///< Those of them that move.
};

} // namespace cadrefine
