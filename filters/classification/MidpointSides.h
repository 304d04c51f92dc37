// Midpoints of edges that lead so far across a bore that its other side is as near.
#pragma once

#include "classification/EdgeMidpoints.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace cadrefine
{

/// Turns midpoints of smooth edges to the side of the CAD that the facets beside them stand for:
/// the outward normal of the CAD has to point as theirs do (see facing in MidpointProjection.h). In
/// meshes of area it does nothing. `edgesOf`: the number of the edge of each midpoint; `edgeAt`
/// gives the edge. Collective; a reduction, and where a midpoint is farther from its place than a
/// tenth of its edge is long, findSides and an exchange of 24 bytes a shared edge.
void turnToFacets(RankExchange& exchange, const MarkedEdges& edges,
  const ClassifiedBoundary& classified, const Classification& classification,
  const std::vector<Index>& edgesOf, const std::function<BoundaryEdge(std::size_t)>& edgeAt,
  std::vector<MidpointOnCAD>& midpoints);

} // namespace cadrefine
