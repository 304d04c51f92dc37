// Arrays of vertices and cells that go to other ranks.
#pragma once

#include "comm/RankExchange.h"
#include "fields/ArrayTransfer.h"

#include <cstddef>
#include <vector>

namespace cadrefine
{

/// Which tuples of vertices and cells go to which ranks, and which of those that arrive are kept.
struct Delivery
{
  std::vector<ArraySelection> toRanks; ///< Which of this rank's tuples each rank gets.
  /// Number of points that came from each rank, and of cells below.
  std::vector<std::size_t> points;
  std::vector<std::size_t> cells;
  /// What is kept of what came, that of the lowest rank first; a vertex that came from several
  /// ranks once.
  ArraySelection kept;
};

/// Calls use(rank, place in what came from it, place in what is kept) for all that is kept, in its
/// order, given how much came from each rank.
template<class Use>
void forKept(
  const std::vector<vtkIdType>& kept, const std::vector<std::size_t>& counts, const Use& use)
{
  std::size_t rank = 0;
  vtkIdType first = 0;
  const auto end = [&] { return first + static_cast<vtkIdType>(counts[rank]); };
  for (std::size_t k = 0; k < kept.size(); ++k)
  {
    if (kept[k] < first)
    {
      rank = 0;
      first = 0;
    }
    while (kept[k] >= end())
    {
      first = end();
      ++rank;
    }
    use(rank, kept[k] - first, k);
  }
}

/// The arrays that this rank gets, bit for bit and in their own type; field data stay. Arrays that
/// not all senders have are lost. Throws Error on all ranks where arrays cannot be sent.
/// Collective. Every tuple is sent once.
MeshArrays deliver(RankExchange& exchange, const MeshArrays& arrays, const Delivery& delivery);

} // namespace cadrefine
