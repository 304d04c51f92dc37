// Splits that go on with swaps: what they gain round a short edge, and that a trial leaves nothing.

#include "SpoiltCube.h"
#include "TestShapes.h"

#include <cadrefine/mesh/Quality.h>
#include <cadrefine/operations/Improvement.h>
#include <cadrefine/operations/SplitSwaps.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace
{

using namespace cadrefine;

constexpr double pi = 3.14159265358979323846;
constexpr int corners = 5;

/// An edge from (0, 0, -half) to (0, 0, half), vertices 0 and 1, below half a circle of vertices 2
/// to 6 of radius 1 in the plane z = 0, and (0, 0, 1) and (0, 0, -1), 7 and 8: three cells in each
/// of four sectors. The plane y = 0 is a wall off the CAD, and so is the rest of the boundary.
EditableMesh shortEdge(double half)
{
  EditableMesh mesh;
  const auto add = [&](const Point3& point) { mesh.addVertex({ point, point, {}, false, false }); };
  add({ 0, 0, -half });
  add({ 0, 0, half });
  for (int k = 0; k < corners; ++k)
  {
    const double angle = pi * k / (corners - 1);
    add({ std::cos(angle), k % (corners - 1) == 0 ? 0 : std::sin(angle), 0 });
  }
  add({ 0, 0, 1 });
  add({ 0, 0, -1 });
  for (Index r = 2; r < corners + 1; ++r)
  {
    mesh.addCell({ { r, r + 1, 0, 1 }, 0, 0 });
    mesh.addCell({ { r, r + 1, 1, 7 }, 0, 0 });
    mesh.addCell({ { r + 1, r, 0, 8 }, 0, 0 });
    mesh.addFacet({ { r, r + 1, 7 }, -1, -1 });
    mesh.addFacet({ { r + 1, r, 8 }, -1, -1 });
  }
  for (const auto& facet : { std::array<Index, 3>{ 2, 1, 0 }, { 6, 0, 1 }, { 2, 7, 1 }, { 6, 1, 7 },
         { 2, 0, 8 }, { 6, 8, 0 } })
  {
    mesh.addFacet({ facet, -1, -1 });
  }
  mesh.closeFacets();
  return mesh;
}

/// Of a mesh all of whose cells are valid.
double validVolumeOf(const EditableMesh& mesh)
{
  for (Index c = 0; c < static_cast<Index>(mesh.cells().size()); ++c)
  {
    EXPECT_TRUE(!mesh.cells().exists(c) || mesh.isValid(mesh.cells()[c].corners));
  }
  return cadtest::volumeOf(mesh);
}

double worstOf(const EditableMesh& mesh, const std::vector<LabelledSimplex<4>>& cells)
{
  double worst = std::numeric_limits<double>::infinity();
  for (const auto& cell : cells)
  {
    worst = std::min(worst, mesh.quality(cell.corners));
  }
  return worst;
}

double worstOf(const EditableMesh& mesh)
{
  double worst = std::numeric_limits<double>::infinity();
  for (Index c = 0; c < static_cast<Index>(mesh.cells().size()); ++c)
  {
    worst = mesh.cells().exists(c) ? std::min(worst, mesh.qualityOf(c)) : worst;
  }
  return worst;
}

/// Halving the edge to one end alone makes the flat cell at the other end.
TEST(SplitSwaps, gainRoundAShortEdge)
{
  EditableMesh mesh = shortEdge(0.01);
  const Point3 place = 0.5 * (mesh.vertex(1).point + mesh.vertex(4).point);
  const Index middle = mesh.addVertex({ place, place, {}, false, false });
  Cavity cavity;
  ASSERT_TRUE(proposeSplit(mesh, 1, 4, middle, cavity));
  const double alone = worstOf(mesh, cavity.newCells);
  EXPECT_LT(alone, mesh.worst(cavity.cells));
  swapRoundMiddle(mesh, middle, cavity);
  for (const auto& [cell, label, parent] : cavity.newCells)
  {
    const bool isAtShortEdge = hasCorner(cell, 0) && hasCorner(cell, 1);
    EXPECT_GT(mesh.quality(cell), isAtShortEdge ? 1.1 * alone : 0.5);
  }
  const double before = validVolumeOf(mesh);
  mesh.replace(cavity);
  EXPECT_NEAR(validVolumeOf(mesh), before, 1e-15);
  EXPECT_TRUE(mesh.cells().at(0, 4).empty()) << "the edge to the other end is swapped away";
}

/// The mesh is as it was, with the cells at each vertex in their order.
TEST(SplitSwaps, leaveNothingOfTheTrial)
{
  std::size_t withSwaps = 0;
  for (unsigned seed = 0; seed < 10; ++seed)
  {
    EditableMesh mesh = cadtest::spoiltCube(seed);
    const Index middle = mesh.addVertex({});
    const EditableMesh before = mesh;
    for (Index c = 0; c < static_cast<Index>(before.cells().size()); c += 7)
    {
      const auto& [a, b, third, fourth] = before.cells()[c].corners;
      const Point3 place = 0.5 * (mesh.vertex(a).point + mesh.vertex(b).point);
      mesh.setVertex(middle, { place, place, {}, false, false });
      Cavity cavity;
      if (!proposeSplit(mesh, a, b, middle, cavity) || !mesh.isValid(cavity))
      {
        continue;
      }
      const std::size_t removed = cavity.cells.size();
      swapRoundMiddle(mesh, middle, cavity);
      withSwaps += cavity.cells.size() > removed;
      ASSERT_EQ(mesh.cells().size(), before.cells().size());
      for (Index v = 0; v < middle; ++v)
      {
        EXPECT_EQ(mesh.cells().at(v), before.cells().at(v));
      }
      EXPECT_TRUE(mesh.cells().at(middle).empty());
      EditableMesh after = mesh;
      after.replace(cavity);
      EXPECT_NEAR(validVolumeOf(after), 1, 1e-13);
    }
  }
  EXPECT_GT(withSwaps, 50U);
}

/// Walls get vertices in their planes, and keep theirs.
TEST(SplitSwaps, halveEdgesOfWalls)
{
  EditableMesh mesh = shortEdge(0.004);
  const double before = worstOf(mesh);
  const double volume = validVolumeOf(mesh);
  ASSERT_LT(before, 0.06);
  const auto model = cadtest::modelOf(cadtest::sphere(1));
  const BoundaryProjector projector(*model, BoundaryKind::Faces);
  const SurfaceRule rule(projector);
  const std::size_t vertices = mesh.vertexCount();
  const OperationResult result = improveCells(mesh, &rule, { 0.3, 0.1 });
  EXPECT_GT(worstOf(mesh), 1.2 * before);
  EXPECT_NEAR(validVolumeOf(mesh), volume, 1e-15);
  std::size_t onWall = 0;
  for (std::size_t i = 0; i < result.added.size(); ++i)
  {
    const auto vertex = static_cast<Index>(vertices + i);
    EXPECT_EQ(result.added[i].onBoundary, !mesh.facets().at(vertex).empty());
    EXPECT_FALSE(result.added[i].where.entity);
    onWall += result.added[i].onBoundary && mesh.vertex(vertex).point[1] == 0;
  }
  EXPECT_GT(onWall, 0U);
  for (Index v = 0; v < static_cast<Index>(vertices); ++v)
  {
    EXPECT_FALSE(mesh.facets().at(v).empty()) << v;
  }
}

} // namespace
