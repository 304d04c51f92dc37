// Which facets of a mesh's boundary are on the CAD though their normals fit none of its faces.
#pragma once

#include "classification/DistributedBoundary.h"

#include <cadrefine/base/EntityId.h>

#include <vector>

namespace cadrefine
{

/// Finds the odd facets (FacetRecord::odd) of a coarse mesh that are on the CAD, and their faces:
/// they come in patches, joined at their edges, and
///   1. a triangle that only facets on the CAD surround is on it; so is a patch, but where a mesh
///      ends in the midst of a pipe of the CAD, turned by more than 60 degrees from all that
///      surround it, which are on the faces it would be on; or at a rim of a pipe, as it is beside
///      a CAD edge that bounds one face alone, or beyond it are faces that go on to another rim;
///   2. an ear (BoundaryProjector::earOf) beside a facet on the CAD is on it too, one of a patch
///      only if the patch turns by less than 60 degrees from such a facet.
/// The face of a patch is what lies beyond the CAD edges between it and its surroundings, or, where
/// there is no such edge, theirs; of an ear or a patch for which they differ the face of the
/// neighbour from which it turns least, of an ear, or of all neighbours; if all corners lie on it.
///
/// Given the records of the facets beside each edge (gatherFacetRecords). Returns whether there are
/// any on some rank. Collective. Work: linear in the boundary, as often as the widest patch is
/// facets wide; messages: 16 bytes for each edge of the interface each time.
bool joinOddFacets(RankExchange& exchange, const Mesh& mesh, const DistributedBoundary& boundary,
  const std::vector<EntityId>& entities, const CADModel& model,
  const std::vector<std::vector<FacetRecord>>& ofEdges, std::vector<FacetRecord>& records);

} // namespace cadrefine
