// CAD Boundary, and the property BoundaryCells of other filters: each facet has the CAD face that
// it lies on, and what belongs to it.

#include "DataSets.h"
#include "FilterRun.h"
#include "IgesCases.h"
#include "MeshChecks.h"
#include "TestFiles.h"
#include "TestMeshes.h"
#include "TestShapes.h"

#include <cadrefine/cad/model/CADModel.h>

#include <vtkAdaptToCAD.h>
#include <vtkCADBoundary.h>
#include <vtkCADModelCache.h>
#include <vtkCellData.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace
{

using namespace cadrefine;
using Data = cadtest::FilterRun::Data;

Data boundaryOf(const cadtest::FilterRun& filters, vtkPointSet* mesh)
{
  return filters.run<vtkCADBoundary>(mesh, [](vtkCADBoundary*) {});
}

EntityId entityOf(vtkPointSet* boundary, vtkIdType cell)
{
  vtkCellData* const cells = boundary->GetCellData();
  return { static_cast<std::int8_t>(cells->GetArray("CADDimension")->GetTuple1(cell)),
    static_cast<std::int32_t>(cells->GetArray("CADEntity")->GetTuple1(cell)) };
}

Point3 centroidOf(vtkPointSet* boundary, vtkIdType cell)
{
  vtkIdList* const points = boundary->GetCell(cell)->GetPointIds();
  Point3 sum{};
  for (const vtkIdType point : *points)
  {
    Point3 corner;
    boundary->GetPoint(point, corner.data());
    sum = sum + corner;
  }
  return (1.0 / static_cast<double>(points->GetNumberOfIds())) * sum;
}

/// By a search of each entity of this dimension by itself.
double nearestOfAll(const CADModel& model, int dimension, const Point3& point)
{
  double nearest = std::numeric_limits<double>::infinity();
  for (int entity = 0; entity < model.count(dimension); ++entity)
  {
    const EntityId id{ static_cast<std::int8_t>(dimension), entity };
    nearest = std::min(nearest, model.nearestOn(id, point).distance);
  }
  return nearest;
}

/// Each facet is on the entity nearest to its middle, up to `tolerance` (at corners facets bulge
/// over their face's border).
void expectNearestEntities(
  const CADModel& model, vtkPointSet* boundary, int dimension, double tolerance)
{
  for (vtkIdType cell = 0; cell < boundary->GetNumberOfCells(); ++cell)
  {
    const EntityId entity = entityOf(boundary, cell);
    ASSERT_EQ(entity.dimension, dimension) << cell;
    const Point3 middle = centroidOf(boundary, cell);
    EXPECT_LE(
      model.nearestOn(entity, middle).distance, nearestOfAll(model, dimension, middle) + tolerance)
      << cell;
  }
}

TEST(CADBoundary, namesTheFaceOfEachFacet)
{
  const cadtest::TemporaryFolder folder;
  const cadtest::FilterRun filters(cadtest::writeInto(folder, cadtest::partWithCavity(), ".step"));
  const auto mesh =
    filters.refineUniformly(filters.project(cadtest::readGrid(CADREFINE_DATA "/part_coarse.vtu")));
  const auto boundary = boundaryOf(filters, mesh);
  const auto facets = static_cast<vtkIdType>(cadtest::countOuterSides(cadtest::toMesh(mesh)));
  ASSERT_EQ(boundary->GetNumberOfCells(), facets);
  EXPECT_EQ(cadtest::countOuterSides(cadtest::toMesh(boundary)), 0u) << "it is closed";
  EXPECT_NEAR(cadtest::volumeInside(cadtest::toMesh(boundary)),
    cadtest::measureOf(cadtest::toMesh(mesh)), 1e-12);
  const auto model = vtkCADModelCache::Get(filters.cad());
  expectNearestEntities(*model, boundary, 2, 1e-3);
  std::vector<int> facetsOf(model->count(2), 0);
  for (vtkIdType cell = 0; cell < facets; ++cell)
  {
    ++facetsOf[entityOf(boundary, cell).index];
  }
  EXPECT_EQ(std::count(facetsOf.begin(), facetsOf.end(), 0), 0) << "every face has some";
}

/// In the plane facets are segments, and lie on edges.
TEST(CADBoundary, namesTheEdgeOfEachSegment)
{
  const cadtest::FilterRun filters(CADREFINE_DATA "/three_arcs.igs");
  const auto mesh = filters.refineUniformly(
    filters.project(cadtest::readGrid(CADREFINE_DATA "/three_arcs_coarse.vtu")));
  const auto boundary = boundaryOf(filters, mesh);
  const auto model = vtkCADModelCache::Get(filters.cad());
  std::vector<double> lengths(model->count(1), 0);
  for (vtkIdType cell = 0; cell < boundary->GetNumberOfCells(); ++cell)
  {
    ASSERT_EQ(boundary->GetCellType(cell), VTK_LINE);
    const EntityId entity = entityOf(boundary, cell);
    const Point3 middle = centroidOf(boundary, cell);
    if (entity)
    {
      ASSERT_EQ(entity.dimension, 1);
      EXPECT_LE(model->nearestOn(entity, middle).distance, nearestOfAll(*model, 1, middle) + 1e-9);
      lengths[entity.index] += std::sqrt(boundary->GetCell(cell)->GetLength2());
    }
    else
    {
      EXPECT_GT(nearestOfAll(*model, 1, middle), 0.1) << "the outer square";
    }
  }
  for (int edge = 0; edge < model->count(1); ++edge)
  {
    const double length = model->measure({ 1, edge });
    EXPECT_LT(lengths[edge], length);
    EXPECT_GT(lengths[edge], 0.98 * length) << "chords of all of the arc";
  }
}

/// Arrays and ids come along: those of points, and those of the cell behind a facet.
TEST(CADBoundary, keepsTheArraysOfTheMesh)
{
  const cadtest::TemporaryFolder folder;
  const cadtest::FilterRun filters(cadtest::writeInto(folder, cadtest::sphere(2), ".step"));
  const auto coarse = cadtest::toGrid(cadtest::ballMesh(2, 0.03));
  cadtest::addArrays(coarse);
  cadtest::addGlobalIds(coarse);
  const auto mesh = filters.measure(filters.project(coarse), 1);
  const auto boundary = boundaryOf(filters, mesh);
  vtkDataArray* const errors = boundary->GetCellData()->GetArray("GeometricError");
  vtkDataArray* const tags = boundary->GetCellData()->GetArray("Tag");
  ASSERT_TRUE(errors && tags);
  for (vtkIdType cell = 0; cell < boundary->GetNumberOfCells(); ++cell)
  {
    EXPECT_GT(errors->GetTuple1(cell), 0);
    const auto parent = static_cast<vtkIdType>(tags->GetTuple1(cell));
    const vtkSmartPointer<vtkCell> behind = mesh->GetCell(parent);
    for (const vtkIdType vertex : *boundary->GetCell(cell)->GetPointIds())
    {
      double corner[3];
      boundary->GetPoint(vertex, corner);
      const vtkIdType point = mesh->FindPoint(corner);
      EXPECT_TRUE(behind->GetPointIds()->IsId(point) >= 0);
      for (const char* name : { "Linear", "CADEntity", "CADDistance" })
      {
        EXPECT_EQ(boundary->GetPointData()->GetArray(name)->GetTuple1(vertex),
          mesh->GetPointData()->GetArray(name)->GetTuple1(point));
      }
      EXPECT_EQ(boundary->GetPointData()->GetGlobalIds()->GetTuple1(vertex),
        mesh->GetPointData()->GetGlobalIds()->GetTuple1(point));
    }
  }
}

/// Two squares of an IGES file, one of them red and with a name.
TEST(CADBoundary, hasTheNamesAndColoursOfTheFile)
{
  const cadtest::TemporaryFolder folder;
  cadtest::IgesWriter file;
  cadtest::IgesAttributes deck;
  deck.label = "DECK";
  deck.colour = 2;
  cadtest::addSquare(file, { 0, 0, 0 }, deck);
  cadtest::addSquare(file, { 0, 0, 1 }, {});
  file.write(folder.file("squares.igs"));
  const cadtest::FilterRun filters(folder.file("squares.igs"));
  const auto squares = cadtest::toPolyData(cadtest::twoSquaresMesh());
  const auto boundary = boundaryOf(filters, filters.project(squares));
  ASSERT_EQ(boundary->GetNumberOfCells(), 4);
  auto* const names =
    vtkStringArray::SafeDownCast(boundary->GetCellData()->GetAbstractArray("CADName"));
  auto* const colours =
    vtkUnsignedCharArray::SafeDownCast(boundary->GetCellData()->GetArray("CADColor"));
  ASSERT_TRUE(names && colours);
  for (vtkIdType cell = 0; cell < 4; ++cell)
  {
    const bool onDeck = centroidOf(boundary, cell)[2] < 0.5;
    EXPECT_EQ(names->GetValue(cell), onDeck ? "DECK" : "");
    EXPECT_EQ(colours->GetTypedComponent(cell, 0), 255);
    EXPECT_EQ(colours->GetTypedComponent(cell, 1), onDeck ? 0 : 255);
  }
}

/// Of a part with a cavity: on one face, on all but one, and on one where no facet is.
TEST(CADBoundary, takesFacets)
{
  const cadtest::TemporaryFolder folder;
  const cadtest::FilterRun filters(cadtest::writeInto(folder, cadtest::partWithCavity(), ".step"));
  const auto projected = filters.project(cadtest::readGrid(CADREFINE_DATA "/part_coarse.vtu"));
  const auto whole = boundaryOf(filters, projected);
  const auto facetsOf = [](vtkPointSet* boundary, auto isWanted)
  {
    std::set<std::vector<double>> facets;
    for (vtkIdType cell = 0; cell < boundary->GetNumberOfCells(); ++cell)
    {
      const EntityId entity = entityOf(boundary, cell);
      const Vector3 centroid = centroidOf(boundary, cell);
      if (isWanted(entity))
      {
        facets.insert({ centroid[0], centroid[1], centroid[2], 1.0 * entity.index });
      }
    }
    return facets;
  };
  const auto with = [&](const char* face)
  {
    return filters.attempt<vtkCADBoundary>(
      projected, [&](vtkCADBoundary* filter) { filter->AddFace(face); });
  };
  const auto all = [](EntityId) { return true; };
  for (const bool excluded : { false, true })
  {
    const auto chosen = with(excluded ? "!1" : "1");
    ASSERT_TRUE(chosen.succeeded);
    const auto expected =
      facetsOf(whole, [&](EntityId entity) { return entity && (entity.index == 1) != excluded; });
    EXPECT_GT(expected.size(), 0u);
    EXPECT_EQ(facetsOf(chosen.pointSet(), all), expected);
    EXPECT_EQ(chosen.pointSet()->GetNumberOfCells(), static_cast<vtkIdType>(expected.size()));
  }
  EXPECT_EQ(facetsOf(with("*").pointSet(), all),
    facetsOf(whole, [](EntityId entity) { return bool(entity); })); // which have no names
  const auto none = filters.attempt<vtkCADBoundary>(
    filters.run<vtkProjectOntoCAD>(cadtest::readGrid(CADREFINE_DATA "/part_coarse.vtu"),
      [](vtkProjectOntoCAD* filter) { filter->AddFace("0"); }),
    [](vtkCADBoundary* filter) { filter->AddFace("1"); });
  EXPECT_FALSE(none.succeeded);
  ASSERT_EQ(none.errors.size(), 1u);
  EXPECT_NE(none.errors[0].find("no boundary facet lies on"), std::string::npos) << none.errors[0];
}

/// A ball in a shell: the triangles between the two, which the mesh lists, lie on the sphere; those
/// of the outer border do not lie on the CAD.
TEST(CADBoundary, hasListedFacetsBetweenMaterials)
{
  constexpr double radius = 2;
  const cadtest::TemporaryFolder folder;
  const cadtest::FilterRun filters(cadtest::writeInto(folder, cadtest::sphere(radius), ".step"));
  const Mesh mesh = cadtest::ballInShellMesh(radius, 0.03);
  const auto boundary = boundaryOf(filters, filters.project(cadtest::toGrid(mesh)));
  std::size_t onSphere = 0;
  for (vtkIdType cell = 0; cell < boundary->GetNumberOfCells(); ++cell)
  {
    const bool inside = norm(centroidOf(boundary, cell)) < 1.5 * radius;
    EXPECT_EQ(entityOf(boundary, cell), (inside ? EntityId{ 2, 0 } : EntityId{}));
    onSphere += inside;
  }
  EXPECT_EQ(onSphere, mesh.triangles.size());
  EXPECT_EQ(boundary->GetNumberOfCells() - onSphere, cadtest::countOuterSides(mesh));
}

TEST(CADBoundary, needsAProjectedMesh)
{
  const cadtest::TemporaryFolder folder;
  const cadtest::FilterRun filters(cadtest::writeInto(folder, cadtest::sphere(2), ".step"));
  const auto outcome = filters.attempt<vtkCADBoundary>(
    cadtest::toGrid(cadtest::ballMesh(2, 0.03)), [](vtkCADBoundary*) {});
  EXPECT_FALSE(outcome.succeeded);
  ASSERT_EQ(outcome.errors.size(), 1u);
  EXPECT_NE(outcome.errors[0].find("CADDimension"), std::string::npos) << outcome.errors[0];
}

/// Ids of the points of a cell, ascending.
std::vector<vtkIdType> pointIdsOf(vtkPointSet* mesh, vtkIdType cell)
{
  vtkDataArray* const ids = mesh->GetPointData()->GetGlobalIds();
  std::vector<vtkIdType> result;
  for (const vtkIdType point : *mesh->GetCell(cell)->GetPointIds())
  {
    result.push_back(static_cast<vtkIdType>(ids->GetTuple1(point)));
  }
  std::sort(result.begin(), result.end());
  return result;
}

std::map<std::vector<vtkIdType>, EntityId> entitiesByPoints(vtkPointSet* mesh, int dimension)
{
  std::map<std::vector<vtkIdType>, EntityId> result;
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
  {
    if (mesh->GetCell(cell)->GetCellDimension() == dimension)
    {
      EXPECT_TRUE(result.emplace(pointIdsOf(mesh, cell), entityOf(mesh, cell)).second)
        << "cell " << cell << " is there twice";
    }
  }
  return result;
}

/// Cells of this dimension, with all of their arrays and their ids.
std::string describeCells(vtkPointSet* mesh, int dimension, const std::set<std::string>& arrays)
{
  std::ostringstream text;
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
  {
    if (mesh->GetCell(cell)->GetCellDimension() == dimension)
    {
      for (const vtkIdType point : *mesh->GetCell(cell)->GetPointIds())
      {
        text << point << " ";
      }
      for (const std::string& name : arrays)
      {
        text << mesh->GetCellData()->GetArray(name.c_str())->GetTuple1(cell) << " ";
      }
      text << mesh->GetCellData()->GetGlobalIds()->GetTuple1(cell) << "\n";
    }
  }
  return text.str();
}

struct BoundaryCells : testing::Test
{
  cadtest::TemporaryFolder folder;

  /// The projected mesh, measured with and without cells of its boundary: these are those of CAD
  /// Boundary, all else is the same.
  static void expectFacetsBesideCells(const cadtest::FilterRun& filters, vtkPointSet* coarse)
  {
    cadtest::addArrays(coarse);
    const auto projected = filters.project(coarse);
    const auto plain = filters.measure(projected, 1);
    const auto mesh = filters.run<vtkCADGeometricError>(projected,
      [](vtkCADGeometricError* filter)
      {
        filter->SetRecursionDepth(1);
        filter->SetBoundaryCells(true);
      });
    const int dimension = cadtest::toMesh(plain).dimension;
    const std::set<std::string> arrays{ "GeometricError", "GeometricDistance", "Tag" };
    EXPECT_EQ(describeCells(mesh, dimension, arrays), describeCells(plain, dimension, arrays));
    EXPECT_EQ(entitiesByPoints(mesh, dimension - 1),
      entitiesByPoints(boundaryOf(filters, plain), dimension - 1));
    for (const char* name : { "GlobalGeometricError", "GlobalCells", "InvalidCells" })
    {
      EXPECT_EQ(cadtest::fieldValue(mesh, name), cadtest::fieldValue(plain, name)) << name;
    }
    std::set<double> ids;
    for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
    {
      EXPECT_TRUE(ids.insert(mesh->GetCellData()->GetGlobalIds()->GetTuple1(cell)).second);
      if (mesh->GetCell(cell)->GetCellDimension() < dimension)
      {
        EXPECT_EQ(mesh->GetCellData()->GetArray("GeometricError")->GetTuple1(cell), 0);
        EXPECT_EQ(mesh->GetCellData()->GetArray("Tag")->GetTuple1(cell), 0);
      }
      else
      {
        EXPECT_EQ(entityOf(mesh, cell), EntityId{});
      }
    }
  }
};

TEST_F(BoundaryCells, areTheFacetsOfTetrahedra)
{
  expectFacetsBesideCells(
    cadtest::FilterRun(cadtest::writeInto(folder, cadtest::partWithCavity(), ".step")),
    cadtest::readGrid(CADREFINE_DATA "/part_coarse.vtu"));
}

TEST_F(BoundaryCells, areTheSegmentsInThePlane)
{
  expectFacetsBesideCells(cadtest::FilterRun(CADREFINE_DATA "/three_arcs.igs"),
    cadtest::readGrid(CADREFINE_DATA "/three_arcs_coarse.vtu"));
}

/// Of a surface the cells themselves.
TEST_F(BoundaryCells, ofASurfaceAreItsTriangles)
{
  const cadtest::FilterRun filters(cadtest::writeInto(folder, cadtest::sphere(2), ".step"));
  const auto surface = cadtest::toPolyData(cadtest::sphereMesh(2, 0.03));
  const auto mesh = filters.run<vtkProjectOntoCAD>(
    surface, [](vtkProjectOntoCAD* filter) { filter->SetBoundaryCells(true); });
  ASSERT_EQ(mesh->GetNumberOfCells(), surface->GetNumberOfCells());
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
  {
    EXPECT_EQ(entityOf(mesh, cell), (EntityId{ 2, 0 }));
  }
}

/// A cell that the mesh lists is no second time there, keeps its tag, and knows its face; so do its
/// children.
TEST_F(BoundaryCells, keepListedCells)
{
  const cadtest::FilterRun filters(cadtest::writeInto(folder, cadtest::sphere(2), ".step"));
  const Mesh listed = cadtest::ballInShellMesh(2, 0.03);
  const auto coarse = cadtest::toGrid(listed);
  cadtest::addArrays(coarse);
  const auto mesh = filters.run<vtkAdaptToCAD>(coarse,
    [](vtkAdaptToCAD* filter)
    {
      filter->SetUniformSteps(1);
      filter->SetMaximumSteps(0);
      filter->SetBoundaryCells(true);
    });
  const auto entities = entitiesByPoints(mesh, 2);
  EXPECT_EQ(entities.size(), 4 * (listed.triangles.size() + cadtest::countOuterSides(listed)));
  std::size_t onSphere = 0;
  std::size_t tagged = 0;
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
  {
    if (mesh->GetCell(cell)->GetCellDimension() == 2)
    {
      const bool inside = norm(centroidOf(mesh, cell)) < 3;
      EXPECT_EQ(entityOf(mesh, cell), (inside ? EntityId{ 2, 0 } : EntityId{}));
      onSphere += inside;
      tagged += inside && mesh->GetCellData()->GetArray("Tag")->GetTuple1(cell) <
                            static_cast<double>(listed.triangles.size());
    }
  }
  EXPECT_EQ(onSphere, 4 * listed.triangles.size());
  EXPECT_EQ(tagged, onSphere) << "tags are the numbers of the cells, triangles first";
}

/// Beside quadratic cells: with the mid nodes of these.
TEST_F(BoundaryCells, areQuadraticBesideSuch)
{
  const cadtest::FilterRun filters(cadtest::writeInto(folder, cadtest::sphere(2), ".step"));
  const auto mesh = filters.run<vtkAdaptToCAD>(cadtest::toGrid(cadtest::ballMesh(2, 0.03)),
    [](vtkAdaptToCAD* filter)
    {
      filter->SetMaximumSteps(0);
      filter->SetQuadraticCells(true);
      filter->SetBoundaryCells(true);
    });
  std::set<std::vector<vtkIdType>> outer; // of those of cells that are met once
  std::set<std::vector<vtkIdType>> cells;
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
  {
    const vtkSmartPointer<vtkCell> current = mesh->GetCell(cell);
    for (int face = 0; face < current->GetNumberOfFaces(); ++face)
    {
      vtkIdList* const points = current->GetFace(face)->GetPointIds();
      std::vector<vtkIdType> key(points->begin(), points->end());
      std::sort(key.begin(), key.end());
      const auto [place, isNew] = outer.insert(key);
      if (!isNew)
      {
        outer.erase(place);
      }
    }
    if (current->GetCellDimension() == 2)
    {
      ASSERT_EQ(current->GetCellType(), VTK_QUADRATIC_TRIANGLE);
      std::vector<vtkIdType> key(current->GetPointIds()->begin(), current->GetPointIds()->end());
      std::sort(key.begin(), key.end());
      cells.insert(key);
    }
  }
  EXPECT_GT(cells.size(), 0u);
  EXPECT_EQ(cells, outer);
}

} // namespace
