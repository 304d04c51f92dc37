// Columns of nodes through the cells of boundary layers, over all ranks.
#pragma once

#include "mesh/DistributedMesh.h"

#include <cadrefine/base/EntityId.h>
#include <cadrefine/base/Moves.h>
#include <cadrefine/mesh/EdgeTable.h>
#include <cadrefine/mesh/Facets.h>
#include <cadrefine/motion/CellStacks.h>

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace cadrefine
{

/// What columns are made of: the vertices of a mesh, or the mid nodes of its edges.
struct ColumnNodes
{
  const std::vector<Point3>& points;
  const std::vector<GlobalId>& ids;
  const SharedItems& shared;
  const std::vector<EntityId>& entities; ///< The CAD entities on which nodes are.
  std::vector<unsigned char> held;       ///< 1: the node stays; empty: no node does.
  /// A wall that moves by less than this part of the first cell's height takes nothing along.
  double leastMove;
  /// The edges whose mid nodes these are; null: the nodes are vertices.
  const EdgeTable* edges = nullptr;
  /// The ends of the lines in whose middles the last nodes are; null: there are no such nodes.
  const std::vector<std::array<Index, 2>>* parents = nullptr;

  /// How many nodes a side of a cell has.
  int count(const Facet& side) const { return edges ? side.edges() : side.corners(); }
  /// The node at corner k of a side, or, of mid nodes, that between this corner and the next.
  Index at(const Facet& side, int k) const
  {
    const Index corner = side.vertices[k];
    return edges ? edges->find(corner, side.vertices[(k + 1) % side.corners()]) : corner;
  }
};

/// Walls inside a mesh, at which columns end: for each vertex 1 where it is of one, over all ranks.
struct InnerWalls
{
  std::vector<unsigned char> onCAD;   ///< Columns end there on a surface, else where a node moves.
  std::vector<unsigned char> staying; ///< Off the CAD and not beside it, as layers' ends are.
};

/// A node that a column comes to, and its height above the wall.
struct ColumnVisit
{
  Index node;
  GlobalId column;
  double height;
};

/// Finds the nodes of columns. Work: linear in the cells that they go through. Keeps references to
/// all that it is given.
class ColumnClimb
{
public:
  ColumnClimb(const DistributedMesh& mesh, const CellStacks& stacks, const ColumnNodes& nodes,
    const Moves& moves, const InnerWalls& walls, bool onSurface);

  /// Starts columns that stand on this node of a facet (see ColumnNodes::at), on both sides of it,
  /// on a surface in the facet's own cell, and end at the height `reach`; none where the first cell
  /// is higher than `highest`. On a surface, columns of two cells are told apart by the ways in
  /// which these go round the side.
  void start(const Facet& facet, int place, double highest, double reach);

  /// Lets columns climb on, also from rank to rank, and returns the nodes that they come to on this
  /// one. Collective; messages: one to and from each neighbour for every time that columns cross
  /// between ranks.
  std::vector<ColumnVisit> run(RankExchange& exchange);

private:
  /// A side of cells on its way to the rank that has the cell beyond it, and the column that stands
  /// on one of its nodes.
  struct Front
  {
    GlobalId column;
    std::array<GlobalId, 4> side;
    std::int64_t place; ///< Which node of the side, see ColumnNodes::at.
    double height;
    double highest; ///< Largest height of the first cell.
    double reach;   ///< The column ends at this height.
  };

  void climb(Facet side, Front front);
  void goBeyond(const Facet& side, const Front& front);
  void send(const Facet& side, Front front);
  bool endsAt(const Facet& side, Index node) const;
  Facet facetOf(const std::array<GlobalId, 4>& ids) const;

  const DistributedMesh& mesh_;
  const ColumnNodes& nodes_;
  const CellStacks& stacks_;
  const Moves& moves_;
  const InnerWalls& walls_;
  bool onSurface_;
  std::vector<std::pair<GlobalId, Index>> vertexOf_; ///< Shared vertices by their ids, ascending.
  std::vector<std::vector<Front>> outgoing_;
  std::vector<ColumnVisit> visited_;
};

} // namespace cadrefine
