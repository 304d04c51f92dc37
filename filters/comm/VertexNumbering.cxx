// 1. Every rank sorts its keys by vertex, and those of a vertex by the rest; equal ones have the
//    same place at the vertex.
// 2. Those at shared vertices go to the owner, which merges them with its own and sends their
//    places back.
// 3. A parallel sort of the vertices by id, weighing as many distinct keys as they have, gives the
//    number of the first key of each vertex to its owner, which tells the other holders.

#include "comm/VertexNumbering.h"

#include <cadrefine/base/LargeMemory.h>
#include <cadrefine/base/SortUniquely.h>
#include <cadrefine/base/VertexBuckets.h>

#include <algorithm>
#include <cstdint>

namespace cadrefine
{

namespace
{

template<std::size_t K>
using Rest = std::array<GlobalId, K>;

// A key at its vertex.
template<std::size_t K>
struct Entry
{
  Rest<K> rest;
  std::uint32_t key; // its position in the list of keys
};

template<std::size_t K>
class VertexNumbering
{
public:
  VertexNumbering(
    RankExchange& exchange, const SharedVertices& vertices, const std::vector<GlobalId>& ids)
    : exchange_(exchange), vertices_(vertices), ids_(ids), counts_(ids.size(), 0)
  {
  }

  Numbering run(const std::vector<VertexKey<K>>& keys)
  {
    resizeLong(places_, keys.size());
    sortLocally(keys);
    mergeShared(keys);
    return number(keys);
  }

private:
  // Distinct rests at a shared vertex, ascending.
  using Rests = std::vector<Rest<K>>;

  void sortLocally(const std::vector<VertexKey<K>>& keys)
  {
    std::vector<char> isShared(ids_.size(), 0);
    for (const Index vertex : vertices_.all)
    {
      isShared[static_cast<std::size_t>(vertex)] = 1;
    }
    rests_.resize(vertices_.all.size());

    VertexBuckets<Entry<K>> buckets(ids_.size(),
      [&](const auto& use)
      {
        for (std::size_t i = 0; i < keys.size(); ++i)
        {
          use(keys[i].vertex, { keys[i].rest, static_cast<std::uint32_t>(i) });
        }
      });
    std::size_t slot = 0;
    buckets.forEach(
      [&](Index vertex, Entry<K>* first, Entry<K>* last)
      {
        const auto v = static_cast<std::size_t>(vertex);
        Rests* rests = isShared[v] ? &rests_[slot++] : nullptr;
        counts_[v] = placeEntries(first, last, rests);
      });
  }

  // Places of the entries of a vertex; the number of distinct ones, which go to `rests` if there is
  // one.
  std::int64_t placeEntries(Entry<K>* first, Entry<K>* last, Rests* rests)
  {
    const auto less = [](const Entry<K>& a, const Entry<K>& b) { return a.rest < b.rest; };
    if (!std::is_sorted(first, last, less))
    {
      std::sort(first, last, less);
    }
    std::int64_t distinct = 0;
    for (const Entry<K>* entry = first; entry != last; ++entry)
    {
      if (entry == first || entry[-1].rest != entry->rest)
      {
        ++distinct;
        if (rests)
        {
          rests->push_back(entry->rest);
        }
      }
      places_[entry->key] = static_cast<Index>(distinct - 1);
    }
    return distinct;
  }

  // Calls use(slot) for the vertices shared with a neighbour that `owner` owns, in the same order
  // on both sides.
  template<class Use>
  void forOwned(std::size_t neighbour, int owner, const Use& use) const
  {
    for (const Index slot : vertices_.slots[neighbour])
    {
      if (vertices_.holdersOfSlot(static_cast<std::size_t>(slot)).lowest() == owner)
      {
        use(static_cast<std::size_t>(slot));
      }
    }
  }

  void mergeShared(const std::vector<VertexKey<K>>& keys)
  {
    const auto incoming = sendToOwners();
    std::vector<Rests> merged = rests_;
    forReceived(incoming,
      [&](std::size_t, std::size_t slot, const Rest<K>& rest) { merged[slot].push_back(rest); });
    for (Rests& rests : merged)
    {
      sortUniquely(rests);
    }
    const auto placeIn = [](const Rests& rests, const Rest<K>& rest) {
      return static_cast<Index>(std::lower_bound(rests.begin(), rests.end(), rest) - rests.begin());
    };
    std::vector<std::vector<Index>> answers(vertices_.neighbours.size());
    forReceived(incoming, [&](std::size_t neighbour, std::size_t slot, const Rest<K>& rest)
      { answers[neighbour].push_back(placeIn(merged[slot], rest)); });
    const auto answered = exchange_.exchange(vertices_.neighbours, answers);

    // The places at each shared vertex of this rank's distinct rests.
    std::vector<std::vector<Index>> places(vertices_.all.size());
    for (std::size_t slot = 0; slot < places.size(); ++slot)
    {
      const bool mine = vertices_.holdersOfSlot(slot).lowest() == vertices_.rank;
      for (std::size_t r = 0; mine && r < rests_[slot].size(); ++r)
      {
        places[slot].push_back(placeIn(merged[slot], rests_[slot][r]));
      }
      counts_[static_cast<std::size_t>(vertices_.all[slot])] =
        mine ? static_cast<std::int64_t>(merged[slot].size()) : 0;
    }
    for (std::size_t n = 0; n < answered.size(); ++n)
    {
      auto next = answered[n].begin();
      forOwned(n, vertices_.neighbours[n],
        [&](std::size_t slot)
        {
          const auto end = next + static_cast<std::ptrdiff_t>(rests_[slot].size());
          places[slot].assign(next, end);
          next = end;
        });
    }
    replacePlaces(keys, places);
  }

  // For each neighbour that owns shared vertices, and each of these, how many distinct rests this
  // rank has there, and the rests.
  std::vector<std::vector<GlobalId>> sendToOwners()
  {
    std::vector<std::vector<GlobalId>> outgoing(vertices_.neighbours.size());
    for (std::size_t n = 0; n < outgoing.size(); ++n)
    {
      forOwned(n, vertices_.neighbours[n],
        [&](std::size_t slot)
        {
          outgoing[n].push_back(static_cast<GlobalId>(rests_[slot].size()));
          for (const Rest<K>& rest : rests_[slot])
          {
            outgoing[n].insert(outgoing[n].end(), rest.begin(), rest.end());
          }
        });
    }
    return exchange_.exchange(vertices_.neighbours, outgoing);
  }

  // Calls use(neighbour, slot, rest) for what came for the vertices that this rank owns.
  template<class Use>
  void forReceived(const std::vector<std::vector<GlobalId>>& incoming, const Use& use) const
  {
    for (std::size_t n = 0; n < incoming.size(); ++n)
    {
      auto next = incoming[n].begin();
      forOwned(n, vertices_.rank,
        [&](std::size_t slot)
        {
          for (GlobalId left = *next++; left > 0; --left)
          {
            Rest<K> rest;
            std::copy_n(next, K, rest.begin());
            next += K;
            use(n, slot, rest);
          }
        });
    }
  }

  // From places among this rank's keys at a vertex to those among all ranks' keys.
  void replacePlaces(
    const std::vector<VertexKey<K>>& keys, const std::vector<std::vector<Index>>& places)
  {
    if (vertices_.all.empty())
    {
      return;
    }
    std::vector<Index> slotOf(ids_.size(), -1);
    for (std::size_t slot = 0; slot < vertices_.all.size(); ++slot)
    {
      slotOf[static_cast<std::size_t>(vertices_.all[slot])] = static_cast<Index>(slot);
    }
    for (std::size_t i = 0; i < keys.size(); ++i)
    {
      const Index slot = slotOf[static_cast<std::size_t>(keys[i].vertex)];
      if (slot >= 0)
      {
        places_[i] = places[static_cast<std::size_t>(slot)][static_cast<std::size_t>(places_[i])];
      }
    }
  }

  Numbering number(const std::vector<VertexKey<K>>& keys)
  {
    std::vector<GlobalId> owned;
    std::vector<Index> weights;
    for (std::size_t v = 0; v < ids_.size(); ++v)
    {
      if (counts_[v] > 0)
      {
        owned.push_back(ids_[v]);
        weights.push_back(counts_[v]);
      }
    }
    const Numbering ofOwned = denseOffsets(exchange_, std::move(owned), weights);
    std::vector<GlobalId> first(ids_.size(), 0);
    auto next = ofOwned.numbers.begin();
    for (std::size_t v = 0; v < ids_.size(); ++v)
    {
      first[v] = counts_[v] > 0 ? *next++ : 0;
    }
    copyFromOwners(exchange_, vertices_, first);

    Numbering result;
    result.count = ofOwned.count;
    resizeLong(result.numbers, keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i)
    {
      result.numbers[i] = first[static_cast<std::size_t>(keys[i].vertex)] + places_[i];
    }
    return result;
  }

  RankExchange& exchange_;
  const SharedVertices& vertices_;
  const std::vector<GlobalId>& ids_;
  std::vector<std::int64_t> counts_; // distinct keys at a vertex, over all ranks where it is owned
  std::vector<Index> places_;        // of each key at its vertex
  std::vector<Rests> rests_;         // for each shared vertex
};

} // namespace

template<std::size_t K>
Numbering numberAtVertices(RankExchange& exchange, const SharedVertices& vertices,
  const std::vector<GlobalId>& ids, const std::vector<VertexKey<K>>& keys)
{
  return VertexNumbering<K>(exchange, vertices, ids).run(keys);
}

template Numbering numberAtVertices<1>(RankExchange&, const SharedVertices&,
  const std::vector<GlobalId>&, const std::vector<VertexKey<1>>&);
template Numbering numberAtVertices<3>(RankExchange&, const SharedVertices&,
  const std::vector<GlobalId>&, const std::vector<VertexKey<3>>&);
template Numbering numberAtVertices<7>(RankExchange&, const SharedVertices&,
  const std::vector<GlobalId>&, const std::vector<VertexKey<7>>&);

} // namespace cadrefine
