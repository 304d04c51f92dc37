// Making a mesh one of second order, its mid nodes on the CAD.
#pragma once

#include "classification/DistributedBoundary.h"
#include "comm/RunStatistics.h"
#include "mesh/DistributedMesh.h"

#include <cadrefine/classification/Classification.h>

#include <cstdint>

namespace cadrefine
{

/// Gives the mesh a mid node in the middle of each edge, shared by all ranks that have the edge,
/// with ids that follow from those of the ends. Collective; one numbering (see numberMidpoints).
void addMidNodes(RankExchange& exchange, DistributedMesh& mesh);

/// The same, and moves the mid nodes of edges on the CAD to where the class of their edge in
/// `classified`, the boundary of the mesh, says, as far as all cells stay valid (see MidNodeGuard),
/// but for those of pyramids; those of the edges over them in layers go along (see LayerColumns).
/// The classification gets an entry for each mid node, with what is left of its way for a distance.
/// With `move` false they stay in the middle, classified. Returns how many were projected, over all
/// ranks. Adds to the figures "seconds mid nodes".
///
/// Collective. Work: that of LayerColumns, one projection for each edge on the CAD, shared out
/// evenly, and the sweeps of MidNodeGuard, at most 20 over cells whose nodes have changed.
/// Messages: those of these steps, and for each sweep an exchange of 8 bytes a shared edge and one
/// reduction.
std::int64_t placeMidNodes(RankExchange& exchange, DistributedMesh& mesh,
  const ClassifiedBoundary& classified, Classification& classification, bool move,
  RunStatistics& statistics);

} // namespace cadrefine
