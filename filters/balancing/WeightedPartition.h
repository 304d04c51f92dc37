// Which rank each part of a distributed whole should go to.
#pragma once

#include "comm/RankExchange.h"

#include <cadrefine/base/Vector3.h>

#include <cstdint>
#include <vector>

namespace cadrefine
{

/// A rank for each of this rank's points, so that ranks get about the same sum of weights (at least
/// 0, below 2^24) and points that lie close together: Zoltan's recursive coordinate bisection (M.
/// J. Berger, S. H. Bokhari, IEEE Trans. Computers C-36, 1987; E. G. Boman et al., "The Zoltan and
/// Isorropia parallel toolkits", Sci. Programming 20, 2012), to an imbalance of 2% where the
/// weights allow that. With one rank all stay. Throws Error where Zoltan fails. Collective; O(n log
/// P) work and O(log P) rounds of exchanging points and reductions.
std::vector<int> partitionByWeight(RankExchange& exchange, const std::vector<Point3>& points,
  const std::vector<std::int64_t>& weights);

} // namespace cadrefine
