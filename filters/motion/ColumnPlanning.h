// Which nodes go along with the moving nodes of walls, and how far.
#pragma once

#include "motion/Columns.h"

namespace cadrefine
{

/// Fills in the columns over the moving nodes (see LayerColumns); `columns` has the mesh, its
/// nodes, the projector and the plane. `moves`: of the nodes. Collective.
///
/// 1. From each moving node of a wall a column climbs from the facet whose normal is nearest to its
///    move, until the stack ends or is a hundred moves high (ColumnClimb).
/// 2. Where nodes are in the middles of lines (ColumnNodes::parents), lifts that keep the first
///    height halfway between two columns.
/// 3. Nodes that move along their facets only, or by a rounding, and to which a column comes that
///    moves along them too, start none, but go along.
/// 4. A node that several columns come to is of the one that is lowest there.
/// 5. Columns that end at each other's walls, near enough, become pairs.
/// 6. How far up a column's move fades out, and so the part of it that each node takes.
void planColumns(
  RankExchange& exchange, const Moves& moves, const BoundarySearch& boundary, Columns& columns);

} // namespace cadrefine
