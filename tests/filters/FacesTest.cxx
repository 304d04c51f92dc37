// The property Faces: what filters do on some faces of the CAD alone.

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
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

namespace
{

using namespace cadrefine;
using Data = cadtest::FilterRun::Data;
using Names = std::vector<std::string>;

/// A box with a spherical cavity and a drilled hole.
struct Faces : testing::Test
{
  cadtest::TemporaryFolder folder;
  cadtest::FilterRun filters{ cadtest::writeInto(folder, cadtest::partWithCavity(), ".step") };
  Data coarse = cadtest::readGrid(CADREFINE_DATA "/part_coarse.vtu");
  int faceCount = vtkCADModelCache::Get(filters.cad())->count(2);

  template<class Filter>
  static void choose(Filter* filter, const Names& faces)
  {
    for (const std::string& face : faces)
    {
      filter->AddFace(face.c_str());
    }
  }

  Data project(const Names& faces) const
  {
    return filters.run<vtkProjectOntoCAD>(
      coarse, [&](vtkProjectOntoCAD* filter) { choose(filter, faces); });
  }

  Data measure(vtkPointSet* mesh, const Names& faces) const
  {
    return filters.run<vtkCADGeometricError>(mesh,
      [&](vtkCADGeometricError* filter)
      {
        filter->SetRecursionDepth(1);
        choose(filter, faces);
      });
  }

  /// Number of the face of each facet, and its points.
  struct Facet
  {
    int face;
    std::set<vtkIdType> points;
  };

  /// Of a mesh that was projected wholly; points by their numbers in it.
  std::vector<Facet> facetsOf(vtkPointSet* mesh) const
  {
    const auto boundary = filters.run<vtkCADBoundary>(mesh, [](vtkCADBoundary*) {});
    std::vector<Facet> facets;
    for (vtkIdType cell = 0; cell < boundary->GetNumberOfCells(); ++cell)
    {
      Facet& facet = facets.emplace_back();
      facet.face =
        static_cast<int>(boundary->GetCellData()->GetArray("CADEntity")->GetTuple1(cell));
      for (const vtkIdType point : *boundary->GetCell(cell)->GetPointIds())
      {
        facet.points.insert(mesh->FindPoint(boundary->GetPoint(point)));
      }
    }
    return facets;
  }

  /// Adds a cell array: `value` of the cells with a facet on the face, 0 of others.
  template<class Value>
  void addAtFace(vtkPointSet* mesh, const char* name, int face, const Value& value) const
  {
    vtkNew<vtkDoubleArray> array;
    array->SetName(name);
    array->SetNumberOfValues(mesh->GetNumberOfCells());
    array->FillValue(0);
    for (const Facet& facet : facetsOf(mesh))
    {
      for (vtkIdType cell = 0; facet.face == face && cell < mesh->GetNumberOfCells(); ++cell)
      {
        std::size_t inside = 0;
        for (const vtkIdType point : *mesh->GetCell(cell)->GetPointIds())
        {
          inside += facet.points.count(point);
        }
        if (inside == 3)
        {
          array->SetValue(cell, value(cell));
        }
      }
    }
    mesh->GetCellData()->AddArray(array);
  }

  /// The chosen face has a curved surface: the cavity.
  int curvedFace(vtkPointSet* projected) const
  {
    int best = -1;
    double largest = 0;
    for (int face = 0; face < faceCount; ++face)
    {
      const double error =
        cadtest::fieldValue(measure(projected, { std::to_string(face) }), "GlobalGeometricError");
      best = error > largest ? face : best;
      largest = std::max(largest, error);
    }
    return best;
  }

  std::string messageOf(const Names& faces) const
  {
    const auto outcome = filters.attempt<vtkProjectOntoCAD>(
      coarse, [&](vtkProjectOntoCAD* filter) { choose(filter, faces); });
    EXPECT_FALSE(outcome.succeeded);
    return outcome.errors.size() == 1 ? outcome.errors.front() : "no or many messages";
  }
};

/// Vertices of facets on the face go where they go without a choice, others stay.
TEST_F(Faces, areProjectedAlone)
{
  const auto whole = project({});
  for (const int face : { 0, curvedFace(whole) })
  {
    SCOPED_TRACE(face);
    std::set<vtkIdType> onFace;
    for (const Facet& facet : facetsOf(whole))
    {
      if (facet.face == face)
      {
        onFace.insert(facet.points.begin(), facet.points.end());
      }
    }
    const auto mesh = project({ std::to_string(face) });
    vtkDataArray* const dimensions = mesh->GetPointData()->GetArray("CADDimension");
    vtkDataArray* const entities = mesh->GetPointData()->GetArray("CADEntity");
    vtkDataArray* const wholeEntities = whole->GetPointData()->GetArray("CADEntity");
    ASSERT_GT(onFace.size(), 3u);
    for (vtkIdType point = 0; point < mesh->GetNumberOfPoints(); ++point)
    {
      EXPECT_EQ(dimensions->GetTuple1(point) >= 0, onFace.count(point) > 0) << point;
      if (onFace.count(point))
      {
        EXPECT_EQ(entities->GetTuple1(point), wholeEntities->GetTuple1(point)) << point;
      }
      for (int k = 0; k < 3; ++k)
      {
        EXPECT_EQ(
          mesh->GetPoint(point)[k], (onFace.count(point) ? whole : coarse)->GetPoint(point)[k])
          << point;
      }
    }
  }
}

/// The errors on each face alone add up to that on all.
TEST_F(Faces, areMeasuredAlone)
{
  const auto projected = project({});
  double sum = 0;
  for (int face = 0; face < faceCount; ++face)
  {
    sum +=
      cadtest::fieldValue(measure(projected, { std::to_string(face) }), "GlobalGeometricError");
  }
  const double all = cadtest::fieldValue(measure(projected, {}), "GlobalGeometricError");
  EXPECT_NEAR(sum, all, 1e-12 * all);
  const int curved = curvedFace(projected);
  const std::string name = std::to_string(curved);
  const double without =
    cadtest::fieldValue(measure(projected, { "!" + name }), "GlobalGeometricError");
  const double alone = cadtest::fieldValue(measure(projected, { name }), "GlobalGeometricError");
  EXPECT_GT(alone, 0);
  EXPECT_NEAR(without + alone, all, 1e-12 * all) << "all but one";
}

/// The same mesh as by an array that marks the cells there.
TEST_F(Faces, tellWhichCellsAreRefined)
{
  const auto projected = project({});
  const int curved = curvedFace(projected);
  addAtFace(projected, "There", curved, [](vtkIdType) { return 1.0; });
  const auto byFaces = filters.run<vtkRefineWithCAD>(
    projected, [&](vtkRefineWithCAD* filter) { filter->AddFace(std::to_string(curved).c_str()); });
  const auto byArray = filters.run<vtkRefineWithCAD>(
    projected, [&](vtkRefineWithCAD* filter) { filter->SetMarkingArray("There"); });
  EXPECT_TRUE(cadtest::areSame(byFaces, byArray));
  EXPECT_GT(byFaces->GetNumberOfCells(), projected->GetNumberOfCells());
  EXPECT_LT(byFaces->GetNumberOfCells(),
    filters.refineWhereErrorExceeds(measure(projected, {}), -1)->GetNumberOfCells());
}

/// A chord tolerance of a face: the same as by an array of the chord errors there.
TEST_F(Faces, haveChordTolerancesOfTheirOwn)
{
  const auto projected = measure(project({}), {});
  const int curved = curvedFace(projected);
  vtkDataArray* const chords = projected->GetCellData()->GetArray("ChordError");
  addAtFace(projected, "Chords", curved, [&](vtkIdType cell) { return chords->GetTuple1(cell); });
  const double tolerance = 0.5 * chords->GetRange()[1];
  const auto byFaces = filters.run<vtkRefineWithCAD>(projected, [&](vtkRefineWithCAD* filter)
    { filter->AddFace((std::to_string(curved) + "=" + std::to_string(tolerance)).c_str()); });
  const auto byArray = filters.run<vtkRefineWithCAD>(projected,
    [&](vtkRefineWithCAD* filter)
    {
      filter->SetMarkingArray("Chords");
      filter->SetThreshold(std::stod(std::to_string(tolerance)));
    });
  EXPECT_TRUE(cadtest::areSame(byFaces, byArray));
  EXPECT_GT(byFaces->GetNumberOfCells(), projected->GetNumberOfCells());
}

/// Adapt To CAD goes on until each face keeps to its tolerance, and leaves others alone.
TEST_F(Faces, areAdaptedToTheirTolerances)
{
  const int curved = curvedFace(project({}));
  constexpr double tolerance = 0.004;
  const auto outcome = filters.attempt<vtkAdaptToCAD>(coarse,
    [&](vtkAdaptToCAD* filter)
    {
      filter->AddFace((std::to_string(curved) + "=0.004").c_str());
      filter->SetErrorMarking(vtkAdaptToCAD::OFF);
      filter->SetMaximumSteps(20);
    });
  ASSERT_TRUE(outcome.succeeded);
  const auto mesh = outcome.pointSet();
  EXPECT_LE(cadtest::fieldValue(mesh, "MaximumChordError"), tolerance);
  EXPECT_NE(
    vtkPointSet::SafeDownCast(outcome.output)->GetNumberOfCells(), coarse->GetNumberOfCells());
  const auto columns = cadtest::columnsOf(outcome.secondOutput);
  EXPECT_LT(columns.at("Step").size(), 21u);
  const std::string reason = outcome.secondOutput->GetFieldData()
                               ->GetAbstractArray("StopReason")
                               ->GetVariantValue(0)
                               .ToString();
  EXPECT_NE(reason.find("tolerance of its face"), std::string::npos) << reason;
}

TEST_F(Faces, thatAreNotThereAreErrors)
{
  EXPECT_NE(
    messageOf({ "wing" }).find("Faces: the CAD has no face \"wing\"; it has"), std::string::npos)
    << messageOf({ "wing" });
  EXPECT_NE(messageOf({ std::to_string(faceCount) }).find("numbers 0 to"), std::string::npos);
  for (const char* entry : { "0=", "0=-1", "0=thin", "0=0", "0=inf", "!0=1" })
  {
    EXPECT_NE(
      messageOf({ entry }).find("\"=\" must be followed by a chord tolerance"), std::string::npos)
      << messageOf({ entry });
  }
  EXPECT_NE(messageOf({ "!*", "!0" }).find("Faces"), std::string::npos);
}

/// Two squares of an IGES file, one over the other.
TEST(FaceNames, arePatternsAndNumbers)
{
  const cadtest::TemporaryFolder folder;
  cadtest::IgesWriter file;
  cadtest::IgesAttributes attributes;
  attributes.label = "DECK";
  cadtest::addSquare(file, { 0, 0, 0 }, attributes);
  attributes.label = "KEEL";
  cadtest::addSquare(file, { 0, 0, 1 }, attributes);
  file.write(folder.file("squares.igs"));
  const cadtest::FilterRun filters(folder.file("squares.igs"));
  const auto squares = cadtest::toPolyData(cadtest::twoSquaresMesh());
  const auto projectedOn = [&](const Names& faces)
  {
    const auto projected = filters.run<vtkProjectOntoCAD>(
      squares, [&](vtkProjectOntoCAD* filter) { Faces::choose(filter, faces); });
    std::string found;
    for (const vtkIdType point : { 0, 4 })
    {
      found +=
        projected->GetPointData()->GetArray("CADDimension")->GetTuple1(point) >= 0 ? "x" : "-";
    }
    return found;
  };
  const bool deckFirst = vtkCADModelCache::Get(filters.cad())->attributes({ 2, 0 }).name == "DECK";
  for (const auto& [faces, expected] : std::vector<std::pair<Names, std::string>>{ { {}, "xx" },
         { { "DECK" }, "x-" }, { { "D*" }, "x-" }, { { "?EE[A-L]" }, "-x" }, { { "!D*" }, "-x" },
         { { "*", "!KEEL" }, "x-" }, { { "DECK", "KEEL" }, "xx" }, { { "*" }, "xx" },
         { { deckFirst ? "0" : "1" }, "x-" }, { { "KEEL=0.1" }, "-x" } })
  {
    EXPECT_EQ(projectedOn(faces), expected) << testing::PrintToString(faces);
  }
}

/// In the plane they are edges.
TEST(FaceNames, areEdgesInThePlane)
{
  const cadtest::FilterRun filters(CADREFINE_DATA "/three_arcs.igs");
  const auto coarse = cadtest::readGrid(CADREFINE_DATA "/three_arcs_coarse.vtu");
  const int edges = vtkCADModelCache::Get(filters.cad())->count(1);
  const auto errorOf = [&](const Names& names)
  {
    return cadtest::fieldValue(filters.run<vtkCADGeometricError>(filters.project(coarse),
                                 [&](vtkCADGeometricError* filter)
                                 {
                                   filter->SetRecursionDepth(1);
                                   Faces::choose(filter, names);
                                 }),
      "GlobalGeometricError");
  };
  double sum = 0;
  for (int edge = 0; edge < edges; ++edge)
  {
    sum += errorOf({ std::to_string(edge) });
  }
  EXPECT_GT(sum, 0);
  EXPECT_NEAR(sum, errorOf({}), 1e-12 * sum);
  const auto mesh =
    filters.run<vtkProjectOntoCAD>(coarse, [](vtkProjectOntoCAD* filter) { filter->AddFace("0"); });
  vtkDataArray* const dimensions = mesh->GetPointData()->GetArray("CADDimension");
  vtkDataArray* const entities = mesh->GetPointData()->GetArray("CADEntity");
  int onEdge = 0;
  for (vtkIdType point = 0; point < mesh->GetNumberOfPoints(); ++point)
  {
    if (dimensions->GetTuple1(point) == 1)
    {
      EXPECT_EQ(entities->GetTuple1(point), 0);
      ++onEdge;
    }
  }
  EXPECT_GT(onEdge, 0);
}

} // namespace
