// The smallest set of items that carries a given part of a sum over all ranks.
#pragma once

#include "comm/RankExchange.h"

#include <cstdint>
#include <vector>

namespace cadrefine
{

/// Returns 1 for the items with the largest values, as few as carry at least `fraction` of the sum
/// of all values on all ranks; of equal values those with the smaller ids. No item is chosen where
/// the sum is 0, else at least one (W. Dörfler, "A convergent adaptive algorithm for Poisson's
/// equation", SIAM J. Numer. Anal. 33, 1996). The same for every way of sharing the items out: sums
/// are exact to 2^-111 of the largest value (see FixedPointSum), and are then rounded to double, so
/// that values which together are below 2^-53 of the sum are left out even for the fraction 1.
///
/// @param exchange the ranks.
/// @param values finite, not negative.
/// @param ids one a value, 0 or more, none twice on any ranks.
/// @param fraction in (0, 1].
///
/// Collective. Work: each item is looked at once for each byte of its value (8) until it is known
/// to be above or below the cut; so for ids, among the values equal to the cut. Messages: a
/// reduction of 8 KiB for each byte.
std::vector<unsigned char> markBulk(RankExchange& exchange, const std::vector<double>& values,
  const std::vector<std::int64_t>& ids, double fraction);

} // namespace cadrefine
