// Shared vertices, edges and facets of a mesh that is split at random.
#include "ParallelTest.h"

#include "SplitMesh.h"
#include "comm/SharedEdges.h"

#include <cadrefine/base/Error.h>

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <numeric>
#include <set>

namespace cadrefine
{

namespace
{

class SharedItemsTest : public ParallelTest
{
protected:
  using Simplex = SplitMesh::Simplex;

  void split(int n, int firstRank = 0)
  {
    mesh = std::make_unique<SplitMesh>(n, firstRank, exchange.size(), commonRandom());
    piece = mesh->piece(exchange.rank(), ownRandom());
    vertexKeys.clear();
    for (const GlobalId id : piece.ids)
    {
      vertexKeys.push_back({ id });
    }
    edgeKeys = keysOf(piece.edges);
    facetKeys = keysOf(piece.facets);
  }

  template<std::size_t N>
  std::vector<Simplex> keysOf(const std::vector<std::array<Index, N>>& simplices) const
  {
    std::vector<Simplex> keys;
    for (const std::array<Index, N>& simplex : simplices)
    {
      Simplex& key = keys.emplace_back();
      for (const Index vertex : simplex)
      {
        key.push_back(piece.ids[static_cast<std::size_t>(vertex)]);
      }
      std::sort(key.begin(), key.end());
    }
    return keys;
  }

  SharedVertices findVertices()
  {
    std::vector<Index> candidates(piece.ids.size());
    std::iota(candidates.begin(), candidates.end(), 0);
    std::shuffle(candidates.begin(), candidates.end(), ownRandom);
    return findSharedVertices(exchange, piece.ids, candidates);
  }

  // Compares with the truth; keys[i] are the sorted ids of the local item i.
  void check(const SharedItems& shared, const std::vector<Simplex>& keys, std::size_t vertexCount)
  {
    std::map<int, std::vector<Simplex>> expected;
    for (const Simplex& simplex : mesh->shared(vertexCount, exchange.rank()))
    {
      for (const int rank : mesh->holders(simplex))
      {
        if (rank != exchange.rank())
        {
          expected[rank].push_back(simplex);
        }
      }
    }
    std::map<int, std::vector<Simplex>> found;
    for (std::size_t n = 0; n < shared.neighbours.size(); ++n)
    {
      for (const Index item : shared.items[n])
      {
        found[shared.neighbours[n]].push_back(keys[static_cast<std::size_t>(item)]);
      }
    }
    EXPECT_EQ(found, expected);
    EXPECT_TRUE(std::is_sorted(shared.neighbours.begin(), shared.neighbours.end()));
    EXPECT_EQ(shared.neighbours.size(), expected.size());
    checkHolders(shared, keys);
  }

  void checkHolders(const SharedItems& shared, const std::vector<Simplex>& keys)
  {
    const std::vector<char> owned = shared.ownedHere(static_cast<Index>(keys.size()));
    for (std::size_t i = 0; i < keys.size(); ++i)
    {
      const auto holders = shared.holdersOf(static_cast<Index>(i));
      const std::set<int>& expected = mesh->holders(keys[i]);
      EXPECT_EQ(std::vector<int>(holders.begin(), holders.end()),
        std::vector<int>(expected.begin(), expected.end()));
      EXPECT_EQ(shared.owner(static_cast<Index>(i)), *expected.begin());
      EXPECT_EQ(owned[i] != 0, *expected.begin() == exchange.rank());
    }
  }

  void checkAll()
  {
    const SharedVertices vertices = findVertices();
    check(vertices, vertexKeys, 1);
    check(findSharedEdges(exchange, vertices, piece.ids, piece.edges), edgeKeys, 2);
    check(findSharedCells<3>(exchange, vertices, piece.ids, piece.facets), facetKeys, 3);
  }

  // Combines and copies values that rank and item determine.
  void checkValues(const SharedItems& shared, const std::vector<Simplex>& keys)
  {
    const auto valueOf = [](const Simplex& key, int rank)
    { return static_cast<std::int64_t>(static_cast<std::uint64_t>(key[0]) >> 20) % 1009 + rank; };
    std::vector<std::int64_t> values;
    values.reserve(keys.size());
    for (const Simplex& key : keys)
    {
      values.push_back(valueOf(key, exchange.rank()));
    }
    std::vector<std::int64_t> least = values;
    std::vector<std::int64_t> sum = values;
    std::vector<std::int64_t> fromOwner = values;
    std::vector<int> lastRank(keys.size(), exchange.rank()); // the order in which op is applied
    combineShared(
      exchange, shared, least, [](std::int64_t a, std::int64_t b) { return std::min(a, b); });
    combineShared(exchange, shared, sum, std::plus<std::int64_t>());
    combineShared(exchange, shared, lastRank, [](int, int b) { return b; });
    copyFromOwners(exchange, shared, fromOwner);
    for (std::size_t i = 0; i < keys.size(); ++i)
    {
      const std::set<int>& holders = mesh->holders(keys[i]);
      std::int64_t expectedSum = 0;
      for (const int rank : holders)
      {
        expectedSum += valueOf(keys[i], rank);
      }
      EXPECT_EQ(sum[i], expectedSum);
      EXPECT_EQ(least[i], valueOf(keys[i], *holders.begin()));
      EXPECT_EQ(fromOwner[i], valueOf(keys[i], *holders.begin()));
      EXPECT_EQ(lastRank[i], *holders.rbegin());
    }
  }

  std::unique_ptr<SplitMesh> mesh;
  MeshPiece piece;
  std::vector<Simplex> vertexKeys;
  std::vector<Simplex> edgeKeys;
  std::vector<Simplex> facetKeys;
};

TEST_F(SharedItemsTest, matchTheTruthForRandomPartitions)
{
  for (const int n : { 1, 2, 4 })
  {
    split(n);
    checkAll();
  }
}

TEST_F(SharedItemsTest, matchTheTruthWithEmptyRanks)
{
  split(2, exchange.size() / 2);
  checkAll();
  split(0);
  checkAll();
}

TEST_F(SharedItemsTest, carryValues)
{
  split(3);
  const SharedVertices vertices = findVertices();
  checkValues(vertices, vertexKeys);
  checkValues(findSharedEdges(exchange, vertices, piece.ids, piece.edges), edgeKeys);
  checkValues(findSharedCells<3>(exchange, vertices, piece.ids, piece.facets), facetKeys);
}

TEST_F(SharedItemsTest, countNothingTwice)
{
  split(3);
  const SharedVertices vertices = findVertices();
  const std::vector<char> owned = vertices.ownedHere(static_cast<Index>(piece.ids.size()));
  EXPECT_EQ(exchange.sum(std::count(owned.begin(), owned.end(), 1)), 4 * 4 * 4);
}

// Two ranks hold all vertices of an edge, but only one of them the edge.
TEST_F(SharedItemsTest, needTheSimplexOnBothRanks)
{
  const std::vector<GlobalId> ids = { 10, 20, 30 };
  const SharedVertices vertices = findSharedVertices(exchange, ids, { 0, 1, 2, 1 });
  std::vector<std::array<Index, 2>> edges = { { 1, 0 } };
  if (exchange.rank() == 0)
  {
    edges.push_back({ 1, 2 });
  }
  const SharedEdges shared = findSharedEdges(exchange, vertices, ids, edges);
  EXPECT_EQ(vertices.all.size(), exchange.size() > 1 ? 3u : 0u);
  EXPECT_EQ(shared.neighbours.size(), static_cast<std::size_t>(exchange.size() - 1));
  for (const std::vector<Index>& items : shared.items)
  {
    EXPECT_EQ(items, std::vector<Index>{ 0 });
  }
  EXPECT_EQ(findSharedCells<3>(exchange, vertices, ids, {}).neighbours.size(), 0u);
}

TEST_F(SharedItemsTest, refuseBadInputOnAllRanks)
{
  const bool last = exchange.rank() == exchange.size() - 1;
  const std::vector<GlobalId> ids = { 1, 2, last ? 1 : 3 };
  EXPECT_THROW(findSharedVertices(exchange, ids, { 0, 1, 2 }), Error);
  EXPECT_THROW(findSharedVertices(exchange, ids, { last ? 3 : 0 }), Error);
  if (exchange.size() == 1)
  {
    return;
  }
  const SharedVertices vertices = findSharedVertices(exchange, { 1, 2 }, { 0, 1 });
  std::vector<std::array<Index, 2>> edges = { { 0, 1 } };
  if (last)
  {
    edges.push_back({ 1, 0 });
  }
  EXPECT_THROW(findSharedEdges(exchange, vertices, { 1, 2 }, edges), Error);
}

} // namespace

} // namespace cadrefine
