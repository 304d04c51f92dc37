// Fields under operations: what is linear stays so, and what cells hold is shared out to the last.

#include "SpoiltCube.h"

#include <cadrefine/mesh/Overlap.h>
#include <cadrefine/operations/FieldRows.h>
#include <cadrefine/operations/Improvement.h>
#include <cadrefine/operations/Operations.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <vector>

namespace
{

using namespace cadrefine;

MeshBefore before(const EditableMesh& mesh)
{
  MeshBefore result;
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v)
  {
    result.points.push_back(mesh.vertex(static_cast<Index>(v)).point);
  }
  result.cells = mesh.cells().size();
  return result;
}

/// The value that a row gives, of those that were.
double valueOf(const WeightedRows& rows, std::size_t row, const std::vector<double>& values)
{
  double sum = 0;
  for (Index k = rows.firsts[row]; k < rows.firsts[row + 1]; ++k)
  {
    sum += rows.weights[k] * values[rows.sources[k]];
  }
  return sum;
}

double sizeOf(const EditableMesh& mesh, Index cell)
{
  SimplexPoints<4> points;
  const auto& corners = mesh.cells()[cell].corners;
  std::transform(
    corners.begin(), corners.end(), points.begin(), [&](Index v) { return mesh.vertex(v).point; });
  return measure(points);
}

/// A cube after operations.
struct Operated
{
  EditableMesh mesh;
  MeshBefore was;
  std::vector<double> volumes; ///< Of its cells.
  FieldRows rows;

  explicit Operated(unsigned seed) : mesh(cadtest::spoiltCube(seed)), was(before(mesh))
  {
    for (std::size_t c = 0; c < was.cells; ++c)
    {
      volumes.push_back(sizeOf(mesh, static_cast<Index>(c)));
    }
    improveCells(mesh, nullptr, { 0.5, 0.3 });
    rows = findFieldRows(mesh, was, { true, true });
  }

  /// Values of cells after operations, of those that are there.
  std::map<Index, double> carried(const WeightedRows& cells, const std::vector<double>& old) const
  {
    std::map<Index, double> values;
    for (std::size_t c = 0; c < mesh.cells().size(); ++c)
    {
      const auto cell = static_cast<Index>(c);
      if (mesh.cells().exists(cell))
      {
        values[cell] = old[mesh.cells()[cell].parent];
      }
    }
    for (std::size_t r = 0; r < cells.size(); ++r)
    {
      EXPECT_TRUE(mesh.cells().exists(cells.targets[r]));
      values[cells.targets[r]] = valueOf(cells, r, old);
    }
    return values;
  }
};

constexpr unsigned seeds = 10;

TEST(FieldRows, keepALinearField)
{
  const auto field = [](const Point3& p) { return 1 + 2 * p[0] - 3 * p[1] + 5 * p[2]; };
  for (unsigned seed = 0; seed < seeds; ++seed)
  {
    const Operated cube(seed);
    std::vector<double> values;
    std::transform(
      cube.was.points.begin(), cube.was.points.end(), std::back_inserter(values), field);
    const WeightedRows& rows = cube.rows.ofVertices;
    EXPECT_GT(rows.size(), 5);
    EXPECT_TRUE(std::is_sorted(rows.targets.begin(), rows.targets.end()));
    for (std::size_t r = 0; r < rows.size(); ++r)
    {
      EXPECT_NEAR(valueOf(rows, r, values), field(cube.mesh.vertex(rows.targets[r]).point), 1e-13);
    }
    EXPECT_TRUE(std::all_of(
      rows.weights.begin(), rows.weights.end(), [](double w) { return w > 0 && w <= 1; }));
    // whoever moved or is new has one
    for (std::size_t v = 0; v < cube.mesh.vertexCount(); ++v)
    {
      const auto vertex = static_cast<Index>(v);
      const bool isNew = v >= cube.was.points.size();
      if (!cube.mesh.cells().at(vertex).empty() &&
          (isNew || cube.mesh.vertex(vertex).point != cube.was.points[v]))
      {
        EXPECT_TRUE(std::binary_search(rows.targets.begin(), rows.targets.end(), vertex));
      }
    }
  }
}

TEST(FieldRows, shareOutWhatCellsHold)
{
  for (unsigned seed = 0; seed < seeds; ++seed)
  {
    const Operated cube(seed);
    std::mt19937 random(seed);
    std::vector<double> densities;
    std::array<double, 2> held{};
    for (std::size_t c = 0; c < cube.was.cells; ++c)
    {
      densities.push_back(static_cast<double>(random() % 1000));
      held[cube.mesh.cells()[static_cast<Index>(c)].label] += densities[c] * cube.volumes[c];
    }
    std::array<double, 2> after{};
    for (const auto& [cell, density] : cube.carried(cube.rows.ofDensities, densities))
    {
      after[cube.mesh.cells()[cell].label] += density * sizeOf(cube.mesh, cell);
    }
    for (const int material : { 0, 1 })
    {
      EXPECT_NEAR(after[material], held[material], 1e-13 * held[material]);
    }
    // The boundary stayed, so that the mean is conservative too.
    const auto means = cube.carried(cube.rows.ofCells, densities);
    const auto shares = cube.carried(cube.rows.ofDensities, densities);
    for (const auto& [cell, mean] : means)
    {
      EXPECT_NEAR(mean, shares.at(cell), 1e-9 * 1000);
    }
  }
}

TEST(FieldRows, areMeansOfWhatIsNear)
{
  for (unsigned seed = 0; seed < seeds; ++seed)
  {
    const Operated cube(seed);
    const WeightedRows& rows = cube.rows.ofCells;
    for (std::size_t r = 0; r < rows.size(); ++r)
    {
      const std::vector<double> ones(cube.was.cells, 1);
      EXPECT_NEAR(valueOf(rows, r, ones), 1, 1e-14);
      EXPECT_TRUE(std::is_sorted(
        rows.sources.begin() + rows.firsts[r], rows.sources.begin() + rows.firsts[r + 1]));
      for (Index k = rows.firsts[r]; k < rows.firsts[r + 1]; ++k)
      {
        EXPECT_EQ(
          cube.mesh.cells()[rows.sources[k]].label, cube.mesh.cells()[rows.targets[r]].label);
      }
    }
    // What is as it was has no row.
    for (std::size_t c = 0; c < cube.was.cells; ++c)
    {
      const auto cell = static_cast<Index>(c);
      const auto& corners = cube.mesh.cells()[cell].corners;
      const bool isSame =
        cube.mesh.cells().exists(cell) &&
        std::all_of(corners.begin(), corners.end(),
          [&](Index v) { return cube.mesh.vertex(v).point == cube.was.points[v]; });
      if (isSame)
      {
        EXPECT_FALSE(std::binary_search(rows.targets.begin(), rows.targets.end(), cell));
      }
    }
  }
}

/// Two tetrahedra at a common face, in a mesh with the five corners of both.
EditableMesh twoCells()
{
  EditableMesh mesh;
  for (const Point3& point :
    { Point3{ 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 0, 0, -1 } })
  {
    mesh.addVertex({ point, point, {}, false, false });
  }
  mesh.addCell({ { 0, 1, 2, 3 }, 0, 0 });
  mesh.addCell({ { 0, 2, 1, 4 }, 0, 1 });
  return mesh;
}

TEST(FieldRows, ofACellThatIsThereAgainTakeItsValue)
{
  EditableMesh mesh = twoCells();
  const MeshBefore was = before(mesh);
  Cavity cavity;
  cavity.cells = { 0 };
  cavity.newCells = { { { 2, 0, 1, 3 }, 0, 1 } }; // from a parent that it is not
  mesh.replace(cavity);
  const FieldRows rows = findFieldRows(mesh, was, { true, true });
  for (const WeightedRows* list : { &rows.ofCells, &rows.ofDensities })
  {
    EXPECT_EQ(list->targets, std::vector<Index>{ 2 });
    EXPECT_EQ(list->sources, std::vector<Index>{ 0 });
    EXPECT_EQ(list->weights, std::vector<double>{ 1 });
  }
  EXPECT_TRUE(rows.ofVertices.empty());
}

/// The boundary moves: the parts of each old cell still sum to 1.
TEST(FieldRows, shareOutWhatLiesBeyondTheNewBoundary)
{
  EditableMesh mesh = twoCells();
  const MeshBefore was = before(mesh);
  mesh.moveVertex(4, { 0, 0, -0.5 });
  const FieldRows rows = findFieldRows(mesh, was, { true, true });
  EXPECT_EQ(rows.ofDensities.targets, std::vector<Index>{ 1 });
  EXPECT_NEAR(valueOf(rows.ofDensities, 0, { 0, 1 }), 2, 1e-15);
  EXPECT_NEAR(valueOf(rows.ofCells, 0, { 0, 1 }), 1, 1e-15);
}

/// An old cell that no new one overlaps, and a new one that overlaps no old one.
TEST(FieldRows, giveToTheNearest)
{
  EditableMesh mesh = twoCells();
  for (const Point3& point : { Point3{ 5, 0, 0 }, { 6, 0, 0 }, { 5, 1, 0 }, { 5, 0, 1 } })
  {
    mesh.addVertex({ point, point, {}, false, false });
  }
  const MeshBefore was = before(mesh);
  Cavity cavity;
  cavity.cells = { 1 };
  cavity.newCells = { { { 5, 6, 7, 8 }, 0, 1 } };
  mesh.replace(cavity);
  const FieldRows rows = findFieldRows(mesh, was, { true, true });
  EXPECT_EQ(rows.ofDensities.targets, std::vector<Index>{ 2 });
  EXPECT_NEAR(valueOf(rows.ofDensities, 0, { 3, 7 }), 7, 1e-14); // of the same volume
  EXPECT_NEAR(valueOf(rows.ofCells, 0, { 3, 7 }), 7, 1e-14);
}

/// Triangles of a bent strip; the diagonal of two of them is exchanged.
TEST(FieldRows, ofTrianglesInSpace)
{
  EditableMesh mesh(EditableMesh::Kind::Surface);
  for (const Point3& point : { Point3{ 0, 0, 0 }, { 1, 0, 0.01 }, { 1, 1, 0 }, { 0, 1, 0.01 } })
  {
    mesh.addVertex({ point, point, {}, false, false });
  }
  mesh.addFacet({ { 0, 1, 2 }, 0, 0 });
  mesh.addFacet({ { 0, 2, 3 }, 0, 1 });
  MeshBefore was = before(mesh);
  was.cells = 2;
  Cavity cavity;
  cavity.facets = { 0, 1 };
  cavity.newFacets = { { { 0, 1, 3 }, 0, 0 }, { { 1, 2, 3 }, 0, 1 } };
  mesh.replace(cavity);
  const FieldRows rows = findFieldRows(mesh, was, { true, true });
  ASSERT_EQ(rows.ofCells.targets, (std::vector<Index>{ 2, 3 }));
  EXPECT_NEAR(valueOf(rows.ofCells, 0, { 1, 3 }), 2, 0.01);
  EXPECT_NEAR(valueOf(rows.ofCells, 1, { 1, 3 }), 2, 0.01);
  const auto area = [&](Index f)
  {
    const auto& [a, b, c] = mesh.facets()[f].corners;
    return measure(
      SimplexPoints<3>{ mesh.vertex(a).point, mesh.vertex(b).point, mesh.vertex(c).point });
  };
  const double held = 1 * area(0) + 3 * area(1);
  EXPECT_NEAR(valueOf(rows.ofDensities, 0, { 1, 3 }) * area(2) +
                valueOf(rows.ofDensities, 1, { 1, 3 }) * area(3),
    held, 1e-15 * held + 1e-15);
}

/// A vertex that moved and then went is in no cell any more.
TEST(FieldRows, haveNoneOfVerticesThatWent)
{
  EditableMesh mesh = cadtest::spoiltCube(1);
  const MeshBefore was = before(mesh);
  Index gone = -1;
  Cavity cavity;
  for (std::size_t v = 0; v < mesh.vertexCount() && gone < 0; ++v)
  {
    const auto vertex = static_cast<Index>(v);
    for (const Index cell : std::vector<Index>(mesh.cells().at(vertex)))
    {
      for (const Index to : mesh.cells()[cell].corners)
      {
        if (gone < 0 && to != vertex && proposeCollapse(mesh, vertex, to, cavity) &&
            mesh.isValid(cavity))
        {
          gone = vertex;
        }
      }
    }
    if (gone >= 0)
    {
      mesh.moveVertex(gone, mesh.vertex(gone).point + Vector3{ 1e-6, 0, 0 });
      mesh.replace(cavity);
    }
  }
  ASSERT_GE(gone, 0);
  const FieldRows rows = findFieldRows(mesh, was, { true, true });
  EXPECT_EQ(std::count(rows.ofVertices.targets.begin(), rows.ofVertices.targets.end(), gone), 0);
  EXPECT_FALSE(rows.ofCells.empty());
}

} // namespace
