// How much a mesh turns from facet to facet.
#pragma once

#include "classification/DistributedBoundary.h"

#include <vector>

namespace cadrefine
{

/// Whether the surface may be expected to be smooth across a mesh edge of this class.
bool isSmooth(const EdgeClass& edgeClass, const CADModel& model);

/// For each facet on the CAD the largest angle, in degrees from 0 to 180, by which the mesh turns
/// from it to a neighbour on the CAD, across edges that lie on no crease of the CAD; for segments
/// across vertices that lie on no CAD vertex. 0 for other facets, and where more than two meet.
///
/// Facets need not be turned alike: triangles in space and listed facets inside the mesh are as the
/// input has them. Collective; messages of 32 bytes for each edge or vertex of the interface.
std::vector<double> neighbourAngles(RankExchange& exchange, const DistributedMesh& mesh,
  const ClassifiedBoundary& classified, const Classification& classification);

} // namespace cadrefine
