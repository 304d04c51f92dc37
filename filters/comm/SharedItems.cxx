#include "comm/SharedItems.h"

#include <cadrefine/base/SortUniquely.h>

#include <algorithm>
#include <utility>

namespace cadrefine
{

namespace
{

std::vector<Index> sortedUnion(const std::vector<std::vector<Index>>& lists)
{
  std::vector<Index> all;
  for (const std::vector<Index>& list : lists)
  {
    all.insert(all.end(), list.begin(), list.end());
  }
  sortUniquely(all);
  return all;
}

Index slotOf(const std::vector<Index>& all, Index item)
{
  return static_cast<Index>(std::lower_bound(all.begin(), all.end(), item) - all.begin());
}

// Neighbours are ascending, so that writing their entries in turn leaves each item's holders
// ascending; this rank takes its place among them.
void listHolders(SharedItems& shared)
{
  std::vector<std::size_t>& offsets = shared.holderOffsets;
  offsets.assign(shared.all.size() + 1, 1);
  offsets[0] = 0;
  for (const std::vector<Index>& slots : shared.slots)
  {
    for (const Index slot : slots)
    {
      ++offsets[static_cast<std::size_t>(slot) + 1];
    }
  }
  for (std::size_t slot = 0; slot < shared.all.size(); ++slot)
  {
    offsets[slot + 1] += offsets[slot];
  }

  shared.holders.resize(offsets.back());
  std::vector<std::size_t> next(offsets.begin(), offsets.end() - 1);
  const auto higher =
    std::lower_bound(shared.neighbours.begin(), shared.neighbours.end(), shared.rank) -
    shared.neighbours.begin();
  const auto write = [&](std::size_t firstNeighbour, std::size_t lastNeighbour)
  {
    for (std::size_t n = firstNeighbour; n < lastNeighbour; ++n)
    {
      for (const Index slot : shared.slots[n])
      {
        shared.holders[next[static_cast<std::size_t>(slot)]++] = shared.neighbours[n];
      }
    }
  };
  write(0, static_cast<std::size_t>(higher));
  for (std::size_t& position : next)
  {
    shared.holders[position++] = shared.rank;
  }
  write(static_cast<std::size_t>(higher), shared.neighbours.size());
}

} // namespace

SharedItems::Ranks SharedItems::holdersOf(Index item) const
{
  const std::size_t slot = static_cast<std::size_t>(slotOf(all, item));
  if (slot < all.size() && all[slot] == item)
  {
    return holdersOfSlot(slot);
  }
  return { &rank, &rank + 1 };
}

std::vector<char> SharedItems::ownedHere(Index itemCount) const
{
  std::vector<char> owned(static_cast<std::size_t>(itemCount), 1);
  for (std::size_t slot = 0; slot < all.size(); ++slot)
  {
    owned[static_cast<std::size_t>(all[slot])] = holdersOfSlot(slot).lowest() == rank ? 1 : 0;
  }
  return owned;
}

SharedItems makeSharedItems(
  int rank, std::vector<int> neighbours, std::vector<std::vector<Index>> items)
{
  SharedItems shared;
  shared.rank = rank;
  shared.neighbours = std::move(neighbours);
  shared.items = std::move(items);
  shared.all = sortedUnion(shared.items);
  shared.slots.reserve(shared.items.size());
  for (const std::vector<Index>& list : shared.items)
  {
    std::vector<Index>& slots = shared.slots.emplace_back();
    slots.reserve(list.size());
    for (const Index item : list)
    {
      slots.push_back(slotOf(shared.all, item));
    }
  }
  listHolders(shared);
  return shared;
}

void combineFlags(
  RankExchange& exchange, const SharedItems& shared, std::vector<unsigned char>& flags)
{
  combineLargest(exchange, shared, flags);
}

} // namespace cadrefine
