// Which vertices other ranks hold too.
#pragma once

#include "comm/SharedItems.h"

#include <vector>

namespace cadrefine
{

/// Vertices held by several ranks; see SharedItems.
using SharedVertices = SharedItems;

/// Finds the ranks that hold the same vertices as this one. Collective.
///
/// @param exchange the ranks.
/// @param ids the global id of each local vertex; a vertex has the same id wherever it is held, and
///   no two vertices of a rank have the same.
/// @param candidates the local vertices that other ranks may hold (all, or those on the surface of
///   the piece); a shared vertex must be a candidate on every rank that holds it. In any order.
///
/// Cost: each candidate's id goes to a home rank chosen by a hash of the id, and for each shared
/// one the list of its holders comes back: two allToAll with up to P messages a rank each, 8 bytes
/// a candidate, then 16 bytes and 8 a holder for each shared one. A home holds the candidates of
/// all ranks divided by P (on average). A vertex on h ranks costs its home h * h entries, so
/// vertices common to very many ranks should be rare; in a partitioned mesh they are.
///
/// Fails, on all ranks with the reason: a candidate that is not a vertex, two vertices of one rank
/// with the same id.
SharedVertices findSharedVertices(
  RankExchange& exchange, const std::vector<GlobalId>& ids, const std::vector<Index>& candidates);

} // namespace cadrefine
