// How much a mesh turns from facet to facet.
#pragma once

#include "DistributedBoundary.h"

#include <vector>

namespace cadrefine
{

/// Whether the surface may be expected to be smooth across a mesh edge of this class.
bool isSmooth(const EdgeClass& edgeClass, const CADModel& model);

/// For each facet on the CAD the largest angle, in degrees, between its normal and that of a
/// neighbour on the CAD, across edges that lie on no crease of the CAD; for segments across
/// vertices that lie on no CAD vertex. 0 for other facets, and where more than two meet.
///
/// Of triangles in space, which need not be turned alike, the smaller angle between their planes.
/// Collective; messages in proportion to the interface between pieces.
std::vector<double> neighbourAngles(RankExchange& exchange, const DistributedMesh& mesh,
  const ClassifiedBoundary& classified, const Classification& classification);

} // namespace cadrefine
