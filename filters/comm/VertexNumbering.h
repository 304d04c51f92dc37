// Numbers over all ranks of what lies at the vertices of a mesh.
#pragma once

#include "comm/GlobalNumbering.h"
#include "comm/RankExchange.h"
#include "comm/SharedVertices.h"

#include <array>
#include <cstddef>
#include <vector>

namespace cadrefine
{

/// Something that is known by a vertex and K ids more: an edge (K = 1) or a cell (K = 3, or 7
/// of a hexahedron) by its vertex with the smallest id and the others, ascending, -1 standing for
/// none.
template<std::size_t K>
struct VertexKey
{
  Index vertex;
  std::array<GlobalId, K> rest;
};

/// The numbers that numberDistinct gives to (ids[vertex], rest...), for far fewer messages: keys at
/// a vertex that other ranks hold go to its owner (8 K bytes each) and their places there come
/// back; otherwise each vertex with keys takes part in a parallel sort, which is one for some seven
/// edges or six tetrahedra. Collective.
///
/// @param exchange the ranks.
/// @param vertices all vertices that several ranks hold; a vertex has keys on its holders only.
/// @param ids of the local vertices.
/// @param keys of this rank.
template<std::size_t K>
Numbering numberAtVertices(RankExchange& exchange, const SharedVertices& vertices,
  const std::vector<GlobalId>& ids, const std::vector<VertexKey<K>>& keys);

extern template Numbering numberAtVertices<1>(RankExchange&, const SharedVertices&,
  const std::vector<GlobalId>&, const std::vector<VertexKey<1>>&);
extern template Numbering numberAtVertices<3>(RankExchange&, const SharedVertices&,
  const std::vector<GlobalId>&, const std::vector<VertexKey<3>>&);
extern template Numbering numberAtVertices<7>(RankExchange&, const SharedVertices&,
  const std::vector<GlobalId>&, const std::vector<VertexKey<7>>&);

} // namespace cadrefine
