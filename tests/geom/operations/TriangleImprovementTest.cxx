// Bad triangles get better, in the plane and on the CAD.

#include "TestMeshes.h"
#include "TestShapes.h"

#include <cadrefine/mesh/Quality.h>
#include <cadrefine/operations/Improvement.h>
#include <cadrefine/operations/Operations.h>
#include <cadrefine/operations/Relocation.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <random>

namespace
{

using namespace cadrefine;
using Kind = EditableMesh::Kind;

constexpr double pi = 3.14159265358979323846;
const Vector3 upward{ 0, 0, 1 };

/// A square with inner vertices at random, so far as cells stay valid; materials 0 and 1 on either
/// side of a row of vertices. Its border stays; with a label, as that of boundary off the CAD,
/// vertices may go along it.
EditableMesh spoiltSquare(unsigned seed, std::optional<Index> borderLabel = {})
{
  const Mesh boxes = cadtest::squareMesh(8, 0.1, seed);
  EditableMesh mesh(Kind::Plane, upward);
  for (const Point3& point : boxes.points)
  {
    mesh.addVertex({ point, point, {}, false, false });
  }
  for (std::size_t c = 0; c < boxes.triangles.size(); ++c)
  {
    mesh.addFacet({ boxes.triangles[c], static_cast<Index>(2 * c / boxes.triangles.size()),
      static_cast<Index>(c) });
  }
  for (const auto& corners : boxes.triangles)
  {
    for (const auto& [i, j] : triangleEdges)
    {
      if (borderLabel && mesh.facets().at(corners[i], corners[j]).size() == 1)
      {
        mesh.addSegment({ { corners[i], corners[j] }, *borderLabel });
      }
    }
  }
  mesh.closeFacets();
  std::mt19937 random(seed);
  const auto part = [&] { return 0.3 * (static_cast<double>(random() % 1000) / 1000 - 0.5); };
  for (std::size_t v = 0; v < boxes.points.size(); ++v)
  {
    const auto vertex = static_cast<Index>(v);
    const Point3 start = mesh.vertex(vertex).point;
    if (mesh.freedomOf(vertex) != EditableMesh::Freedom::Facet)
    {
      continue;
    }
    mesh.moveVertex(vertex, start + Point3{ part(), part(), 0 });
    const auto& cells = mesh.facets().at(vertex);
    if (!std::all_of(cells.begin(), cells.end(),
          [&](Index cell) { return mesh.isValid(mesh.facets()[cell].corners, upward); }))
    {
      mesh.moveVertex(vertex, start);
    }
  }
  return mesh;
}

std::vector<std::array<Index, 3>> cellsOf(const EditableMesh& mesh)
{
  std::vector<std::array<Index, 3>> cells;
  for (std::size_t f = 0; f < mesh.facets().size(); ++f)
  {
    if (mesh.facets().exists(static_cast<Index>(f)))
    {
      cells.push_back(mesh.facets()[static_cast<Index>(f)].corners);
    }
  }
  return cells;
}

struct Summary
{
  double worst = 2;
  double worstCurrent = 2;
  std::array<double, 2> areas{};
  bool isValid = true;
};

Summary summaryOf(const EditableMesh& mesh)
{
  Summary summary;
  for (std::size_t f = 0; f < mesh.facets().size(); ++f)
  {
    const auto facet = static_cast<Index>(f);
    if (mesh.facets().exists(facet))
    {
      const auto& [corners, label, parent] = mesh.facets()[facet];
      summary.isValid = summary.isValid && mesh.isValid(corners, upward);
      summary.worst = std::min(summary.worst, mesh.quality(corners));
      summary.worstCurrent = std::min(summary.worstCurrent, mesh.currentQuality(corners));
      summary.areas[label] +=
        0.5 * twofoldAreaVector(mesh.vertex(corners[0]).point, mesh.vertex(corners[1]).point,
                mesh.vertex(corners[2]).point)[2];
    }
  }
  return summary;
}

/// Edges by how many triangles meet there.
std::map<std::size_t, int> countEdges(const EditableMesh& mesh)
{
  std::map<std::array<Index, 2>, std::size_t> edges;
  for (const auto& cell : cellsOf(mesh))
  {
    for (const auto& [i, j] : triangleEdges)
    {
      ++edges[{ std::min(cell[i], cell[j]), std::max(cell[i], cell[j]) }];
    }
  }
  std::map<std::size_t, int> counts;
  for (const auto& [ends, count] : edges)
  {
    ++counts[count];
  }
  return counts;
}

TEST(TriangleImprovement, makesBadCellsBetter)
{
  for (unsigned seed = 0; seed < 20; ++seed)
  {
    EditableMesh mesh = spoiltSquare(seed);
    const Summary before = summaryOf(mesh);
    ASSERT_TRUE(before.isValid);
    ASSERT_LT(before.worst, 0.2);
    const OperationResult result = improveCells(mesh, nullptr, { 0.4, 0.1 });
    const Summary after = summaryOf(mesh);
    EXPECT_TRUE(after.isValid);
    EXPECT_GT(after.worst, 0.35) << "seed " << seed;
    for (const int material : { 0, 1 })
    {
      EXPECT_NEAR(after.areas[material], before.areas[material], 1e-14);
    }
    EXPECT_GT(result.counts.edgeRemovals, 0);
    EXPECT_GT(result.counts.moves, 0);
    EXPECT_EQ(result.counts.faceRemovals, 0);
    EXPECT_EQ(countEdges(mesh).at(1), 32) << "the border stays";
    EXPECT_EQ(countEdges(mesh).size(), 2u) << "and no edge has more than two triangles";
  }
}

TEST(TriangleImprovement, keepsBoundaryOffTheCAD)
{
  constexpr Index wall = -2;
  for (unsigned seed = 0; seed < 20; ++seed)
  {
    EditableMesh mesh = spoiltSquare(seed, wall);
    const EditableMesh start = mesh;
    const Summary before = summaryOf(mesh);
    const OperationResult result = improveCells(mesh, nullptr, { 0.4, 0.1 });
    const Summary after = summaryOf(mesh);
    EXPECT_GT(result.counts.moves, 0);
    EXPECT_GT(after.worst, before.worst);
    for (const int material : { 0, 1 })
    {
      EXPECT_NEAR(after.areas[material], before.areas[material], 1e-14);
    }
    for (std::size_t v = 0; v < start.vertexCount(); ++v)
    {
      const auto vertex = static_cast<Index>(v);
      if (!start.segments().at(vertex).empty())
      {
        EXPECT_EQ(mesh.vertex(vertex).point, start.vertex(vertex).point) << "seed " << seed;
      }
    }
  }
}

/// Whatever is done, the worst cell never gets worse: neither where vertices are wanted nor, below
/// the minimum, where they are.
TEST(TriangleImprovement, neverMakesTheWorstCellWorse)
{
  int improved = 0;
  for (unsigned seed = 0; seed < 40; ++seed)
  {
    EditableMesh mesh = spoiltSquare(seed);
    std::mt19937 random(seed);
    const auto part = [&] { return 0.2 * (static_cast<double>(random() % 1000) / 1000 - 0.5); };
    for (std::size_t v = 0; v < mesh.vertexCount(); v += 3)
    {
      EditableMesh::Vertex vertex = mesh.vertex(static_cast<Index>(v));
      vertex.wanted = vertex.point + Point3{ part(), part(), 0 };
      vertex.stays = true;
      mesh.setVertex(static_cast<Index>(v), vertex);
    }
    const Summary before = summaryOf(mesh);
    improveCells(mesh, nullptr, { 0.4, 0.1 });
    const Summary after = summaryOf(mesh);
    EXPECT_TRUE(after.isValid) << "seed " << seed;
    EXPECT_GE(after.worst, before.worst);
    EXPECT_GE(after.worstCurrent, std::min(before.worstCurrent, 0.1));
    improved += after.worst > before.worst;
  }
  EXPECT_GT(improved, 20);
}

TEST(TriangleImprovement, dependsOnTheOrderAlone)
{
  EditableMesh one = spoiltSquare(3);
  EditableMesh other = spoiltSquare(3);
  improveCells(one, nullptr, { 0.4, 0.1 });
  improveCells(other, nullptr, { 0.4, 0.1 });
  EXPECT_EQ(cellsOf(one), cellsOf(other));
}

TEST(TriangleImprovement, leavesGoodCellsAlone)
{
  EditableMesh mesh = spoiltSquare(4);
  const auto cells = cellsOf(mesh);
  const OperationResult result = improveCells(mesh, nullptr, { summaryOf(mesh).worst, 0.1 });
  EXPECT_EQ(cellsOf(mesh), cells);
  EXPECT_EQ(result.counts.cells, 0);
}

/// Children of triangles of the same shape, with the parents that they lie in.
TEST(TriangleImprovement, givesCellsTheParentsThatTheyLieIn)
{
  EditableMesh mesh(Kind::Plane, upward);
  // A square of side 4 with a vertex near its lower border.
  for (const Point3& point :
    std::vector<Point3>{ { 0, 0, 0 }, { 4, 0, 0 }, { 4, 4, 0 }, { 0, 4, 0 }, { 2, 0.05, 0 } })
  {
    mesh.addVertex({ point, point, {}, false, false });
  }
  const Cells<3> cells{ { 0, 1, 4 }, { 1, 2, 4 }, { 2, 3, 4 }, { 3, 0, 4 } };
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    mesh.addFacet({ cells[c], 0, static_cast<Index>(c) });
  }
  mesh.closeFacets();
  improveCells(mesh, nullptr, { 0.5, 0.1 });
  EXPECT_GT(summaryOf(mesh).worst, 0.5);
  for (std::size_t f = 0; f < mesh.facets().size(); ++f)
  {
    if (mesh.facets().exists(static_cast<Index>(f)))
    {
      EXPECT_GE(mesh.facets()[static_cast<Index>(f)].parent, 0);
      EXPECT_LT(mesh.facets()[static_cast<Index>(f)].parent, 4);
    }
  }
}

/// The unit sphere between two parallels as triangles, some of whose vertices have slid along it.
class SphereImprovement : public testing::Test
{
protected:
  EditableMesh spoilt(unsigned seed) const
  {
    const auto isAway = [](const Point3& p)
    { return std::abs(p[2]) < 0.9 && (p[0] < 0 || std::abs(p[1]) > 0.2); }; // of poles and seam
    EditableMesh mesh(Kind::Surface);
    constexpr int around = 24;
    constexpr int rows = 12;
    std::mt19937 random(seed);
    const auto part = [&] { return 0.12 * (static_cast<double>(random() % 1000) / 1000 - 0.5); };
    for (int row = 1; row < rows; ++row)
    {
      for (int k = 0; k < around; ++k)
      {
        const double polar = pi * row / rows;
        const double angle = 2 * pi * (k + 0.5 * (row % 2)) / around;
        Point3 point{ std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle),
          std::cos(polar) };
        const bool stays = row == 1 || row == rows - 1 || !isAway(point);
        if (!stays)
        {
          point = normalized(point + Point3{ part(), part(), part() });
        }
        const ClosestPoint where = projector.nearestOn({ 2, 0 }, point);
        mesh.addVertex({ where.point, where.point, where.entity, stays, false });
      }
    }
    const auto at = [](int row, int k) { return static_cast<Index>(row * around + k % around); };
    for (int row = 0; row + 2 < rows; ++row)
    {
      for (int k = 0; k < around; ++k)
      {
        const int shift = row % 2 == 0 ? 1 : 0; // rows begin half a step apart
        const auto cell = static_cast<Index>(2 * (row * around + k));
        mesh.addFacet({ { at(row, k), at(row + 1, k + shift), at(row, k + 1) }, 0, cell });
        mesh.addFacet({ { at(row, k), at(row + 1, k + shift + around - 1), at(row + 1, k + shift) },
          0, cell + 1 });
      }
    }
    mesh.closeFacets();
    return mesh;
  }

  static double worstOf(const EditableMesh& mesh)
  {
    double worst = 2;
    for (const auto& cell : cellsOf(mesh))
    {
      worst = std::min(worst, mesh.quality(cell));
    }
    return worst;
  }

  /// The smallest cosine between a triangle's normal and that of the sphere at its centroid.
  static double leastCosine(const EditableMesh& mesh)
  {
    double least = 1;
    for (const auto& [a, b, c] : cellsOf(mesh))
    {
      const Point3& p = mesh.vertex(a).point;
      const Point3& q = mesh.vertex(b).point;
      const Point3& r = mesh.vertex(c).point;
      least = std::min(least, dot(normalized(twofoldAreaVector(p, q, r)), normalized(p + q + r)));
    }
    return least;
  }

  std::shared_ptr<const CADModel> model = cadtest::modelOf(cadtest::sphere(1));
  BoundaryProjector projector{ *model, BoundaryKind::Faces };
  SurfaceRule rule{ projector };
};

TEST_F(SphereImprovement, makesBadCellsBetterAndStaysOnTheSphere)
{
  int improved = 0;
  for (unsigned seed = 0; seed < 5; ++seed)
  {
    EditableMesh mesh = spoilt(seed);
    const double before = worstOf(mesh);
    ASSERT_LT(before, 0.35);
    const double cosine = leastCosine(mesh);
    const auto edges = countEdges(mesh);
    ASSERT_GT(cosine, 0.5) << "outward";
    const OperationResult result = improveCells(mesh, &rule, { 0.5, 0.1 });
    EXPECT_GE(worstOf(mesh), before);
    improved += worstOf(mesh) > std::max(0.3, before);
    EXPECT_GE(leastCosine(mesh), std::min(cosine, std::cos(40 * pi / 180)));
    EXPECT_EQ(countEdges(mesh).at(1), edges.at(1)) << "the borders stay";
    EXPECT_EQ(countEdges(mesh).size(), 2u);
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v)
    {
      const auto vertex = static_cast<Index>(v);
      if (!mesh.facets().at(vertex).empty())
      {
        EXPECT_NEAR(norm(mesh.vertex(vertex).point), 1, 1e-12);
      }
    }
    EXPECT_GT(result.counts.operations(), 0);
  }
  EXPECT_EQ(improved, 5);
}

TEST_F(SphereImprovement, leavesASurfaceAloneWithoutTheCAD)
{
  EditableMesh mesh = spoilt(1);
  const auto cells = cellsOf(mesh);
  EXPECT_EQ(improveCells(mesh, nullptr, { 0.5, 0.1 }).counts.operations(), 0);
  EXPECT_EQ(cellsOf(mesh), cells);
}

/// A star of six about a point of the sphere: the best place is that point.
TEST_F(SphereImprovement, movesAVertexAlongTheSphere)
{
  EditableMesh mesh(Kind::Surface);
  const Point3 aside = normalized(Point3{ -1, 0.08, 0.05 });
  const ClosestPoint start = projector.nearestOn({ 2, 0 }, aside);
  mesh.addVertex({ start.point, start.point, start.entity, false, false });
  Cells<3> cells;
  for (Index k = 0; k < 6; ++k)
  {
    const double angle = -pi * k / 3; // seen from outside, to the left
    const Point3 point = normalized(Point3{ -1, 0.2 * std::cos(angle), 0.2 * std::sin(angle) });
    mesh.addVertex({ point, point, { 2, 0 }, true, false });
    cells.push_back({ 0, 1 + k, 1 + (k + 1) % 6 });
  }
  for (Index k = 0; k < 6; ++k)
  {
    mesh.addFacet({ cells[k], 0, k });
  }
  const double before = mesh.worst({ 0, 1, 2, 3, 4, 5 });
  relocateOnCAD(mesh, 0, cells, projector);
  const double after = mesh.worst({ 0, 1, 2, 3, 4, 5 });
  EXPECT_GT(after, before);
  EXPECT_GT(after, 0.99);
  EXPECT_NEAR(norm(mesh.vertex(0).point), 1, 1e-12);
  EXPECT_NEAR(distance(mesh.vertex(0).point, { -1, 0, 0 }), 0, 0.01);
}

/// A disc with vertices on the circle: a vertex of the circle is never worth a chord.
TEST(PlanarRule, keepsToTheCircle)
{
  const auto model = cadtest::modelOf(cadtest::circle(1));
  const BoundaryProjector projector(*model, BoundaryKind::Edges);
  const SurfaceRule rule(projector);
  constexpr Index corners = 12;
  EditableMesh mesh(Kind::Plane, upward);
  mesh.addVertex({ {}, {}, {}, false, false });
  for (Index k = 0; k < corners; ++k)
  {
    const double angle = 2 * pi * (k + 0.5) / corners;
    const Point3 point{ std::cos(angle), std::sin(angle), 0 };
    mesh.addVertex({ point, point, { 1, 0 }, false, false });
  }
  for (Index k = 0; k < corners; ++k)
  {
    const std::array<Index, 2> ends{ 1 + k, 1 + (k + 1) % corners };
    mesh.addFacet({ { 0, ends[0], ends[1] }, 0, k });
    mesh.addSegment({ ends, 0, -1, { EdgeClass::Smooth, -1 } });
  }
  mesh.closeFacets();
  Cavity cavity;
  ASSERT_TRUE(proposeCollapse(mesh, 1, 2, cavity));
  EXPECT_TRUE(mesh.isValid(cavity));
  EXPECT_TRUE(mesh.touchesBoundary(cavity));
  EXPECT_FALSE(rule.accepts(mesh, cavity));

  const ClosestPoint where = rule.placeOfMiddle(mesh, 1, 2).value();
  EXPECT_NEAR(
    distance(where.point, normalized(0.5 * (mesh.vertex(1).point + mesh.vertex(2).point))), 0,
    1e-9);
  const Index middle = mesh.addVertex({ where.point, where.point, where.entity, false, false });
  ASSERT_TRUE(proposeSplit(mesh, 1, 2, middle, cavity));
  EXPECT_TRUE(rule.accepts(mesh, cavity));

  ASSERT_TRUE(proposeCollapse(mesh, 0, 4, cavity));
  EXPECT_FALSE(mesh.touchesBoundary(cavity));
}

TEST(PlanarRule, letsVerticesGoAlongStraightEdges)
{
  const auto model = cadtest::modelOf(cadtest::rectangle(3, 1));
  const BoundaryProjector projector(*model, BoundaryKind::Edges);
  const SurfaceRule rule(projector);
  EditableMesh mesh(Kind::Plane, upward);
  // The lower side in three parts, of which the first is short.
  for (const Point3& point : std::vector<Point3>{
         { 0, 0, 0 }, { 0.05, 0, 0 }, { 1, 0, 0 }, { 3, 0, 0 }, { 3, 1, 0 }, { 0, 1, 0 } })
  {
    const ClosestPoint where = projector.onSmallest(point, 1e-9, projector.nearest(point, 1));
    mesh.addVertex({ point, point, where.entity, where.entity.dimension == 0, false });
  }
  const Cells<3> cells{ { 0, 1, 5 }, { 1, 2, 5 }, { 2, 3, 4 }, { 2, 4, 5 } };
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    mesh.addFacet({ cells[c], 0, static_cast<Index>(c) });
  }
  for (Index k = 0; k < 3; ++k)
  {
    mesh.addSegment({ { k, k + 1 }, 0, -1, { EdgeClass::Smooth, -1 } });
  }
  mesh.closeFacets();
  const double before = mesh.worst({ 0, 1, 2, 3 });
  const OperationResult result = improveCells(mesh, &rule, { 0.3, 0.1 });
  const Summary after = summaryOf(mesh);
  EXPECT_LT(before, 0.1);
  EXPECT_GT(after.worst, 0.3);
  EXPECT_NEAR(after.areas[0], 3, 1e-14);
  EXPECT_TRUE(after.isValid);
  EXPECT_GT(result.counts.collapses + result.counts.moves, 0);
}

} // namespace
