// Facets of a mesh's boundary whose normals do not tell whether they are on the CAD or on which
// face.
#pragma once

#include "classification/DistributedBoundary.h"

#include <cadrefine/base/EntityId.h>

#include <vector>

namespace cadrefine
{

/// Finds the odd facets (FacetRecord::odd) of a coarse mesh that are on the CAD, and their faces:
/// they come in patches, joined at their edges, and
///   1. a triangle is on the CAD if all facets beside it are; so is a patch, unless the mesh ends
///      there, in one of two ways. In the middle of a pipe of the CAD: the patch is turned by more
///      than 60 degrees from all facets beside it, these are on the faces that it would be on, and
///      no mesh edge inside it joins vertices on one CAD edge. At the rim of a pipe: a CAD edge
///      that bounds a single face is beside the patch, or the faces beyond the edges beside it go
///      on to another rim. In a mesh of area in space, which may end anywhere, a patch is on the
///      CAD unless it is a rib, which two facets on the CAD meet at an edge, or ends at a CAD edge
///      that bounds a single face, as a bulkhead does;
///   2. an ear (BoundaryProjector::earOf) beside a facet on the CAD is on the CAD too; one that is
///      part of a patch only if the patch turns by less than 60 degrees from such a facet.
/// The face of a patch is the one beyond the CAD edges between it and the facets beside it; where
/// there is no such edge, that of these facets. Where these differ, an ear takes the face of the
/// neighbour from which it turns least, another facet the face that all its neighbours have. Always
/// all corners must lie on that face.
///
/// Given the records of the facets beside each edge (gatherFacetRecords). Returns whether there are
/// any on some rank. Collective. Work: linear in the boundary, as often as the widest patch is
/// facets wide; messages: 16 bytes for each edge of the interface each time.
bool joinOddFacets(RankExchange& exchange, const Mesh& mesh, const DistributedBoundary& boundary,
  const std::vector<EntityId>& entities, const CADModel& model,
  const std::vector<std::vector<FacetRecord>>& ofEdges, std::vector<FacetRecord>& records);

/// Finds the faces of ears on the CAD, whose normals may fit the face on either side of their CAD
/// edge: an ear is on the face of the facet beyond its long side, which is opposite to an obtuse
/// angle, if that is a face beside the edge.
///
/// Returns whether there are any on some rank whose face was another. Collective. Work: linear in
/// the ears.
bool joinEars(RankExchange& exchange, const Mesh& mesh, const DistributedBoundary& boundary,
  const NurbsModel& model, const std::vector<std::vector<FacetRecord>>& ofEdges,
  std::vector<FacetRecord>& records);

} // namespace cadrefine
