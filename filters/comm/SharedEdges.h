// Which edges and facets other ranks hold too.
#pragma once

#include "comm/SharedVertices.h"

#include <array>
#include <cstddef>
#include <vector>

namespace cadrefine
{

/// Edges held by several ranks; see SharedItems. An item is a place in the list of edges.
using SharedEdges = SharedItems;

/// Finds the edges, facets or cells, given by N local vertices each (where some have fewer, -1
/// follows), that other ranks hold too. Collective.
///
/// @param exchange the ranks.
/// @param vertices the local vertices that several ranks hold.
/// @param ids the global id of each local vertex.
/// @param cells each cell once, its vertices in any order. A cell that is in several
///   ranks' lists is shared by these ranks; the others' lists need not have it, though they may
///   hold all of its vertices.
///
/// Items of a neighbour are ordered by their sorted global ids. Cost: one message to and from each
/// neighbour of `vertices`, of 8 * N bytes for every cell all of whose vertices that neighbour
/// holds; no other rank is asked.
///
/// Fails, on all ranks with the reason, where one of these cells is listed twice.
template<std::size_t N>
SharedItems findSharedCells(RankExchange& exchange, const SharedVertices& vertices,
  const std::vector<GlobalId>& ids, const std::vector<std::array<Index, N>>& cells);

extern template SharedItems findSharedCells<2>(RankExchange&, const SharedVertices&,
  const std::vector<GlobalId>&, const std::vector<std::array<Index, 2>>&);
extern template SharedItems findSharedCells<3>(RankExchange&, const SharedVertices&,
  const std::vector<GlobalId>&, const std::vector<std::array<Index, 3>>&);
extern template SharedItems findSharedCells<4>(RankExchange&, const SharedVertices&,
  const std::vector<GlobalId>&, const std::vector<std::array<Index, 4>>&);
extern template SharedItems findSharedCells<5>(RankExchange&, const SharedVertices&,
  const std::vector<GlobalId>&, const std::vector<std::array<Index, 5>>&);
extern template SharedItems findSharedCells<6>(RankExchange&, const SharedVertices&,
  const std::vector<GlobalId>&, const std::vector<std::array<Index, 6>>&);
extern template SharedItems findSharedCells<8>(RankExchange&, const SharedVertices&,
  const std::vector<GlobalId>&, const std::vector<std::array<Index, 8>>&);

/// The shared points among the vertices and the midpoints of edges: the shared vertices, and the
/// midpoints of shared edges. `midpointOf` gives the number of the midpoint of each edge, larger
/// for larger edges, or -1. No communication.
SharedVertices sharedWithMidpoints(
  const SharedVertices& vertices, const SharedEdges& edges, const std::vector<Index>& midpointOf);

/// findSharedCells for edges.
inline SharedEdges findSharedEdges(RankExchange& exchange, const SharedVertices& vertices,
  const std::vector<GlobalId>& ids, const std::vector<std::array<Index, 2>>& edges)
{
  return findSharedCells<2>(exchange, vertices, ids, edges);
}

} // namespace cadrefine
