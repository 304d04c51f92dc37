// The facets by which a mesh in pieces meets its boundary, and what its tags tell apart.
#pragma once

#include "mesh/DistributedMesh.h"

#include <cadrefine/mesh/Facets.h>

#include <array>
#include <cstdint>
#include <vector>

namespace cadrefine
{

/// The ids of a facet's or a cell's corners; -1 for those that it does not have.
std::array<GlobalId, 4> idsOf(const Mesh& mesh, const std::array<Index, 4>& corners);

/// Finds the facets of this rank's cells that lie on the boundary of the whole mesh (of volume, or
/// a planar one):
///   - outer ones, sides that one cell alone meets, over all ranks;
///   - interior ones, between two cells, where a cell of one dimension less is listed in the mesh:
///     two materials, a baffle. They are with the cell of the smaller global id, and have the order
///     of the listed cell (of several, the one whose ids come first), whichever rank that is on.
///     With `tags`, hashes of the tags of the cells of the mesh's own dimension (none on any rank:
///     there are no tags), also sides between cells of different ones that are not 0.
///
/// With `among`, a flag for each vertex that may be on the boundary, others are not looked at (see
/// findOuterFacets). Collective. Work: that of findOuterFacets; where there are listed cells or
/// tags, a look at each side. One reduction and one message to and from each neighbour with the
/// sides that it may have too; where there are listed cells, two more, of N ids for each listed
/// cell all of whose N vertices the neighbour holds, and, as where there are tags, of 24 bytes for
/// each side in common.
std::vector<Facet> findBoundaryFacets(RankExchange& exchange, const DistributedMesh& mesh,
  const std::vector<unsigned char>& among, const std::vector<std::uint64_t>& tags = {});

/// 1 for vertices between cells of different tags, over all ranks, given hashes of the tags of the
/// cells of the mesh's own dimension (none on any rank: there are no tags). Collective. Work: one
/// look at each cell where there are tags.
std::vector<unsigned char> verticesBetweenTags(
  RankExchange& exchange, const DistributedMesh& mesh, const std::vector<std::uint64_t>& tags);

/// 1 for vertices of listed lines in a mesh of volume, and listed points; over all ranks.
/// Collective.
std::vector<unsigned char> verticesOfListedLines(
  RankExchange& exchange, const DistributedMesh& mesh);

} // namespace cadrefine
