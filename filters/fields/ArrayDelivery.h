// Arrays of cells that go to other ranks.
#pragma once

#include "comm/RankExchange.h"
#include "fields/ArrayTransfer.h"

#include <cstddef>
#include <vector>

namespace cadrefine
{

/// What goes where, of what each vertex or cell has.
struct Delivery
{
  std::vector<ArraySelection> toRanks; ///< What each rank gets of this rank's.
  std::vector<std::size_t> points;     ///< How many came from each rank.
  std::vector<std::size_t> cells;
  /// Of what came, that of the lowest rank first; a vertex that came from several ranks once.
  ArraySelection kept;
};

/// use(rank, place in what came from it, place in what is kept), in this order, given how much came
/// from each rank.
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
