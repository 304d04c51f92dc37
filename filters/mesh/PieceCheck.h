// Whether the pieces of a mesh make one mesh.
#pragma once

#include "mesh/DistributedMesh.h"

namespace cadrefine
{

/// Throws Error, on all ranks, where
/// - ranks have a point with the same global id at different places, or both have it, but not as a
///   point between their pieces: two points with one id, or pieces that overlap;
/// - a cell of the mesh's own dimension is listed twice, on one rank or on two (its sides would be
///   met twice, and no more be boundary).
///
/// Collective. Work: a sort of each vertex's cells, and one look at each cell. Sent: what
/// denseOffsets does for each vertex, 24 bytes a shared vertex, 32 bytes for each cell whose
/// vertices are all shared with the same rank; more only where there is something to complain of.
void checkPieces(RankExchange& exchange, const DistributedMesh& mesh);

/// Throws Error, on all ranks, that names the corners of two cells of the mesh that have the same
/// global id. Collective; for where it is known that there are such cells.
[[noreturn]] void complainOfRepeatedCells(
  RankExchange& exchange, const Mesh& mesh, const std::array<std::vector<GlobalId>, 4>& cellIds);

} // namespace cadrefine
