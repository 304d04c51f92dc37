// The quadrilaterals of a mesh against those that its cells have.

#include "MixedMeshes.h"

#include <cadrefine/mesh/Facets.h>
#include <cadrefine/mesh/QuadTable.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace
{

using namespace cadrefine;

using Corners = std::set<Index>;

class Quads : public testing::TestWithParam<int>
{
protected:
  const Mesh mesh = cadtest::withListedBoundary(cadtest::randomlyMixedMesh(
    GetParam() == 3 ? cadtest::hexahedraMesh(3, 0.1, 1) : cadtest::quadrilateralsMesh(5, 0.1, 1),
    2));
  const EdgeTable edges = buildEdgeTable(mesh);
  const QuadTable quads = buildQuadTable(edges);

  Corners cornersOf(const std::array<Index, 4>& edgesOfQuad) const
  {
    Corners corners;
    for (const Index edge : edgesOfQuad)
    {
      corners.insert(edges.edges[edge].begin(), edges.edges[edge].end());
    }
    return corners;
  }
};

INSTANTIATE_TEST_SUITE_P(Dimensions, Quads, testing::Values(2, 3));

TEST_P(Quads, areEachListedOnce)
{
  std::set<Corners> expected;
  forEachSide(mesh,
    [&](const Facet& side)
    {
      if (side.corners() == 4)
      {
        expected.emplace(side.begin(), side.end());
      }
    });
  for (const auto& cell : mesh.quadrilaterals)
  {
    expected.emplace(cell.begin(), cell.end());
  }
  std::set<Corners> found;
  std::set<std::pair<Index, Index>> opposite;
  for (const auto& quad : quads.edges)
  {
    EXPECT_EQ(cornersOf(quad).size(), 4u);
    found.insert(cornersOf(quad));
    EXPECT_EQ(quad[0], *std::min_element(quad.begin(), quad.end()));
    EXPECT_LT(quad[1], quad[3]);
    EXPECT_TRUE(opposite.empty() || *opposite.rbegin() < std::pair(quad[0], quad[2]));
    opposite.emplace(quad[0], quad[2]);
  }
  EXPECT_GE(expected.size(), 10u);
  EXPECT_EQ(found, expected);
  EXPECT_EQ(quads.edges.size(), expected.size());
}

template<class Cells, class Numbers, std::size_t Count>
void expectOfCells(const Cells& cells, const Numbers& numbers, const int (&quadEdges)[Count][4],
  const int (*ends)[2], const QuadTable& quads, const EdgeTable& edges)
{
  ASSERT_EQ(numbers.size(), cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    for (std::size_t q = 0; q < Count; ++q)
    {
      Corners expected;
      for (const int edge : quadEdges[q])
      {
        expected.insert({ cells[c][ends[edge][0]], cells[c][ends[edge][1]] });
      }
      Corners found;
      for (const Index edge : quads.edges.at(numbers[c][q]))
      {
        found.insert(edges.edges[edge].begin(), edges.edges[edge].end());
      }
      EXPECT_EQ(found, expected);
      EXPECT_EQ(found.size(), 4u);
    }
  }
}

TEST_P(Quads, areThoseOfTheCells)
{
  using namespace shapes;
  expectOfCells(mesh.pyramids, quads.ofPyramids, Pyramid::quadEdges, Pyramid::edges, quads, edges);
  expectOfCells(mesh.wedges, quads.ofWedges, Wedge::quadEdges, Wedge::edges, quads, edges);
  expectOfCells(
    mesh.hexahedra, quads.ofHexahedra, Hexahedron::quadEdges, Hexahedron::edges, quads, edges);
  expectOfCells(mesh.quadrilaterals, quads.ofQuadrilaterals, Quadrilateral::quadEdges,
    Quadrilateral::edges, quads, edges);
  EXPECT_EQ(mesh.pyramids.empty(), GetParam() == 2);
}

TEST_P(Quads, areFoundFromAnyEdgeOnAndEitherWayRound)
{
  for (std::size_t q = 0; q < quads.edges.size(); ++q)
  {
    auto turned = quads.edges[q];
    for (int k = 0; k < 8; ++k)
    {
      EXPECT_EQ(quads.find(turned), static_cast<Index>(q));
      std::rotate(turned.begin(), turned.begin() + 1, turned.end());
      if (k == 3)
      {
        std::reverse(turned.begin(), turned.end());
      }
    }
    std::swap(turned[0], turned[1]); // not in turn
    EXPECT_EQ(quads.find(turned), -1);
  }
  EXPECT_EQ(QuadTable{}.find({ 0, 1, 2, 3 }), -1);
}

/// The quadrilateral edges of the faces that have four corners, in their order.
template<class Shape>
void expectQuadEdgesOfFaces(Shape)
{
  std::size_t q = 0;
  for (const auto& face : Shape::faces)
  {
    if (face[3] < 0)
    {
      continue;
    }
    Corners corners;
    for (const int edge : Shape::quadEdges[q++])
    {
      corners.insert({ Shape::edges[edge][0], Shape::edges[edge][1] });
    }
    EXPECT_EQ(corners, Corners(std::begin(face), std::end(face)));
  }
  EXPECT_EQ(q, std::size(Shape::quadEdges));
}

TEST(QuadEdges, areThoseOfTheFaces)
{
  expectQuadEdgesOfFaces(shapes::Pyramid{});
  expectQuadEdgesOfFaces(shapes::Wedge{});
  expectQuadEdgesOfFaces(shapes::Hexahedron{});
}

} // namespace
