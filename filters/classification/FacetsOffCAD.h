// Facets that look like a part of the CAD and are none.
#pragma once

#include "classification/ProjectionTask.h"

#include <cadrefine/classification/EdgeFinder.h>

#include <vector>

namespace cadrefine
{

/// Takes facets between two cells off the CAD where outer ones are on the same face of it (of a
/// planar mesh, edge), or others whose corners are there, but for rounding, while none of theirs
/// is. `hits`: the nearest points of the vertices. Collective.
void leaveEndsOfLayers(const ProjectionTask& task, const std::vector<ClosestPoint>& hits,
  std::vector<FacetRecord>& records);

/// Takes outer facets off the CAD that are no part of a face on which three quarters of those that
/// face alike lie exactly: walls that turn from it by more than 30 degrees, where they meet it, or
/// that face the other way, beyond a gap that is narrower than facets are long; and what is left of
/// plane walls, which turns by more than 10 degrees, and continues facets that are off the CAD.
/// Collective. Work: a nearest point for each facet on a face that has exact facets and others.
/// Messages: an exchange of records for each ring of facets of plane walls.
void leaveWalls(const ProjectionTask& task, const std::vector<ClosestPoint>& hits,
  std::vector<FacetRecord>& records);

} // namespace cadrefine
