#include "TestMeshes.h"

#include <cadrefine/mesh/EdgeTable.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace
{

using namespace cadrefine;

using IdPairs = std::set<std::array<GlobalId, 2>>;

IdPairs idPairs(const Mesh& mesh, const EdgeTable& table)
{
  IdPairs pairs;
  for (const auto& [a, b] : table.edges)
  {
    pairs.insert({ mesh.ids[a], mesh.ids[b] });
  }
  return pairs;
}

TEST(EdgeTable, countsTheEdgesOfACube)
{
  for (const int n : { 1, 2, 3 })
  {
    const EdgeTable table = buildEdgeTable(cadtest::cubeMesh(n, 0.1, 1));
    const std::size_t along = 3u * n * (n + 1) * (n + 1);
    const std::size_t acrossFaces = 3u * n * n * (n + 1);
    const std::size_t acrossBoxes = 1u * n * n * n;
    EXPECT_EQ(table.edges.size(), along + acrossFaces + acrossBoxes);
  }
  EXPECT_EQ(buildEdgeTable(cadtest::squareMesh(3, 0, 1)).edges.size(), 24u + 9u);
}

TEST(EdgeTable, holdsEachEdgeOnceWithTheSmallerIdFirst)
{
  const Mesh mesh = cadtest::cubeMesh(3, 0.1, 2);
  const EdgeTable table = buildEdgeTable(mesh);
  EXPECT_EQ(idPairs(mesh, table).size(), table.edges.size());
  for (const auto& [a, b] : table.edges)
  {
    EXPECT_LT(mesh.ids[a], mesh.ids[b]);
  }
}

TEST(EdgeTable, namesTheEdgesOfEachCellInTheOrderOfTheTemplates)
{
  const Mesh mesh = cadtest::cubeMesh(2, 0.1, 3);
  const EdgeTable table = buildEdgeTable(mesh);
  ASSERT_EQ(table.ofTetrahedra.size(), mesh.tetrahedra.size());
  for (std::size_t c = 0; c < mesh.tetrahedra.size(); ++c)
  {
    for (int k = 0; k < 6; ++k)
    {
      const Index a = mesh.tetrahedra[c][tetrahedronEdges[k][0]];
      const Index b = mesh.tetrahedra[c][tetrahedronEdges[k][1]];
      EXPECT_EQ(table.ofTetrahedra[c][k], table.find(a, b));
      EXPECT_EQ(table.find(b, a), table.find(a, b));
    }
  }
}

TEST(EdgeTable, holdsEdgesOfCellsOfAllDimensions)
{
  Mesh mesh = cadtest::oneTetrahedron({ { {}, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } });
  mesh.points.push_back({ 2, 0, 0 });
  mesh.ids.push_back(17);
  mesh.triangles = { { 0, 2, 1 } };
  mesh.segments = { { 4, 1 } };
  const EdgeTable table = buildEdgeTable(mesh);
  EXPECT_EQ(table.edges.size(), 7u);
  EXPECT_EQ(table.ofTriangles.at(0)[1], table.find(1, 2));
  EXPECT_EQ(table.ofSegments.at(0)[0], table.find(1, 4));
  EXPECT_EQ(table.find(0, 4), -1);
}

TEST(EdgeTable, measuresLengths)
{
  const Mesh mesh = cadtest::oneTriangle({ { { 0, 0, 0 }, { 3, 0, 0 }, { 0, 4, 0 } } });
  const EdgeTable table = buildEdgeTable(mesh);
  EXPECT_EQ(table.squaredLengths.at(table.find(0, 1)), 9);
  EXPECT_EQ(table.squaredLengths.at(table.find(1, 2)), 25);
  EXPECT_EQ(table.squaredLengths.at(table.find(0, 2)), 16);
}

TEST(EdgeTable, hasTheSameEdgesWhateverTheOrderOfTheCells)
{
  const Mesh mesh = cadtest::cubeMesh(3, 0.1, 4);
  const Mesh shuffled = cadtest::withShuffledCells(mesh, 5);
  EXPECT_NE(mesh.tetrahedra, shuffled.tetrahedra);
  EXPECT_EQ(idPairs(mesh, buildEdgeTable(mesh)), idPairs(shuffled, buildEdgeTable(shuffled)));
}

/// A grid without jitter has many edges of equal length: ids must order them.
TEST(EdgeOrder, isATotalOrder)
{
  const Mesh mesh = cadtest::cubeMesh(2, 0, 6);
  const EdgeTable table = buildEdgeTable(mesh);
  const EdgeOrder order(table);
  std::vector<Index> edges(table.edges.size());
  for (std::size_t e = 0; e < edges.size(); ++e)
  {
    edges[e] = static_cast<Index>(e);
  }
  std::sort(edges.begin(), edges.end(), [&](Index a, Index b) { return order.longer(a, b); });
  for (std::size_t i = 0; i < edges.size(); ++i)
  {
    for (std::size_t j = 0; j < edges.size(); ++j)
    {
      EXPECT_EQ(order.longer(edges[i], edges[j]), i < j);
    }
  }
}

TEST(EdgeOrder, prefersLengthThenTheLargerIds)
{
  // A square with its diagonal: four edges of length 1.
  const Mesh mesh = cadtest::squareMesh(1, 0, 7);
  const EdgeTable table = buildEdgeTable(mesh);
  const EdgeOrder order(table);
  for (Index a = 0; a < 5; ++a)
  {
    for (Index b = 0; b < 5; ++b)
    {
      const auto key = [&](Index e)
      {
        return std::make_tuple(
          table.squaredLengths[e], mesh.ids[table.edges[e][0]], mesh.ids[table.edges[e][1]]);
      };
      EXPECT_EQ(order.longer(a, b), key(a) > key(b));
    }
  }
}

} // namespace
