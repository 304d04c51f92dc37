// Making way for a boundary vertex: the three cases of S. Strunk, KTH 2013, section 4.3, in the
// plane and in space; and sliding on the CAD.

#include <cadrefine/motion/PatchOptimiser.h>

#include "HexahedralMeshes.h"
#include "TestMeshes.h"
#include "TestShapes.h"

#include <cadrefine/mesh/Orientation.h>
#include <cadrefine/mesh/Quality.h>
#include <cadrefine/motion/MoveGuard.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace
{

using namespace cadrefine;

template<class Shape, std::size_t Corners>
double lowest(Shape shape, const Cells<Corners>& cells, const std::vector<Point3>& points)
{
  double result = std::numeric_limits<double>::infinity();
  for (const auto& cell : cells)
  {
    const CellState state = stateAt(shape, cornersOf(cell, points), { 0, 0, 1 });
    result = std::min(result, state.valid ? state.quality : std::min(state.quality, 0.0));
  }
  return result;
}

/// Lowest mean ratio; at most 0 where a cell is not valid.
double lowestQuality(const Mesh& mesh, const std::vector<Point3>& points)
{
  return mesh.dimension == 3 ? lowest(shapes::Tetrahedron{}, mesh.tetrahedra, points)
                             : lowest(shapes::Triangle{}, mesh.triangles, points);
}

double lowestQuality(const Mesh& mesh)
{
  return lowestQuality(mesh, mesh.points);
}

bool isInside(const Mesh& mesh, const Point3& point)
{
  return std::all_of(
    point.begin(), point.begin() + mesh.dimension, [](double x) { return x > 0 && x < 1; });
}

/// All of a mesh of the unit square or cube; its inner vertices may move.
Patch patchOf(const Mesh& mesh)
{
  Patch patch;
  patch.mesh = mesh;
  patch.start = mesh.points;
  patch.complete.assign(mesh.points.size(), 1);
  patch.entities.resize(mesh.points.size());
  for (const Point3& point : mesh.points)
  {
    patch.free.push_back(isInside(mesh, point));
  }
  patch.plane = mesh.dimension == 2 ? Vector3{ 0, 0, 1 } : Vector3{};
  return patch;
}

void optimise(Patch& patch, int sweeps, const BoundaryProjector* projector = nullptr)
{
  PatchOptimiser optimiser(patch, projector);
  for (int sweep = 0; sweep < sweeps; ++sweep)
  {
    optimiser.beginSweep(optimiser.smallestMeasure());
    EXPECT_FALSE(optimiser.advance()) << "all cells are here: no vertex waits";
  }
}

/// A vertex in the middle of one side of the unit square or cube, 4 boxes wide, is to move into it.
class MakingWay : public testing::TestWithParam<int>
{
protected:
  Mesh mesh = GetParam() == 3 ? cadtest::cubeMesh(4, 0, 1) : cadtest::squareMesh(4, 0, 1);

  Point3 inDepth(double depth) const
  {
    return GetParam() == 3 ? Point3{ 0.5, 0.5, depth } : Point3{ 0.5, depth, 0 };
  }

  Index vertexAt(const Point3& point) const
  {
    return static_cast<Index>(
      std::find(mesh.points.begin(), mesh.points.end(), point) - mesh.points.begin());
  }

  /// Straight, the vertex stops on the way, with all cells valid; after the vertices inside have
  /// been optimised for its target, the whole way is free.
  void expectThatWayIsMadeTo(double depth)
  {
    const Index vertex = vertexAt(inDepth(0));
    ASSERT_LT(vertex, static_cast<Index>(mesh.points.size()));
    ASSERT_GT(lowestQuality(mesh), 0);
    Moves straight(mesh.points);
    straight.add(vertex, inDepth(depth));
    while (MoveGuard(mesh, straight, mesh.points, {}).halveUnaccepted(straight))
    {
    }
    EXPECT_LT(straight.fractions[vertex], 1);
    Mesh stopped = mesh;
    stopped.points[vertex] = straight.position(mesh.points, vertex);
    EXPECT_GT(lowestQuality(stopped), 0);

    Patch patch = patchOf(stopped);
    patch.free[vertex] = 0;
    patch.mesh.points[vertex] = inDepth(depth);
    EXPECT_LE(lowestQuality(patch.mesh), 0) << "the move is one of the three cases";
    optimise(patch, 10);
    EXPECT_GE(lowestQuality(patch.mesh), MoveGuard::qualityFloor);

    Moves together(stopped.points);
    for (Index v = 0; v < static_cast<Index>(mesh.points.size()); ++v)
    {
      together.add(v, patch.mesh.points[v]);
    }
    EXPECT_FALSE(MoveGuard(stopped, together, mesh.points, patch.plane).halveUnaccepted(together));
    EXPECT_EQ(together.position(stopped.points, vertex), inDepth(depth));
  }
};

INSTANTIATE_TEST_SUITE_P(Dimensions, MakingWay, testing::Values(2, 3));

/// Onto the opposite side of its cells exactly.
TEST_P(MakingWay, whereCellsWouldCollapse)
{
  expectThatWayIsMadeTo(0.25);
}

TEST_P(MakingWay, whereCellsWouldInvert)
{
  expectThatWayIsMadeTo(0.4);
}

/// Inner vertices near the side make flat cells already before anything moves.
TEST_P(MakingWay, whereCellsArePoorFromTheStart)
{
  for (Point3& point : mesh.points)
  {
    double& depth = point[GetParam() - 1];
    depth = depth == 0.25 ? 0.01 : depth;
  }
  ASSERT_LT(lowestQuality(mesh), 0.2);
  expectThatWayIsMadeTo(0.1);
}

/// A mesh that is tangled from the start is mended.
TEST_P(MakingWay, untanglesInvertedCells)
{
  const Index vertex = vertexAt(inDepth(0.25));
  mesh.points[vertex] = inDepth(-0.1);
  ASSERT_LT(lowestQuality(mesh), 0);
  Patch patch = patchOf(mesh);
  patch.free[vertex] = 1;
  optimise(patch, 10);
  EXPECT_GT(lowestQuality(patch.mesh), 0.3);
}

/// Boxes ten times as long as thick, into one of which the side bulges by half of its thickness:
/// those over it make way, each a bit less.
TEST(MakingWayOfHexahedra, keepsTheirShape)
{
  constexpr int boxes = 4;
  Mesh mesh = cadtest::hexahedraMesh(boxes, 0, 1);
  for (const auto& cell : mesh.hexahedra)
  {
    for (const auto& [a, b, c, d] : shapes::Hexahedron::cornerSimplices)
    {
      mesh.tetrahedra.push_back({ cell[a], cell[b], cell[c], cell[d] });
    }
  }
  mesh.hexahedra.clear();
  Patch patch = patchOf(mesh); // whose vertices inside the unit cube are free
  for (Point3& point : patch.start)
  {
    point[2] *= 0.1;
  }
  patch.mesh.points = patch.start;
  const double thickness = 0.1 / boxes;
  const auto vertexOver = [&](int box)
  {
    const Point3 place{ 0.5, 0.5, 1.0 * box / boxes };
    return std::find(mesh.points.begin(), mesh.points.end(), place) - mesh.points.begin();
  };
  patch.mesh.points[vertexOver(0)][2] = 0.5 * thickness;
  patch.keepsShape.assign(patch.mesh.tetrahedra.size(), 1);
  optimise(patch, 20);
  double last = 0.5 * thickness;
  for (int box = 1; box < boxes; ++box)
  {
    const double moved = patch.mesh.points[vertexOver(box)][2] - patch.start[vertexOver(box)][2];
    EXPECT_GT(moved, 0.4 * last) << box;
    EXPECT_LT(moved, last) << box;
    last = moved;
  }
  // Without anything to make way for, nothing moves.
  patch.mesh.points = patch.start;
  optimise(patch, 1);
  for (std::size_t v = 0; v < patch.start.size(); ++v)
  {
    EXPECT_EQ(patch.mesh.points[v], patch.start[v]);
  }
}

TEST_P(MakingWay, doesNotDependOnTheOrderOfCells)
{
  const Index vertex = vertexAt(inDepth(0));
  Patch first = patchOf(mesh);
  first.mesh.points[vertex] = inDepth(0.4);
  Patch second = first;
  second.mesh = cadtest::withShuffledCells(first.mesh, 3);
  optimise(first, 5);
  optimise(second, 5);
  EXPECT_EQ(first.mesh.points, second.mesh.points);
  EXPECT_NE(first.mesh.points, first.start);
}

/// Vertices wait for those whose cells are not all here, and go on once these are placed.
TEST_P(MakingWay, waitsForVerticesOfOthers)
{
  Patch whole = patchOf(mesh);
  whole.mesh.points[vertexAt(inDepth(0))] = inDepth(0.4);
  Patch part = whole;
  optimise(whole, 1);
  const Index other = vertexAt(inDepth(0.25));
  part.complete[other] = 0;
  PatchOptimiser optimiser(part);
  optimiser.beginSweep(optimiser.smallestMeasure());
  EXPECT_TRUE(optimiser.advance());
  EXPECT_FALSE(optimiser.isDone(other));
  optimiser.place(other, whole.mesh.points[other]);
  EXPECT_FALSE(optimiser.advance());
  EXPECT_EQ(part.mesh.points, whole.mesh.points);
}

/// A disc of radius 2, its corners at uneven distances.
Mesh unevenDisc(int corners)
{
  Mesh mesh = cadtest::discMesh(2, 0, corners);
  for (int c = 0; c < corners; ++c)
  {
    const double angle = 2 * 3.14159265358979323846 * (c + 0.15 * (c * c % 5 - 2)) / corners;
    mesh.points[c] = { 2 * std::cos(angle), 2 * std::sin(angle), 0 };
  }
  return mesh;
}

/// Corners of a polygon on a circle: they slide along it, but for the CAD vertex.
TEST(Sliding, keepsToTheCurve)
{
  constexpr int corners = 9;
  const auto model = cadtest::modelOf(cadtest::circle(2), ".igs");
  const BoundaryProjector projector(*model, BoundaryKind::Edges);
  Mesh mesh = unevenDisc(corners);
  Patch patch = patchOf(mesh);
  patch.free.assign(corners + 1, 1);
  patch.entities.assign(corners + 1, EntityId{ 1, 0 });
  patch.entities[0] = { 0, 0 };
  patch.entities[corners] = {};
  const double before = lowestQuality(mesh);
  optimise(patch, 20, &projector);
  for (int c = 0; c < corners; ++c)
  {
    EXPECT_NEAR(norm(patch.mesh.points[c]), 2, 1e-12);
    EXPECT_EQ(patch.mesh.points[c] == mesh.points[c], c == 0);
  }
  EXPECT_GT(lowestQuality(patch.mesh), 1.1 * before);
}

double longestChord(const std::vector<Point3>& points, int corners)
{
  double longest = 0;
  for (int c = 0; c < corners; ++c)
  {
    longest = std::max(longest, distance(points[c], points[(c + 1) % corners]));
  }
  return longest;
}

/// The vertex in the middle is pulled aside: others would crowd on the far side of the circle.
/// `isBisected`: every other corner was in the middle of the chord between its neighbours.
void expectChordsToStayAsClose(int corners, bool isBisected)
{
  const auto model = cadtest::modelOf(cadtest::circle(2), ".igs");
  const BoundaryProjector projector(*model, BoundaryKind::Edges);
  Mesh mesh = unevenDisc(corners);
  mesh.points[corners] = { 1.2, 0, 0 };
  Patch patch = patchOf(mesh);
  patch.free.assign(corners + 1, 1);
  patch.free[corners] = 0;
  patch.entities.assign(corners + 1, EntityId{ 1, 0 });
  for (int c = 1; c < corners && isBisected; c += 2)
  {
    patch.start[c] = 0.5 * (mesh.points[c - 1] + mesh.points[(c + 1) % corners]);
  }
  optimise(patch, 20, &projector);
  EXPECT_NE(patch.mesh.points, mesh.points);
  EXPECT_LE(longestChord(patch.mesh.points, corners), longestChord(mesh.points, corners) + 1e-9);
}

TEST(Sliding, keepsChordsAsCloseToTheCurve)
{
  expectChordsToStayAsClose(9, false);
}

TEST(Sliding, keepsHalvesOfChordsCloserThanTheChords)
{
  expectChordsToStayAsClose(10, true);
}

TEST(Sliding, keepsToTheSurface)
{
  const auto model = cadtest::modelOf(cadtest::sphere(2));
  const BoundaryProjector projector(*model, BoundaryKind::Faces);
  Mesh mesh = cadtest::ballMesh(2, 0);
  for (Index v = 0; v < 12; ++v)
  {
    mesh.points[v] = 2 * normalized(mesh.points[v] + Vector3{ 0.3 * (v % 3), 0.2, -0.2 * (v % 2) });
  }
  Patch patch = patchOf(mesh);
  patch.free.assign(13, 1);
  patch.entities.assign(13, EntityId{ 2, 0 });
  patch.entities[12] = {};
  const double before = lowestQuality(mesh);
  optimise(patch, 20, &projector);
  for (Index v = 0; v < 12; ++v)
  {
    EXPECT_NEAR(norm(patch.mesh.points[v]), 2, 1e-9);
  }
  EXPECT_GT(lowestQuality(patch.mesh), 1.05 * before);
}

} // namespace
