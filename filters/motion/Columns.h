// Columns of nodes over the moving nodes of walls.
#pragma once

#include "mesh/DistributedMesh.h"
#include "motion/ColumnClimb.h"

#include <cadrefine/base/Moves.h>
#include <cadrefine/classification/BoundaryProjector.h>
#include <cadrefine/mesh/Facets.h>

#include <vector>

namespace cadrefine
{

/// A node that a column comes to, see ColumnVisit.
struct ColumnMember
{
  Index node;
  Index column;
  double height;
  double part; ///< Of the move of the wall's node; the rest is of the facing one's.
};

/// Of all columns of this rank.
struct WallMoves
{
  std::vector<Vector3> own;
  std::vector<Vector3> facing; ///< Zero where a column faces none.

  Vector3 of(const ColumnMember& member) const
  {
    return member.part * own[member.column] + (1 - member.part) * facing[member.column];
  }
};

/// The columns that come to nodes of this rank. Lists over columns have one entry for each.
struct Columns
{
  const DistributedMesh& mesh;
  ColumnNodes nodes;
  const BoundaryProjector& projector;
  Vector3 plane; ///< See planeNormal.
  /// Of the mesh's boundary; of a surface in space the sides of quadrilaterals on CAD edges.
  std::vector<Facet> facets = {};
  std::vector<GlobalId> ids = {}; ///< Ascending: twice the id of the wall's node, 1 more beyond.
  std::vector<Index> walls = {};  ///< The node of the wall; -1: only other ranks start the column.
  /// The node of the wall where a column ends, if another one comes back from there; -1: none, or
  /// only other ranks have it.
  std::vector<Index> facing = {};
  bool anyFacing = false; ///< On any rank.
  /// By which the nodes go farther than the wall's, for each length of way that this has to go.
  std::vector<Vector3> lifts = {};
  SharedItems shared = {};
  std::vector<ColumnMember> members = {};

  bool onSurface() const { return isSurface(mesh.mesh(), plane); } ///< In space.

  /// Those of the walls' nodes on this rank or on others, with the lifts. Collective.
  WallMoves movesOfWalls(RankExchange& exchange, const Moves& moves) const;

  /// The moves of the walls over which nodes are, of one of them where there are several, without
  /// members that are left out (a flag for each). Collective.
  std::vector<Vector3> movesOfNodes(RankExchange& exchange, const WallMoves& ofWalls,
    const std::vector<unsigned char>& isLeftOut) const;

  /// 1 for nodes that are held, and those of a boundary off the CAD that would leave the plane of
  /// an outer facet. Members that are lost do not count: one column at most moves a node.
  /// Collective.
  std::vector<unsigned char> findBlocked(RankExchange& exchange, const WallMoves& ofWalls,
    const std::vector<unsigned char>& isLost) const;

  /// Where a move brings a node that keeps to its entity.
  Point3 placeOf(Index node, const Vector3& move) const;
  /// Whether that is nearly the whole move.
  bool keepsDirection(Index node, const Vector3& move) const;

  /// use(node, facet, normal) of all facets.
  template<class Use>
  void forAllFacets(const Use& use) const
  {
    for (const Facet& facet : facets)
    {
      const Vector3 normal = normalOf(facet);
      for (int k = 0; k < nodes.count(facet); ++k)
      {
        use(nodes.at(facet, k), facet, normal);
      }
    }
  }

  /// Of unit length; on a surface in space in its cell.
  Vector3 normalOf(const Facet& facet) const;

private:
  std::vector<Vector3> movesOf(
    RankExchange& exchange, const Moves& moves, const std::vector<Index>& ofColumns) const;
};

/// Of what ranks have of a move, of which all but one may be zero.
inline const Vector3& nonZero(const Vector3& a, const Vector3& b)
{
  return a == Vector3{} ? b : a;
}

} // namespace cadrefine
