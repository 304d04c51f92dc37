// Chord errors and angles between facets, in closed form.

#include "DataSets.h"
#include "FilterRun.h"
#include "TestMeshes.h"
#include "TestShapes.h"

#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>

namespace
{

using namespace cadrefine;
using Data = cadtest::FilterRun::Data;

constexpr double pi = 3.14159265358979323846;
constexpr double radius = 2;
constexpr double tolerance = 1e-11;

/// The angle between the facets of an icosahedron is acos(-sqrt(5) / 3); its edges are
/// sqrt(50 - 10 sqrt(5)) / 5 times the radius of the sphere through its corners.
const double icosahedronAngle = 180 - 180 / pi * std::acos(-std::sqrt(5.0) / 3);
const double icosahedronChord = radius * (1 - std::sqrt(1 - (50 - 10 * std::sqrt(5.0)) / 100));

class Size : public testing::Test
{
protected:
  cadtest::TemporaryFolder folder;

  Data measured(const TopoDS_Shape& shape, vtkPointSet* mesh, int depth = 1) const
  {
    const cadtest::FilterRun filters(cadtest::writeInto(folder, shape, ".brep"));
    return filters.measure(filters.project(mesh), depth);
  }

  static std::vector<double> valuesOf(vtkPointSet* data, const char* name)
  {
    vtkDataArray* array = data->GetCellData()->GetArray(name);
    std::vector<double> values;
    for (vtkIdType c = 0; c < array->GetNumberOfTuples(); ++c)
    {
      values.push_back(array->GetTuple1(c));
    }
    return values;
  }

  static void expectAll(vtkPointSet* data, double chord, double angle)
  {
    for (const double value : valuesOf(data, "ChordError"))
    {
      EXPECT_NEAR(value, chord, tolerance);
    }
    for (const double value : valuesOf(data, "NormalAngle"))
    {
      EXPECT_NEAR(value, angle, 1e-9);
    }
    EXPECT_NEAR(cadtest::fieldValue(data, "MaximumChordError"), chord, tolerance);
    EXPECT_NEAR(cadtest::fieldValue(data, "MaximumNormalAngle"), angle, 1e-9);
  }
};

/// One vertex of the polygon is the circle's own; each side has another neighbour. Depth is of no
/// matter.
TEST_F(Size, ofAPolygonOnACircle)
{
  for (const int corners : { 3, 5, 12, 100 })
  {
    for (const int depth : { 1, 3 })
    {
      const Data data = measured(
        cadtest::circle(radius), cadtest::toGrid(cadtest::discMesh(radius, 0, corners)), depth);
      expectAll(data, radius * (1 - std::cos(pi / corners)), 360.0 / corners);
    }
  }
}

/// Segments that are listed inside the mesh, every other one turned round.
TEST_F(Size, ofListedSegments)
{
  constexpr int corners = 8;
  Mesh mesh = cadtest::discInRingMesh(radius, 0, corners);
  for (std::size_t s = 0; s < mesh.segments.size(); s += 2)
  {
    std::swap(mesh.segments[s][0], mesh.segments[s][1]);
  }
  const Data data = measured(cadtest::circle(radius), cadtest::toGrid(mesh));
  EXPECT_NEAR(cadtest::fieldValue(data, "MaximumChordError"), radius * (1 - std::cos(pi / corners)),
    tolerance);
  EXPECT_NEAR(cadtest::fieldValue(data, "MaximumNormalAngle"), 360.0 / corners, 1e-9);
  const auto angles = valuesOf(data, "NormalAngle");
  EXPECT_EQ(
    std::count_if(angles.begin(), angles.end(), [](double angle) { return angle > 1; }), corners);
}

TEST_F(Size, ofABall)
{
  expectAll(measured(cadtest::sphere(radius), cadtest::toGrid(cadtest::ballMesh(radius, 0))),
    icosahedronChord, icosahedronAngle);
}

TEST_F(Size, ofTrianglesInSpaceHoweverTheyAreTurned)
{
  Mesh mesh = cadtest::sphereMesh(radius, 0);
  for (const bool turned : { false, true })
  {
    for (std::size_t t = 0; turned && t < mesh.triangles.size(); t += 3)
    {
      std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
    }
    expectAll(measured(cadtest::sphere(radius), cadtest::toPolyData(mesh)), icosahedronChord,
      icosahedronAngle);
  }
}

TEST_F(Size, ofListedTriangles)
{
  Mesh mesh = cadtest::ballInShellMesh(radius, 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3)
  {
    std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
  }
  const Data data = measured(cadtest::sphere(radius), cadtest::toGrid(mesh));
  EXPECT_NEAR(cadtest::fieldValue(data, "MaximumChordError"), icosahedronChord, tolerance);
  EXPECT_NEAR(cadtest::fieldValue(data, "MaximumNormalAngle"), icosahedronAngle, 1e-9);
}

/// A regular tetrahedron turns by more than 90 degrees.
TEST_F(Size, ofAVeryCoarseSurface)
{
  Mesh mesh;
  mesh.dimension = 2;
  const double c = radius / std::sqrt(3.0);
  mesh.points = { { c, c, c }, { c, -c, -c }, { -c, c, -c }, { -c, -c, c } };
  mesh.ids = { 0, 1, 2, 3 };
  mesh.triangles = { { 0, 1, 2 }, { 0, 2, 3 }, { 0, 3, 1 }, { 3, 2, 1 } };
  expectAll(measured(cadtest::sphere(radius), cadtest::toPolyData(mesh)), c * (std::sqrt(3.0) - 1),
    180 - 180 / pi * std::acos(1.0 / 3));
}

/// A prism in a cylinder, as a surface: `corners` sides of two triangles each, then the two ends.
/// The rims are creases.
TEST_F(Size, stopsAtCreases)
{
  constexpr int corners = 8;
  constexpr double height = 1;
  Mesh mesh;
  mesh.dimension = 2;
  for (const double z : { 0.0, height })
  {
    for (int k = 0; k < corners; ++k)
    {
      const double angle = 2 * pi * k / corners;
      mesh.points.push_back({ radius * std::cos(angle), radius * std::sin(angle), z });
    }
  }
  mesh.points.push_back({ 0, 0, 0 });
  mesh.points.push_back({ 0, 0, height });
  for (Index k = 0; k < corners; ++k)
  {
    const Index next = (k + 1) % corners;
    mesh.triangles.push_back({ k, next, next + corners });
    mesh.triangles.push_back({ k, next + corners, k + corners });
  }
  for (Index k = 0; k < corners; ++k)
  {
    const Index next = (k + 1) % corners;
    mesh.triangles.push_back({ 2 * corners, next, k });
    mesh.triangles.push_back({ 2 * corners + 1, k + corners, next + corners });
  }
  for (Index v = 0; v < static_cast<Index>(mesh.points.size()); ++v)
  {
    mesh.ids.push_back(v);
  }
  const Data data = measured(cadtest::cylinder(radius, height), cadtest::toPolyData(mesh));
  const auto angles = valuesOf(data, "NormalAngle");
  const auto chords = valuesOf(data, "ChordError");
  for (std::size_t c = 0; c < angles.size(); ++c)
  {
    const bool isEnd = c >= 2 * corners;
    EXPECT_NEAR(angles[c], isEnd ? 0 : 360.0 / corners, 1e-9) << "triangle " << c;
    EXPECT_NEAR(chords[c], radius * (1 - std::cos(pi / corners)), tolerance) << "triangle " << c;
  }
}

/// Each side of the mesh on an arc: r (1 - cos(asin(length / 2r))).
TEST_F(Size, ofThreeArcs)
{
  const std::array<Point3, 3> centres{ { { 2, 3.75, 0 }, { -0.8125, -2.25, 0 }, { 2, 1.5, 0 } } };
  const std::array<double, 3> radii{ 4.25, 5.3125, 2.5 };
  const cadtest::FilterRun filters(CADREFINE_DATA "/three_arcs.igs");
  const Data data =
    filters.measure(filters.project(cadtest::readGrid(CADREFINE_DATA "/three_arcs_coarse.vtu")), 2);
  const Mesh mesh = cadtest::toMesh(data);
  const auto chords = valuesOf(data, "ChordError");
  const auto angles = valuesOf(data, "NormalAngle");
  const std::size_t first = chords.size() - mesh.triangles.size();
  int sides = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
  {
    double chord = 0;
    double halfAngle = 0;
    for (int k = 0; k < 3; ++k)
    {
      const Point3& a = mesh.points[mesh.triangles[t][k]];
      const Point3& b = mesh.points[mesh.triangles[t][(k + 1) % 3]];
      for (std::size_t arc = 0; arc < 3; ++arc)
      {
        const auto isOn = [&](const Point3& p)
        { return std::abs(distance(centres[arc], p) - radii[arc]) < 1e-11; };
        if (isOn(a) && isOn(b))
        {
          ++sides;
          halfAngle = std::asin(distance(a, b) / (2 * radii[arc]));
          chord = std::max(chord, radii[arc] * (1 - std::cos(halfAngle)));
        }
      }
    }
    EXPECT_NEAR(chords[first + t], chord, tolerance);
    EXPECT_EQ(angles[first + t] > 0, halfAngle > 0);
    EXPECT_GE(angles[first + t], 180 / pi * halfAngle - 1e-9) << "half of it is its own";
    EXPECT_LT(angles[first + t], 25) << "the corners, where it turns more, do not count";
  }
  EXPECT_EQ(sides, 10);
}

} // namespace
