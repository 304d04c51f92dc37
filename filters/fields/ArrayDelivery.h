// Arrays of cells that go to other ranks.
#pragma once

#include "comm/RankExchange.h"
#include "fields/ArrayTransfer.h"

#include <vector>

namespace cadrefine
{

/// What each rank gets of this rank's arrays; the same number of entries as ranks.
using Delivery = std::vector<ArraySelection>;

/// The arrays that this rank gets, those of the lowest rank first, bit for bit and in their own
/// type; field data stay. Arrays that not all senders have are lost. Throws Error on all ranks
/// where arrays cannot be sent. Collective. Every tuple is sent once.
MeshArrays deliver(RankExchange& exchange, const MeshArrays& arrays, const Delivery& delivery);

} // namespace cadrefine
