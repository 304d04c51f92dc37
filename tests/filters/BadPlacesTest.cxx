// Meshes and CAD that lie far from the origin or are tiny, far from each other, inside out, or one
// in the other.

#include "BadMesh.h"
#include "DataSets.h"
#include "MeshChecks.h"
#include "TestMeshes.h"

#include <vtkDataArray.h>
#include <vtkPointData.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace cadrefine
{

namespace
{

class BadPlaces : public BadMesh
{
protected:
  cadtest::FilterRun with(const TopoDS_Shape& shape) const
  {
    return cadtest::FilterRun(cadtest::writeInto(folder, shape, ".brep"), worldController());
  }

  /// Every point times `factor`, then moved.
  static Mesh placed(Mesh mesh, double factor, const Vector3& by)
  {
    for (Point3& point : mesh.points)
    {
      point = factor * point + by;
    }
    return mesh;
  }

  /// After projection and two uniform refinements.
  static vtkSmartPointer<vtkPointSet> refined(const cadtest::FilterRun& run, vtkPointSet* mesh)
  {
    return run.refineUniformly(run.project(mesh), 2);
  }

  /// Largest difference of the distance of CAD vertices to `centre` from `radius`, on all ranks.
  double farthestOff(vtkPointSet* mesh, const Point3& centre, double radius)
  {
    vtkDataArray* dimensions = mesh->GetPointData()->GetArray("CADDimension");
    double largest = 0;
    for (vtkIdType p = 0; p < mesh->GetNumberOfPoints(); ++p)
    {
      Point3 point;
      mesh->GetPoint(p, point.data());
      largest = dimensions->GetTuple1(p) < 0
                  ? largest
                  : std::max(largest, std::abs(distance(point, centre) - radius));
    }
    return exchange.max(largest);
  }

  static void expectSound(vtkPointSet* mesh, double vertices)
  {
    EXPECT_EQ(cadtest::fieldValue(mesh, "InvalidCells"), 0);
    EXPECT_EQ(cadtest::fieldValue(mesh, "UnprojectedVertices"), 0);
    EXPECT_EQ(cadtest::fieldValue(mesh, "CADVertices"), vertices);
  }
};

constexpr double verticesOnBall = 162; // 12, and the middles of edges twice

/// Coordinates there are 2e-9 apart.
TEST_F(BadPlaces, farFromTheOrigin)
{
  const Point3 centre{ 1e7, -1e7, 1e7 };
  const double spacing = 1e7 * std::numeric_limits<double>::epsilon();
  const auto whole = cadtest::toGrid(placed(cadtest::ballMesh(2, 0.03), 1, centre));
  const auto run = with(cadtest::moved(cadtest::sphere(2), centre));
  const auto mesh = refined(run, pieceOf(whole));
  expectSound(mesh, verticesOnBall);
  EXPECT_LE(farthestOff(mesh, centre, 2), 4 * spacing);
  const auto measured = run.measure(mesh, 2);
  EXPECT_NEAR(cadtest::fieldValue(measured, "GlobalGeometricError"),
    cadtest::fieldValue(
      filters.measure(refined(filters, pieceOf(ball())), 2), "GlobalGeometricError"),
    1e-6);
  if (exchange.rank() == 0)
  {
    const cadtest::FilterRun alone(run.cad());
    const auto expected = refined(alone, whole);
    EXPECT_EQ(
      cadtest::fieldValue(expected, "MinimumQuality"), cadtest::fieldValue(mesh, "MinimumQuality"));
  }
}

TEST_F(BadPlaces, tiny)
{
  for (const double size : { 1e-3, 1e-9 })
  {
    SCOPED_TRACE(size);
    const auto whole = cadtest::toGrid(placed(cadtest::ballMesh(2, 0.03), size, {}));
    const auto run = with(cadtest::scaled(cadtest::sphere(2), size));
    const auto mesh = refined(run, pieceOf(whole));
    expectSound(mesh, verticesOnBall);
    EXPECT_LE(farthestOff(mesh, {}, 2 * size), 1e-9 * size) << size;
    const double error =
      cadtest::fieldValue(run.measure(mesh, 2), "GlobalGeometricError") / std::pow(size, 3);
    EXPECT_NEAR(error,
      cadtest::fieldValue(
        filters.measure(refined(filters, pieceOf(ball())), 2), "GlobalGeometricError"),
      1e-9);
  }
}

/// A box: with edges and corners.
TEST_F(BadPlaces, boxesAnywhere)
{
  const Mesh mesh = cadtest::cubeMesh(2, 0, 1);
  for (const double size : { 1e-9, 1.0, 1e7 })
  {
    SCOPED_TRACE(size);
    const Vector3 by{ size == 1 ? 1e7 : 0, 0, 0 };
    const auto run = with(cadtest::moved(cadtest::scaled(cadtest::box(1, 1, 1), size), by));
    const auto projected = run.project(pieceOf(cadtest::toGrid(placed(mesh, size, by))));
    expectSound(projected, 26);
    std::vector<std::int64_t> counts(3, 0);
    vtkDataArray* dimensions = projected->GetPointData()->GetArray("CADDimension");
    const auto ids = cadtest::gather(exchange, projected);
    for (vtkIdType p = 0; exchange.size() == 1 && p < projected->GetNumberOfPoints(); ++p)
    {
      const int dimension = static_cast<int>(dimensions->GetTuple1(p));
      if (dimension >= 0)
      {
        ++counts[dimension];
      }
    }
    if (exchange.size() == 1)
    {
      EXPECT_EQ(counts, (std::vector<std::int64_t>{ 8, 12, 6 }));
    }
  }
}

TEST_F(BadPlaces, boundaryFarFromTheCAD)
{
  const Mesh mesh = placed(cadtest::ballMesh(2, 0.03), 1, { 100, 0, 0 });
  const auto whole = cadtest::toGrid(mesh);
  const auto outcome =
    filters.attempt<vtkProjectOntoCAD>(pieceOf(whole), [](vtkProjectOntoCAD*) {});
  expectError(outcome, "no vertex could be projected onto the CAD");
  expectError(filters.attempt<vtkAdaptToCAD>(pieceOf(whole), [](vtkAdaptToCAD*) {}),
    "no vertex could be projected onto the CAD");
}

/// The CAD's normals point into the body.
TEST_F(BadPlaces, insideOut)
{
  const auto run = with(cadtest::sphere(2).Reversed());
  const auto mesh = refined(run, pieceOf(ball()));
  const auto expected = refined(filters, pieceOf(ball()));
  expectSound(mesh, verticesOnBall);
  EXPECT_LE(farthestOff(mesh, {}, 2), 1e-12);
  EXPECT_EQ(cadtest::fieldValue(run.measure(mesh, 1), "GlobalGeometricError"),
    cadtest::fieldValue(filters.measure(expected, 1), "GlobalGeometricError"));
  const Mesh cube = cadtest::cubeMesh(2, 0, 1);
  const auto box = with(cadtest::box(1, 1, 1).Reversed());
  expectSound(box.project(pieceOf(cadtest::toGrid(cube))), 26);
}

/// Each facet goes to the one that is nearer to its middle.
TEST_F(BadPlaces, oneShellInTheOther)
{
  const auto run = with(cadtest::together(cadtest::sphere(2), cadtest::sphere(4)));
  const auto inner = refined(run, pieceOf(ball()));
  expectSound(inner, verticesOnBall);
  EXPECT_LE(farthestOff(inner, {}, 2), 1e-12);
  const auto outer = refined(run, pieceOf(cadtest::toGrid(cadtest::ballMesh(4, 0.03))));
  expectSound(outer, verticesOnBall);
  EXPECT_LE(farthestOff(outer, {}, 4), 1e-12);
}

/// In the middle between two: on either, never inverted, and the same on any number of ranks.
TEST_F(BadPlaces, betweenTwoShells)
{
  const auto run = with(cadtest::together(cadtest::sphere(2), cadtest::sphere(2.1)));
  const auto whole = cadtest::toGrid(cadtest::ballMesh(2.05, 0.03));
  const auto mesh = refined(run, pieceOf(whole));
  EXPECT_EQ(cadtest::fieldValue(mesh, "InvalidCells"), 0);
  if (exchange.rank() == 0)
  {
    const auto expected = refined(cadtest::FilterRun(run.cad()), whole);
    for (const char* name : { "CADVertices", "UnprojectedVertices", "MinimumQuality" })
    {
      EXPECT_EQ(cadtest::fieldValue(mesh, name), cadtest::fieldValue(expected, name)) << name;
    }
  }
}

} // namespace

} // namespace cadrefine
