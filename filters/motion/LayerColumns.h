// The cells of boundary layers move along with the wall that they stand on.
#pragma once

#include "mesh/DistributedMesh.h"
#include "motion/ColumnClimb.h"
#include "motion/FirstEdges.h"

#include <cadrefine/base/Moves.h>
#include <cadrefine/classification/BoundaryProjector.h>
#include <cadrefine/mesh/Facets.h>

#include <cstdint>
#include <limits>
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
/// height. A column halfway between two that are not parallel has a lower first cell than they:
/// where theirs are equally high (see findFirstEdges), its nodes go on until its own is.
/// Nodes of a column that are on a boundary keep to it: those on the CAD to their entity, others
/// move if they stay in the planes of their facets; where the last one cannot go along, all of the
/// move fades out. Where the last one is on another wall, from which a column comes back, the move
/// fades into that of this wall, and the two columns go as one. Heights that are smaller than two
/// of what fades out are scaled more and more alike. A node that is to move along the boundary
/// itself, as on a plane of symmetry, goes with a column that does so too.
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
  /// way: the smallest. So do facing columns. Collective.
  void tie(RankExchange& exchange, Moves& moves) const;

private:
  /// Which column has a node: that of the lowest level, of these the smallest one; -1: the node
  /// moves by itself.
  struct Claim
  {
    std::int64_t level = std::numeric_limits<std::int64_t>::max();
    GlobalId column = -1;

    friend bool operator<(const Claim& a, const Claim& b)
    {
      return a.level != b.level ? a.level < b.level : a.column < b.column;
    }
  };

  /// A node that a column comes to, see ColumnVisit.
  struct Member
  {
    Index node;
    Index column;
    std::int64_t level;
    double height;
    double part; ///< Of the move of the wall's node; the rest is of the facing one's.
  };

  /// Of all columns of this rank.
  struct WallMoves
  {
    std::vector<Vector3> own;
    std::vector<Vector3> facing; ///< Zero where a column faces none.

    Vector3 of(const Member& member) const
    {
      return member.part * own[member.column] + (1 - member.part) * facing[member.column];
    }
  };

  /// How a column's move fades out: smoothly from its first node to where it ends, or in proportion
  /// to the height, from the wall on.
  struct Span
  {
    double first;  ///< Height of the first node.
    double end;    ///< Of the last one; between walls of that before the facing wall.
    double height; ///< Of where the column ends, or of the facing wall.
    double faded;  ///< Part of the move that has faded out there.
    double smooth; ///< Weight of the smooth way.
  };

  void listMembers(
    RankExchange& exchange, const std::vector<ColumnVisit>& visits, const Moves& moves);
  void findYielding(RankExchange& exchange, const Moves& moves, const std::vector<double>& cosines);
  void findLifts(RankExchange& exchange, const std::vector<FirstEdge>& edges);
  std::vector<Claim> findClaims(
    RankExchange& exchange, const Moves& moves, const std::vector<unsigned char>& isLeftOut) const;
  Claim claimOf(const Member& member) const { return { member.level, columns_[member.column] }; }
  std::vector<unsigned char> findFacing(RankExchange& exchange, const Moves& moves,
    const std::vector<Claim>& claims, const std::vector<double>& tops);
  std::vector<Span> findSpans(
    RankExchange& exchange, const Moves& moves, const std::vector<Claim>& claims);

  /// The moves of the nodes that columns have on this rank or on others. Collective.
  std::vector<Vector3> movesOf(
    RankExchange& exchange, const Moves& moves, const std::vector<Index>& ofColumns) const;
  WallMoves movesOfWalls(RankExchange& exchange, const Moves& moves) const;
  std::vector<Vector3> movesOfMembers(RankExchange& exchange, const WallMoves& ofWalls,
    const std::vector<unsigned char>& isLeftOut) const;
  std::vector<unsigned char> findBlocked(RankExchange& exchange, const WallMoves& ofWalls,
    const std::vector<unsigned char>& isLost) const;
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
  /// The node of the wall where a column ends, if another one comes back from there; -1: none, or
  /// only other ranks have it.
  std::vector<Index> facing_;
  bool anyFacing_ = false;     ///< On any rank.
  std::vector<Vector3> lifts_; ///< By which the nodes of a column go farther than its wall's.
  std::vector<Member> members_;
  std::vector<Member> following_; ///< Those of them that move.
};

} // namespace cadrefine
