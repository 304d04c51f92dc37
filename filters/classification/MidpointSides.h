// Midpoints of edges that lead so far across a bore that its other side is as near.
#pragma once

#include "classification/EdgeMidpoints.h"

#include <vector>

namespace cadrefine
{

/// Turns midpoints of smooth edges to the side of the CAD that the facets beside them stand for:
/// the outward normal of the CAD has to point as theirs do (see facing in MidpointProjection.h). In
/// meshes of area it does nothing. `edgesOf`: the edge of each midpoint. Collective; a reduction,
/// and where a midpoint is farther from its place than a quarter of its edge is long, which is
/// rare: an evaluation for each facet, a sum of two numbers for each CAD face, and an exchange of
/// 32 bytes a shared edge.
void turnToFacets(RankExchange& exchange, const Mesh& mesh, const MarkedEdges& edges,
  const std::vector<SharedClass>& classes, const ClassifiedBoundary& classified,
  const Classification& classification, const std::vector<Index>& edgesOf,
  std::vector<MidpointOnCAD>& midpoints);

} // namespace cadrefine
