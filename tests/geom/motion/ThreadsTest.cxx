// What is done on threads is the same as on one: here each range has a thread, the last one first.

#include "TestMeshes.h"

#include <cadrefine/base/VertexBuckets.h>
#include <cadrefine/mesh/Facets.h>
#include <cadrefine/mesh/QualitySummary.h>
#include <cadrefine/mesh/VertexFlags.h>
#include <cadrefine/motion/MoveGuard.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>
#include <vector>

namespace
{

using namespace cadrefine;

void threadsFor(std::size_t count, std::size_t grain, const RangeBody& body)
{
  const std::size_t length = std::max(grain, count / 7 + 1);
  std::vector<std::thread> threads;
  for (std::size_t end = count; end > 0;)
  {
    const std::size_t begin = (end - 1) / length * length;
    threads.emplace_back([&body, begin, end] { body(begin, end); });
    end = begin;
  }
  std::for_each(threads.begin(), threads.end(), [](std::thread& thread) { thread.join(); });
}

/// Of so many cells that they are looked at in several parts.
Mesh largeMesh()
{
  return cadtest::cubeMesh(20, 0.1, 1);
}

std::vector<Index> cellsOf(const std::vector<Facet>& facets)
{
  std::vector<Index> cells;
  for (const Facet& facet : facets)
  {
    cells.push_back(facet.cell);
    cells.insert(cells.end(), facet.begin(), facet.end());
  }
  return cells;
}

TEST(Threads, fillBucketsInTheOrderOfTheThings)
{
  const Mesh mesh = largeMesh();
  const auto visit = [&](std::size_t begin, std::size_t end, const auto& use)
  {
    for (std::size_t c = begin; c < end; ++c)
    {
      use(mesh.tetrahedra[c][c % 4], static_cast<Index>(c));
    }
  };
  std::vector<std::vector<Index>> expected(mesh.points.size());
  visit(
    0, mesh.tetrahedra.size(), [&](Index vertex, Index cell) { expected[vertex].push_back(cell); });
  const VertexBuckets<Index> buckets(mesh.points.size(), mesh.tetrahedra.size(), visit, threadsFor);
  for (Index v = 0; v < static_cast<Index>(mesh.points.size()); ++v)
  {
    const auto [first, last] = buckets.at(v);
    ASSERT_EQ(std::vector<Index>(first, last), expected[v]);
  }
}

TEST(Threads, findTheSameFacets)
{
  const Mesh mesh = largeMesh();
  const auto facets = findOuterFacets(mesh);
  EXPECT_EQ(facets.size(), 12u * 20 * 20);
  EXPECT_EQ(cellsOf(findOuterFacets(mesh, {}, threadsFor)), cellsOf(facets));
  std::vector<unsigned char> among(mesh.points.size(), 0);
  std::fill_n(among.begin(), among.size() / 2, 1);
  EXPECT_EQ(
    cellsOf(findOuterFacets(mesh, among, threadsFor)), cellsOf(findOuterFacets(mesh, among)));
}

TEST(Threads, findTheSameQuality)
{
  Mesh mesh = largeMesh();
  std::swap(mesh.tetrahedra[7][0], mesh.tetrahedra[7][1]);
  const QualitySummary expected = summariseCells(mesh);
  const QualitySummary summary = summariseCells(mesh, threadsFor);
  EXPECT_EQ(summary.invalidCells, 1);
  EXPECT_EQ(summary.smallestRatio, expected.smallestRatio);
  EXPECT_EQ(summary.smallestCube, expected.smallestCube);
}

TEST(Threads, findTheSameCellsAtVertices)
{
  const Mesh mesh = largeMesh();
  std::vector<unsigned char> flags(mesh.points.size(), 0);
  for (std::size_t v = 0; v < flags.size(); v += 50)
  {
    flags[v] = 1;
  }
  EXPECT_EQ(cellsAt(mesh, flags, threadsFor), cellsAt(mesh, flags, serialFor));
}

} // namespace
