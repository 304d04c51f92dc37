// Vertices, edges or facets that several ranks hold.
#pragma once

#include "comm/RankExchange.h"

#include <cadrefine/base/MeshTypes.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace cadrefine
{

/// What this rank's piece has in common with those of other ranks. An item is a local number: of a
/// vertex (findSharedVertices), or of an edge or facet (findSharedCells).
struct SharedItems
{
  /// Ranks on which an item is held, lowest first.
  struct Ranks
  {
    const int* first;
    const int* last;

    const int* begin() const { return first; }
    const int* end() const { return last; }
    std::size_t size() const { return static_cast<std::size_t>(last - first); }
    int lowest() const { return *first; }
  };

  /// This rank.
  int rank = 0;
  /// Ranks that hold at least one of this rank's items, lowest first.
  std::vector<int> neighbours;
  /// Per neighbour the items it holds too, in ascending order of their global ids: the k-th entry
  /// is the same item here and in the neighbour's list.
  std::vector<std::vector<Index>> items;
  /// Every item that is held elsewhere, once, ascending.
  std::vector<Index> all;
  /// Where items[n][k] stands in `all`.
  std::vector<std::vector<Index>> slots;
  /// The ranks that hold all[s], this one included: holders[holderOffsets[s]] up to
  /// holders[holderOffsets[s + 1]], lowest first.
  std::vector<std::size_t> holderOffsets = { 0 };
  std::vector<int> holders;

  Ranks holdersOfSlot(std::size_t slot) const
  {
    return { holders.data() + holderOffsets[slot], holders.data() + holderOffsets[slot + 1] };
  }

  /// The ranks that hold a local item; only this one, where it is not shared. O(log(all.size())).
  Ranks holdersOf(Index item) const;

  /// The lowest rank that holds a local item.
  int owner(Index item) const { return holdersOf(item).lowest(); }

  /// For each of `itemCount` local items 1 if this rank owns it (so that it counts in a sum over
  /// the ranks), else 0.
  std::vector<char> ownedHere(Index itemCount) const;
};

/// Makes SharedItems of the neighbours (ascending) and their items. No communication.
SharedItems makeSharedItems(
  int rank, std::vector<int> neighbours, std::vector<std::vector<Index>> items);

/// Gives each shared item, on all ranks that hold it, op(value on the lowest holder, ..., value on
/// the highest): the same bits everywhere, as op is applied in the order of the ranks. For a result
/// that does not depend on the partition, op must be associative and commutative (minimum,
/// maximum, or, sum of integers). `values` has one value per local item; values of items that are
/// not shared stay. Collective; one message to and from each neighbour.
template<class T, class Combine>
void combineShared(
  RankExchange& exchange, const SharedItems& shared, std::vector<T>& values, Combine op);

/// combineShared of the smallest, or the largest, of the values.
template<class T>
void combineSmallest(RankExchange& exchange, const SharedItems& shared, std::vector<T>& values);
template<class T>
void combineLargest(RankExchange& exchange, const SharedItems& shared, std::vector<T>& values);

/// Sets the flags of the shared items that any rank has set. Collective; as combineShared.
void combineFlags(
  RankExchange& exchange, const SharedItems& shared, std::vector<unsigned char>& flags);

/// Gives each shared item the value of its owner. Collective; one message to and from each
/// neighbour, which holds only what the sender owns.
template<class T>
void copyFromOwners(RankExchange& exchange, const SharedItems& shared, std::vector<T>& values);

// Implementation

template<class T, class Combine>
void combineShared(
  RankExchange& exchange, const SharedItems& shared, std::vector<T>& values, Combine op)
{
  std::vector<std::vector<T>> outgoing(shared.items.size());
  for (std::size_t n = 0; n < shared.items.size(); ++n)
  {
    outgoing[n].reserve(shared.items[n].size());
    for (const Index item : shared.items[n])
    {
      outgoing[n].push_back(values[static_cast<std::size_t>(item)]);
    }
  }
  const std::vector<std::vector<T>> incoming = exchange.exchange(shared.neighbours, outgoing);

  std::vector<T> mine;
  mine.reserve(shared.all.size());
  for (const Index item : shared.all)
  {
    mine.push_back(values[static_cast<std::size_t>(item)]);
  }
  std::vector<char> begun(shared.all.size(), 0);
  const auto combine = [&](std::size_t slot, const T& value)
  {
    T& result = values[static_cast<std::size_t>(shared.all[slot])];
    result = begun[slot] ? static_cast<T>(op(result, value)) : value;
    begun[slot] = 1;
  };
  const auto combineMine = [&]()
  {
    for (std::size_t slot = 0; slot < mine.size(); ++slot)
    {
      combine(slot, mine[slot]);
    }
  };

  bool mineDone = false;
  for (std::size_t n = 0; n < incoming.size(); ++n)
  {
    if (!mineDone && shared.neighbours[n] > shared.rank)
    {
      combineMine();
      mineDone = true;
    }
    for (std::size_t k = 0; k < incoming[n].size(); ++k)
    {
      combine(static_cast<std::size_t>(shared.slots[n][k]), incoming[n][k]);
    }
  }
  if (!mineDone)
  {
    combineMine();
  }
}

template<class T>
void combineSmallest(RankExchange& exchange, const SharedItems& shared, std::vector<T>& values)
{
  combineShared(exchange, shared, values, [](const T& a, const T& b) { return std::min(a, b); });
}

template<class T>
void combineLargest(RankExchange& exchange, const SharedItems& shared, std::vector<T>& values)
{
  combineShared(exchange, shared, values, [](const T& a, const T& b) { return std::max(a, b); });
}

template<class T>
void copyFromOwners(RankExchange& exchange, const SharedItems& shared, std::vector<T>& values)
{
  const auto ownerOf = [&](std::size_t n, std::size_t k)
  { return shared.holdersOfSlot(static_cast<std::size_t>(shared.slots[n][k])).lowest(); };

  std::vector<std::vector<T>> outgoing(shared.items.size());
  for (std::size_t n = 0; n < shared.items.size(); ++n)
  {
    for (std::size_t k = 0; k < shared.items[n].size(); ++k)
    {
      if (ownerOf(n, k) == shared.rank)
      {
        outgoing[n].push_back(values[static_cast<std::size_t>(shared.items[n][k])]);
      }
    }
  }
  const std::vector<std::vector<T>> incoming = exchange.exchange(shared.neighbours, outgoing);
  for (std::size_t n = 0; n < incoming.size(); ++n)
  {
    std::size_t next = 0;
    for (std::size_t k = 0; k < shared.items[n].size(); ++k)
    {
      if (ownerOf(n, k) == shared.neighbours[n])
      {
        values[static_cast<std::size_t>(shared.items[n][k])] = incoming[n][next++];
      }
    }
  }
}

} // namespace cadrefine
