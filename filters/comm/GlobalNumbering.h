// Numbers over all ranks that do not depend on how the mesh is split.
#pragma once

#include "comm/RankExchange.h"

#include <cadrefine/base/MeshTypes.h>
#include <cadrefine/base/Vector3.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace cadrefine
{

/// What is numbered: compared as std::array, first entry first. K is 1, 2, 3 or 4.
template<std::size_t K>
using Key = std::array<std::int64_t, K>;

struct Numbering
{
  /// The number of each local key.
  std::vector<GlobalId> numbers;
  /// How many distinct keys there are over all ranks, or what all weights sum up to.
  GlobalId count = 0;
};

/// For each local key the number of smaller distinct keys on all ranks: equal keys, of one rank or
/// of several, get the same number, and the numbers are 0, 1, ..., count - 1. Collective.
///
/// Cost: a sample sort. Each distinct key of a rank goes to one rank and its number comes back:
/// 8 * (K + 1) bytes a key; up to 2 P messages a rank in all. One rank sorts O(P) samples (64 a
/// rank on average). A rank gets N / P of the N keys sent on average, with 64 samples for each
/// bucket seldom more than half as much again, however the keys are spread; a key that is on
/// all ranks adds at most P. The numbers do not depend on the samples.
template<std::size_t K>
Numbering numberDistinct(RankExchange& exchange, const std::vector<Key<K>>& keys);

/// For each local key the sum of the weights of all smaller keys on all ranks; count is the sum of
/// all weights. Collective; costs 8 bytes a key more than numberDistinct.
///
/// Fails, on all ranks with the reason, where a key occurs twice, on one rank or on two, or where
/// there are not as many weights as keys.
template<std::size_t K>
Numbering offsets(RankExchange& exchange, const std::vector<Key<K>>& keys,
  const std::vector<std::int64_t>& weights);

/// The result of `offsets` for keys that are whole numbers. Where these lie dense (over all ranks
/// at most four times as many numbers in their range as are given) each rank keeps a stretch of the
/// range, and the sums of weights come to where their numbers lie. Numbers of a rank that follow
/// each other, and lie in one stretch, go as one: 16 bytes for each such run, and 8 back. So where
/// ranks hold few runs, it is the runs that cost, not the numbers; sums take the place of numbers
/// that are moved here.
Numbering denseOffsets(
  RankExchange& exchange, std::vector<GlobalId> numbers, const std::vector<Index>& weights);

/// A key that orders doubles as < does; -0.0 and 0.0 have the same. NaN come before or after all
/// numbers, depending on their sign.
std::int64_t coordinateKey(double coordinate);

/// Orders points by x, then y, then z; points with equal coordinates have the same key.
inline Key<3> coordinateKey(const Point3& point)
{
  return { coordinateKey(point[0]), coordinateKey(point[1]), coordinateKey(point[2]) };
}

} // namespace cadrefine
