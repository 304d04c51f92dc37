// Edges and facets numbered at their vertices, compared with a sort of all their ids.
#include "ParallelTest.h"

#include "SplitMesh.h"
#include "comm/VertexNumbering.h"

#include <algorithm>

namespace cadrefine
{

namespace
{

class VertexNumberingTest : public ParallelTest
{
protected:
  // The simplices in the shape of the keys, their vertex with the smallest id first.
  template<std::size_t K, std::size_t N>
  static std::vector<VertexKey<K>> keysOf(
    const MeshPiece& piece, const std::vector<std::array<Index, N>>& simplices)
  {
    const auto idOf = [&](Index vertex) { return piece.ids[static_cast<std::size_t>(vertex)]; };
    std::vector<VertexKey<K>> keys;
    for (auto simplex : simplices)
    {
      std::sort(
        simplex.begin(), simplex.end(), [&](Index a, Index b) { return idOf(a) < idOf(b); });
      VertexKey<K>& key = keys.emplace_back();
      key.vertex = simplex[0];
      key.rest.fill(-1);
      std::transform(simplex.begin() + 1, simplex.end(), key.rest.begin(), idOf);
    }
    return keys;
  }

  template<std::size_t K, std::size_t N>
  void expectSameAsSort(const MeshPiece& piece, const std::vector<std::array<Index, N>>& simplices)
  {
    const auto keys = keysOf<K>(piece, simplices);
    std::vector<Key<K + 1>> flat;
    for (const VertexKey<K>& key : keys)
    {
      flat.emplace_back()[0] = piece.ids[static_cast<std::size_t>(key.vertex)];
      std::copy(key.rest.begin(), key.rest.end(), flat.back().begin() + 1);
    }
    std::vector<Index> all(piece.ids.size());
    for (std::size_t v = 0; v < all.size(); ++v)
    {
      all[v] = static_cast<Index>(v);
    }
    const SharedVertices vertices = findSharedVertices(exchange, piece.ids, all);
    const Numbering expected = numberDistinct(exchange, flat);
    const Numbering numbering = numberAtVertices(exchange, vertices, piece.ids, keys);
    EXPECT_EQ(numbering.numbers, expected.numbers);
    EXPECT_EQ(numbering.count, expected.count);
  }
};

TEST_F(VertexNumberingTest, numberEdgesAndFacetsAsASortDoes)
{
  for (const int firstRank : { 0, exchange.size() / 2 })
  {
    const SplitMesh mesh(4, firstRank, exchange.size(), 17);
    const MeshPiece piece = mesh.piece(exchange.rank(), 5);
    expectSameAsSort<1>(piece, piece.edges);
    expectSameAsSort<3>(piece, piece.facets);
  }
}

TEST_F(VertexNumberingTest, giveTheSameNumberToTheSameKeys)
{
  const SplitMesh mesh(3, 0, exchange.size(), 3);
  const MeshPiece piece = mesh.piece(exchange.rank(), 4);
  auto edges = piece.edges;
  edges.insert(edges.end(), piece.edges.begin(), piece.edges.end());
  expectSameAsSort<1>(piece, edges);
}

TEST_F(VertexNumberingTest, sendWhatLiesOnTheInterface)
{
  const SplitMesh mesh(5, 0, exchange.size(), 8);
  const MeshPiece piece = mesh.piece(0, 1);
  // One rank holds all there is: nothing is shared, and only vertices are sorted.
  const MeshPiece mine = exchange.rank() == 0 ? piece : MeshPiece{};
  const std::int64_t before = exchange.bytesSent();
  numberAtVertices(exchange, SharedVertices{}, mine.ids, keysOf<3>(mine, mine.facets));
  EXPECT_LE(exchange.bytesSent() - before, static_cast<std::int64_t>(24 * piece.ids.size() + 2000));
}

} // namespace

} // namespace cadrefine
