// Columns of nodes over the moving nodes of walls.
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

/// Where the mesh has its boundary, see findBoundaryFacets.
struct BoundarySearch
{
  const std::vector<unsigned char>& among;
  const std::vector<std::uint64_t>& tags;
};

/// A node that a column comes to, see ColumnVisit.
struct ColumnMember
{
  Index node;
  Index column;
  double height;
  /// Part of the move of the wall's node that it takes; the rest it takes of the facing node's.
  double part;
};

/// The moves of the walls' nodes, for each column of this rank.
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
  /// Facets of the mesh's boundary; on a surface in space the sides of quadrilaterals on CAD edges.
  std::vector<Facet> facets = {};
  /// Ids of the columns, ascending: twice the id of the wall's node, and 1 more for that on the
  /// other side of the wall.
  std::vector<GlobalId> ids = {};
  std::vector<Index> walls = {}; ///< The node of the wall; -1: only other ranks start the column.
  /// The node of the wall where a column ends, if another one comes back from there; -1: none, or
  /// only other ranks have it.
  std::vector<Index> facing = {};
  bool anyFacing = false; ///< Whether columns face each other, on any rank.
  /// How much farther the nodes go than the wall's, for each length of way that this has to go.
  std::vector<Vector3> lifts = {};
  SharedItems shared = {};
  std::vector<ColumnMember> members = {};

  /// Whether the mesh is a surface in space.
  bool onSurface() const { return isSurface(mesh.mesh(), plane); }

  /// The moves of the walls' nodes, of those on other ranks too, with the lifts. Collective.
  WallMoves movesOfWalls(RankExchange& exchange, const Moves& moves) const;

  /// For each node, the move that a column gives it, of one of them where there are several; zero
  /// where there is none. Without members that are left out (a flag for each). Collective.
  std::vector<Vector3> movesOfNodes(RankExchange& exchange, const WallMoves& ofWalls,
    const std::vector<unsigned char>& isLeftOut) const;

  /// 1 for nodes that cannot go along: those that are held, and those of a boundary off the CAD
  /// that would leave the plane of an outer facet; on a surface in space, all that are off the CAD.
  /// Members that are lost (a flag for each) do not count: one column at most moves a node.
  /// Collective.
  std::vector<unsigned char> findBlocked(RankExchange& exchange, const WallMoves& ofWalls,
    const std::vector<unsigned char>& isLost) const;

  /// Where a move brings a node that keeps to its entity.
  Point3 placeOf(Index node, const Vector3& move) const;
  /// Whether placeOf makes nearly the whole move.
  bool keepsDirection(Index node, const Vector3& move) const;

  /// Calls use(node, facet, normal) for all nodes of all facets.
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

  /// The unit normal of a facet; on a surface in space, that of a side, in its cell.
  Vector3 normalOf(const Facet& facet) const;

private:
  std::vector<Vector3> movesOf(
    RankExchange& exchange, const Moves& moves, const std::vector<Index>& ofColumns) const;
};

/// Of two values that ranks have for a move, the one that is not zero.
inline const Vector3& nonZero(const Vector3& a, const Vector3& b)
{
  return a == Vector3{} ? b : a;
}

} // namespace cadrefine
