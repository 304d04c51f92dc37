// How mesh and CAD fit together, in closed forms; the same on any number of ranks.

#include "BadMesh.h"
#include "DataSets.h"
#include "TestMeshes.h"

#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkUnstructuredGrid.h>

#include <cmath>
#include <numeric>

namespace cadrefine
{
namespace
{

/// A unit cube in millimetres as CAD, meshed with 4 x 4 x 4 boxes.
class Fit : public BadMesh
{
protected:
  cadtest::FilterRun cube{ cadtest::writeInto(folder, cadtest::box(1, 1, 1), ".step"),
    worldController() };
  Mesh mesh = cadtest::cubeMesh(4, 0, 1);

  static constexpr double size = 1.7320508075688772;

  Mesh placed(double factor, const Vector3& by) const
  {
    Mesh result = mesh;
    for (Point3& p : result.points)
    {
      p = factor * p + by;
    }
    return result;
  }

  cadtest::Outcome project(const Mesh& of) const { return project(cadtest::toGrid(of)); }
  cadtest::Outcome project(vtkUnstructuredGrid* whole) const
  {
    return cube.attempt<vtkProjectOntoCAD>(pieceOf(whole), [](vtkProjectOntoCAD*) {});
  }

  /// A mesh in the plane, onto a disc of radius 1.
  cadtest::Outcome projectOntoDisc(const Mesh& of) const
  {
    const cadtest::FilterRun disc(
      cadtest::writeInto(folder, cadtest::discOfTwoArcs(1, 0), ".brep"), worldController());
    return disc.attempt<vtkProjectOntoCAD>(pieceOf(cadtest::toGrid(of)), [](vtkProjectOntoCAD*) {});
  }

  static double value(const cadtest::Outcome& outcome, const char* name)
  {
    return cadtest::fieldValue(outcome.pointSet(), name);
  }

  static std::vector<double> row(const cadtest::Outcome& outcome, const char* name, int tuple)
  {
    vtkDataArray* array = outcome.pointSet()->GetFieldData()->GetArray(name);
    std::vector<double> numbers;
    for (int k = 0; array && k < array->GetNumberOfComponents(); ++k)
    {
      numbers.push_back(array->GetComponent(tuple, k));
    }
    return numbers;
  }

  static std::vector<double> column(const cadtest::Outcome& outcome, const char* name)
  {
    vtkDataArray* array = outcome.pointSet()->GetFieldData()->GetArray(name);
    std::vector<double> numbers;
    for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i)
    {
      numbers.push_back(array->GetComponent(i, 0));
    }
    return numbers;
  }

  /// Rank 0 warns once, with this text; of no text, no rank warns.
  void expectWarning(const cadtest::Outcome& outcome, const std::string& text) const
  {
    const bool warns = exchange.rank() == 0 && !text.empty();
    ASSERT_EQ(outcome.warnings.size(), warns ? 1u : 0u)
      << (outcome.warnings.empty() ? "" : outcome.warnings[0]);
    if (warns)
    {
      EXPECT_NE(outcome.warnings[0].find(text), std::string::npos) << outcome.warnings[0];
    }
  }
};

TEST_F(Fit, ofTheRightMesh)
{
  const auto outcome = project(mesh);
  expectWarning(outcome, "");
  EXPECT_NEAR(value(outcome, "BoundaryOnCAD"), 1, 1e-12);
  EXPECT_NEAR(value(outcome, "BoundaryInBox"), 1, 1e-12);
  EXPECT_NEAR(value(outcome, "CADCovered"), 1, 1e-12);
  EXPECT_EQ(value(outcome, "VerticesOffCAD"), 0);
  EXPECT_EQ(value(outcome, "BridgingFacets"), 0);
  EXPECT_EQ(value(outcome, "ClassificationConflicts"), 0);
  EXPECT_EQ(row(outcome, "FarthestVertices", 0), std::vector<double>());
  for (const char* box : { "MeshBox", "CADBox" })
  {
    const auto bounds = column(outcome, box);
    ASSERT_EQ(bounds.size(), 6u);
    for (int k = 0; k < 6; ++k)
    {
      EXPECT_NEAR(bounds[k], k % 2, 1e-6 * size) << box;
    }
  }
}

TEST_F(Fit, isReported)
{
  std::string report;
  cube.run<vtkProjectOntoCAD>(pieceOf(cadtest::toGrid(mesh)),
    [&](vtkProjectOntoCAD* filter)
    {
      filter->Update();
      report = filter->GetFitReport();
    });
  EXPECT_NE(report.find(" mm\n100% of the mesh's boundary in the CAD's box (100% of all)"),
    std::string::npos)
    << report;
  EXPECT_NE(report.find("\nvertices off the CAD: 0\nvertices in conflict"), std::string::npos)
    << report;
}

/// The lower half of the cube: five sixths of its boundary, half of the CAD.
TEST_F(Fit, ofAMeshOfAPart)
{
  Mesh half = mesh;
  half.tetrahedra.clear();
  for (const auto& cell : mesh.tetrahedra)
  {
    double z = 0;
    for (const Index vertex : cell)
    {
      z += mesh.points[vertex][2] / 4;
    }
    if (z < 0.5)
    {
      half.tetrahedra.push_back(cell);
    }
  }
  const auto outcome = project(half);
  expectWarning(outcome, "");
  EXPECT_NEAR(value(outcome, "BoundaryOnCAD"), 3.0 / 4, 1e-12); // 3 of 3 + 1
  EXPECT_NEAR(value(outcome, "CADCovered"), 0.5, 1e-12);
  EXPECT_EQ(value(outcome, "VerticesOffCAD"), 9); // inside of the cut
  const auto farthest = row(outcome, "FarthestVertices", 0);
  ASSERT_EQ(farthest.size(), 4u);
  EXPECT_NEAR(distance({ farthest[0], farthest[1], farthest[2] }, { 0.5, 0.5, 0.5 }), 0, 1e-12);
  EXPECT_NEAR(farthest[3], 0.5, 1e-12);
  EXPECT_EQ(column(outcome, "FarthestVertices").size(), 9u);
  // In two corners of the cut a triangle has all its vertices on the sides.
  EXPECT_EQ(value(outcome, "BridgingFacets"), 2);
  const auto first = row(outcome, "BridgingFacetCentroids", 0);
  const auto second = row(outcome, "BridgingFacetCentroids", 1);
  ASSERT_EQ(second.size(), 3u);
  EXPECT_NEAR(distance({ first[0], first[1], first[2] }, { 1. / 12, 11. / 12, 0.5 }), 0, 1e-12);
  EXPECT_NEAR(distance({ second[0], second[1], second[2] }, { 11. / 12, 1. / 12, 0.5 }), 0, 1e-12);
}

/// Of an earlier projection onto something else nothing stays.
TEST_F(Fit, takesThePlaceOfAnother)
{
  auto grid = cadtest::toGrid(mesh);
  for (const char* name :
    { "CADCovered", "FarthestVertices", "BridgingFacetCentroids", "ConflictPoints" })
  {
    vtkNew<vtkDoubleArray> old;
    old->SetName(name);
    old->InsertNextValue(0.25);
    grid->GetFieldData()->AddArray(old);
  }
  const auto outcome = project(grid);
  EXPECT_NEAR(value(outcome, "CADCovered"), 1, 1e-12);
  EXPECT_EQ(column(outcome, "FarthestVertices"), std::vector<double>());
  EXPECT_EQ(column(outcome, "BridgingFacetCentroids"), std::vector<double>());
  EXPECT_EQ(column(outcome, "ConflictPoints"), std::vector<double>());
}

/// A far field is no misfit, even where its size is a thousand times that of the CAD.
TEST_F(Fit, ofAFarField)
{
  Mesh shell = cadtest::ballInShellMesh(2, 0);
  const auto outcome =
    filters.attempt<vtkProjectOntoCAD>(pieceOf(cadtest::toGrid(shell)), [](vtkProjectOntoCAD*) {});
  expectWarning(outcome, "");
  EXPECT_NEAR(value(outcome, "BoundaryOnCAD"), 1, 1e-12);
  EXPECT_NEAR(
    value(outcome, "BoundaryInBox"), 1.0 / 10, 1e-2); // its surface has nine times the area
  // The icosahedron's surface in the sphere's.
  EXPECT_NEAR(value(outcome, "CADCovered"), 0.7619, 1e-2);
}

TEST_F(Fit, namesTheUnit)
{
  const struct
  {
    double length; ///< Of the mesh's unit in millimetres.
    const char* name;
    const char* many;
  } cases[] = { { 1000, "m", "metres" }, { 10, "cm", "centimetres" }, { 25.4, "in", "inches" },
    { 304.8, "ft", "feet" } };
  for (const auto& unit : cases)
  {
    const auto outcome = project(placed(1 / unit.length, {}));
    expectWarning(outcome, std::string("as if the mesh were in ") + unit.many +
                             " and the CAD in millimetres: set Unit of the CAD Reader to " +
                             unit.name);
  }
  expectWarning(project(placed(0.3048, {})), "as if the mesh were in metres and the CAD in feet");
}

/// One body of two, in a box that is ten times as large.
TEST_F(Fit, ofOneBodyTellsNoUnit)
{
  const cadtest::FilterRun two(
    cadtest::writeInto(folder,
      cadtest::together(cadtest::box(1, 1, 1), cadtest::moved(cadtest::box(1, 1, 1), { 9, 9, 9 })),
      ".brep"),
    worldController());
  const auto outcome =
    two.attempt<vtkProjectOntoCAD>(pieceOf(cadtest::toGrid(mesh)), [](vtkProjectOntoCAD*) {});
  expectWarning(outcome, "");
  EXPECT_NEAR(value(outcome, "CADCovered"), 0.5, 1e-12);
}

/// A segment cut off a disc, whose chord is not in the CAD: a third of the size, and a quarter of
/// the circle at most, but its arc lies there.
TEST_F(Fit, ofAPartTellsNoUnit)
{
  constexpr Index last = 16;
  Mesh segment;
  segment.dimension = 2;
  for (Index i = 0; i <= last; ++i)
  {
    const double angle = 0.45 * (2.0 * i / last - 1);
    segment.points.push_back({ std::cos(angle), std::sin(angle), 0 });
  }
  for (Index i = 1; i < last; ++i)
  {
    segment.points.push_back({ std::cos(0.45), segment.points[i][1], 0 });
    segment.triangles.push_back({ i - 1, i, last + i });
    if (i > 1)
    {
      segment.triangles.push_back({ i - 1, last + i, last + i - 1 });
    }
  }
  segment.triangles.push_back({ last - 1, last, 2 * last - 1 });
  segment.ids.resize(segment.points.size());
  std::iota(segment.ids.begin(), segment.ids.end(), 0);
  expectWarning(projectOntoDisc(segment), "");
  for (Point3& p : segment.points)
  {
    p = 1.01 * p;
  }
  expectWarning(projectOntoDisc(segment), "as if the mesh were in metres and the CAD in feet");
}

TEST_F(Fit, tellsAVertexOffAmongOthersOnTheCAD)
{
  Mesh polygon = cadtest::discMesh(1, 0, 48);
  polygon.points[6] = 0.98 * polygon.points[6];
  expectWarning(projectOntoDisc(polygon),
    "moved onto the CAD where nearly all others lay on it already: 1, the "
    "farthest by 0.02 to (0.707107, 0.707107, 0)");
  for (int corner = 0; corner < 48; corner += 2) // now the mesh is no exact one
  {
    polygon.points[corner] = 0.98 * polygon.points[corner];
  }
  expectWarning(projectOntoDisc(polygon), "");
}

TEST_F(Fit, tellsAShift)
{
  expectWarning(project(placed(1, { 0.003, 0.003, 0.003 })), "shifted by (0.003, 0.003, 0.003)");
  expectWarning(project(placed(1, { 0.5, 0, 0 })), "shifted by (0.5, 0, 0)");
}

/// Half of the corner lies on the CAD, but most of the mesh is beside it.
TEST_F(Fit, tellsAMeshElsewhere)
{
  Mesh flat = mesh;
  for (Point3& p : flat.points)
  {
    p = { 0.2 * p[0], p[1], 7 * p[2] - 6.9 };
  }
  expectWarning(
    project(flat), "check that the mesh and the CAD have the same position and unit of length");
}

TEST_F(Fit, isAnErrorWhereNothingIsOnTheCAD)
{
  for (const double factor : { 1.0, 1000.0 })
  {
    expectError(
      project(placed(factor, { 5000, 0, 0 })), "no vertex could be projected onto the CAD");
  }
}

} // namespace
} // namespace cadrefine
