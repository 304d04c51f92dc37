// Moving vertices over all ranks without inverting a cell.
#pragma once

#include "DistributedMesh.h"
#include "Relocation.h"

#include <vector>

namespace cadrefine
{

/// Moves the vertices of `moves` as far to their targets as all cells stay valid, on all ranks, and
/// writes the new positions into the mesh. Where a vertex stops on the way, interior vertices
/// around it are moved out of its way and it tries again, a few times, while that helps.
/// `onBoundary` tells the vertices that are not interior (over all ranks); of these only those in
/// `moves` move.
///
/// The result does not depend on the partition: decisions are minima over the cells at a vertex,
/// and positions are sums of whole numbers (see MoveGuard, proposeInteriorPositions).
///
/// Returns for each vertex how far it still is from its target. Collective. Each sweep costs one
/// message to each neighbour, of 8 bytes a shared vertex.
std::vector<double> moveVertices(RankExchange& exchange, DistributedMesh& mesh, const Moves& moves,
  const std::vector<unsigned char>& onBoundary);

} // namespace cadrefine
