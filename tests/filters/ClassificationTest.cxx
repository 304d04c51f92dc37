// Entities of the boundary nodes of meshes by gmsh, which knows them, after the nodes were moved by
// up to 5% of the length of their edges, or by what the digits of files make of them (see
// tests/support/gmsh_truth.py).

#include "DataSets.h"
#include "FilterRun.h"
#include "MeshChecks.h"
#include "TestMeshes.h"
#include "TestShapes.h"
#include "vtkCADModelCache.h"

#include <cadrefine/cad/model/CADModel.h>

#include <gtest/gtest.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>

#include <cmath>
#include <iostream>
#include <map>
#include <numeric>
#include <ostream>
#include <random>
#include <set>
#include <sstream>
#include <stdexcept>

namespace
{

using namespace cadrefine;

std::string textOf(EntityId entity)
{
  std::ostringstream text;
  text << "(" << static_cast<int>(entity.dimension) << ", " << entity.index << ")";
  return text.str();
}

/// The entity of this dimension on which a point lies, or none.
EntityId entityAt(const CADModel& model, const Point3& point, int dimension)
{
  SearchScope scope;
  scope.maximumDistance = 1e-6 * model.size();
  scope.faces = dimension == 2;
  scope.edges = dimension == 1;
  scope.sharpEdges = dimension == 1;
  scope.vertices = dimension == 0;
  return model.nearest(point, scope).entity;
}

/// Where each point of a mesh belongs according to gmsh, in entities of our model: to each entity
/// of gmsh's that has a node belongs one of ours, and to that no other one.
std::vector<EntityId> findTruth(const CADModel& model, vtkPointSet* mesh)
{
  vtkDataArray* dimensions = mesh->GetPointData()->GetArray("TruthDimension");
  vtkDataArray* tags = mesh->GetPointData()->GetArray("TruthTag");
  vtkDataArray* exact = mesh->GetPointData()->GetArray("ExactPosition");
  std::map<EntityId, EntityId> oursOf;
  std::map<EntityId, EntityId> theirsOf;
  std::vector<EntityId> truth(static_cast<std::size_t>(mesh->GetNumberOfPoints()));
  for (vtkIdType p = 0; p < mesh->GetNumberOfPoints(); ++p)
  {
    const EntityId theirs{ static_cast<std::int8_t>(dimensions->GetTuple1(p)),
      static_cast<std::int32_t>(tags->GetTuple1(p)) };
    if (theirs.dimension == 3)
    {
      continue;
    }
    Point3 point;
    exact->GetTuple(p, point.data());
    const EntityId ours = entityAt(model, point, theirs.dimension);
    truth[static_cast<std::size_t>(p)] = ours;
    if (oursOf.emplace(theirs, ours).first->second != ours ||
        (ours && theirsOf.emplace(ours, theirs).first->second != theirs))
    {
      throw std::runtime_error("not one to one: " + textOf(theirs) + " and " + textOf(ours));
    }
  }
  return truth;
}

std::vector<EntityId> entitiesOf(vtkPointSet* mesh)
{
  vtkDataArray* dimensions = mesh->GetPointData()->GetArray("CADDimension");
  vtkDataArray* indices = mesh->GetPointData()->GetArray("CADEntity");
  std::vector<EntityId> entities;
  for (vtkIdType p = 0; p < mesh->GetNumberOfPoints(); ++p)
  {
    entities.push_back({ static_cast<std::int8_t>(dimensions->GetTuple1(p)),
      static_cast<std::int32_t>(indices->GetTuple1(p)) });
  }
  return entities;
}

/// What was found for the nodes of a mesh, against the truth.
struct Comparison
{
  std::size_t nodes = 0; ///< Of entities, or found to be on one.
  std::size_t right = 0;
  std::set<EntityId> vertices; ///< CAD vertices that have a node.
  std::set<EntityId> verticesFound;
  std::map<std::pair<EntityId, EntityId>, std::size_t> wrong; ///< How often (truth, found).
  std::size_t guessed = 0; ///< Wrong ones that are not reported as a conflict.
};

Comparison compare(const std::vector<EntityId>& truth, vtkPointSet* projected)
{
  const auto found = entitiesOf(projected);
  vtkDataArray* conflicts = projected->GetPointData()->GetArray("CADConflict");
  Comparison result;
  for (std::size_t p = 0; p < truth.size(); ++p)
  {
    if (!truth[p] && !found[p])
    {
      continue;
    }
    ++result.nodes;
    const bool right = truth[p] == found[p];
    result.right += right;
    if (truth[p].dimension == 0)
    {
      result.vertices.insert(truth[p]);
      if (right)
      {
        result.verticesFound.insert(truth[p]);
      }
    }
    if (!right)
    {
      ++result.wrong[{ truth[p], found[p] }];
      result.guessed += conflicts->GetTuple1(static_cast<vtkIdType>(p)) == 0;
    }
  }
  return result;
}

void print(const std::string& name, const Comparison& comparison)
{
  std::cout << name << ": " << comparison.right << " of " << comparison.nodes << " nodes right, "
            << comparison.verticesFound.size() << " of " << comparison.vertices.size()
            << " CAD vertices, " << comparison.guessed << " guessed\n";
  for (const auto& [entities, count] : comparison.wrong)
  {
    std::cout << "  " << textOf(entities.first) << " taken for " << textOf(entities.second) << ": "
              << count << "\n";
  }
}

class Classification : public testing::TestWithParam<std::tuple<const char*, const char*>>
{
};

INSTANTIATE_TEST_SUITE_P(Gmsh, Classification,
  testing::Combine(testing::Values("box_minus_cylinder", "two_cones", "filleted_box",
                     "half_cylinder", "torus_segment", "naca_section", "thin_wing"),
    testing::Values("coarse", "fine")),
  [](const auto& test)
  { return std::string(std::get<0>(test.param)) + "_" + std::get<1>(test.param); });

TEST_P(Classification, recoversTheEntitiesOfTheNodes)
{
  const auto [solid, size] = GetParam();
  const std::string path = std::string(CADREFINE_TRUTH) + "/" + solid;
  const cadtest::FilterRun filters(path + ".brep");
  const auto model = vtkCADModelCache::Get(filters.cad());
  const auto mesh = cadtest::readGrid(path + "_" + size + ".vtu");
  const auto projected = filters.moveOntoCAD(mesh);
  const Comparison comparison = compare(findTruth(*model, mesh), projected);
  print(std::string(solid) + ", " + size, comparison);
  EXPECT_GE(comparison.right, 0.999 * comparison.nodes);
  EXPECT_EQ(comparison.verticesFound, comparison.vertices);
  EXPECT_EQ(comparison.guessed, 0u) << "what is left is in conflict";
  EXPECT_EQ(cadtest::fieldValue(projected, "UnprojectedVertices"), 0);
}

/// A trailing edge that is thinner than its nodes are moved: cells are inverted, and where nodes
/// belong cannot be told for all.
class ThinnerThanTheMoves : public testing::TestWithParam<std::tuple<const char*, int>>
{
};

INSTANTIATE_TEST_SUITE_P(Gmsh, ThinnerThanTheMoves,
  testing::Combine(testing::Values("coarse", "medium", "fine"), testing::Values(1, 2, 3)),
  [](const auto& test)
  { return std::string(std::get<0>(test.param)) + std::to_string(std::get<1>(test.param)); });

TEST_P(ThinnerThanTheMoves, whatIsWrongIsInConflict)
{
  const auto [size, seed] = GetParam();
  const std::string path = std::string(CADREFINE_TRUTH) + "/blunt_wing";
  const cadtest::FilterRun filters(path + ".brep");
  const auto model = vtkCADModelCache::Get(filters.cad());
  const auto mesh = cadtest::readGrid(path + "_" + size + "_" + std::to_string(seed) + ".vtu");
  const auto projected = filters.moveOntoCAD(mesh);
  const Comparison comparison = compare(findTruth(*model, mesh), projected);
  print("blunt_wing, " + std::string(size) + ", " + std::to_string(seed), comparison);
  EXPECT_EQ(comparison.guessed, 0u);
  EXPECT_GE(comparison.right, 0.97 * comparison.nodes);
  const double conflicts = cadtest::fieldValue(projected, "ClassificationConflicts");
  EXPECT_LE(conflicts, 0.06 * comparison.nodes) << "a few beside the trailing edge";
}

struct ExactCase
{
  const char* solid;
  std::string file;
  const char* format; ///< ".igs": the IGES twin of the file that gmsh has meshed.
  double moved;       ///< In parts of the mesh's size.
};

void PrintTo(const ExactCase& tried, std::ostream* out)
{
  *out << tried.file << ", moved " << tried.moved;
}

/// Nodes that gmsh has put onto the CAD, or that lie as close to it as the digits of files let
/// them.
class ExactNodes : public testing::TestWithParam<ExactCase>
{
};

std::vector<ExactCase> exactCases()
{
  const std::string files = "/usr/share/opencascade/data/occ/";
  const std::pair<const char*, std::string> solids[] = { { "bottle", files + "bottle.brep" },
    { "crank_arm", files + "CrankArm.brep" },
    { "blunt_wing", CADREFINE_TRUTH "/blunt_wing.brep" } };
  std::vector<ExactCase> cases;
  for (const auto& [solid, file] : solids)
  {
    for (const char* format : { ".brep", ".igs" })
    {
      cases.push_back({ solid, file, format, 0 });
      cases.push_back({ solid, file, format, 1e-7 });
    }
  }
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Files, ExactNodes, testing::ValuesIn(exactCases()),
  [](const auto& test)
  {
    const ExactCase& each = test.param;
    return std::string(each.solid) + "_" + (each.format + 1) + (each.moved > 0 ? "_moved" : "");
  });

/// Moves each node as far, in a direction of its own.
void moveNodes(vtkPointSet* mesh, double length)
{
  std::mt19937_64 random(1); // NOLINT: the same in every run
  const auto coordinate = [&] { return static_cast<double>(random()) / 9223372036854775808.0 - 1; };
  for (vtkIdType p = 0; p < mesh->GetNumberOfPoints(); ++p)
  {
    Point3 point;
    mesh->GetPoint(p, point.data());
    const double x = coordinate();
    const double y = coordinate();
    point = point + length * normalized({ x, y, coordinate() });
    mesh->GetPoints()->SetPoint(p, point.data());
  }
}

TEST_P(ExactNodes, stayWhereTheyAre)
{
  const ExactCase& each = GetParam();
  const cadtest::TemporaryFolder folder;
  const cadtest::FilterRun filters(
    cadtest::writeInto(folder, cadtest::readShape(each.file), each.format));
  const auto model = vtkCADModelCache::Get(filters.cad());
  const auto mesh = cadtest::readGrid(std::string(CADREFINE_TRUTH) + "/" + each.solid + ".vtu");
  moveNodes(mesh, each.moved * mesh->GetLength());
  const auto projected = filters.moveOntoCAD(mesh);
  const auto found = entitiesOf(projected);
  const auto truth = findTruth(*model, mesh);
  const bool isTwin = std::string(each.format) == ".igs";
  const double tolerance = (each.moved > 0 || isTwin ? 2e-7 : 1e-9) * mesh->GetLength();
  for (vtkIdType p = 0; p < mesh->GetNumberOfPoints(); ++p)
  {
    EXPECT_EQ(textOf(found[p]), textOf(truth[p])) << "node " << p;
    Point3 before;
    Point3 after;
    mesh->GetPoint(p, before.data());
    projected->GetPoint(p, after.data());
    EXPECT_LE(distance(before, after), tolerance) << "node " << p;
  }
}

/// How many vertices each entity has.
std::map<EntityId, int> countEntities(vtkPointSet* mesh)
{
  std::map<EntityId, int> counts;
  for (const EntityId entity : entitiesOf(mesh))
  {
    ++counts[entity];
  }
  return counts;
}

/// The middles of a crease's chords may lie exactly on a face beside it: on the end of a cylinder.
TEST(StraightRefinement, isFoundOnTheCreasesOfTheCoarseMesh)
{
  const std::string path = std::string(CADREFINE_TRUTH) + "/half_cylinder";
  const cadtest::FilterRun filters(path + ".brep");
  const auto mesh = cadtest::readGrid(path + "_fine.vtu");
  mesh->GetPoints()->SetData(mesh->GetPointData()->GetArray("ExactPosition"));
  for (const int levels : { 1, 2 })
  {
    const auto expected = filters.refineUniformly(filters.project(mesh), levels);
    const auto found = filters.project(filters.refineStraight(mesh, levels));
    EXPECT_EQ(countEntities(found), countEntities(expected)) << levels;
    EXPECT_EQ(cadtest::fieldValue(found, "UnprojectedVertices"), 0);
  }
}

/// A dent with three vertices of the CAD, in a corner for which the mesh has but one: the two
/// neighbours that take the others are ends of rows of mesh edges that go on.
TEST(Conflicts, areReportedWhereTheMeshIsTooCoarse)
{
  const cadtest::TemporaryFolder folder;
  const cadtest::FilterRun filters(
    cadtest::writeInto(folder, cadtest::boxWithoutCorner(1, 1, 1, 0.15), ".brep"));
  const auto mesh = cadtest::toGrid(cadtest::cubeMesh(3, 0, 1));
  const auto projected = filters.moveOntoCAD(mesh);
  EXPECT_EQ(cadtest::fieldValue(projected, "ClassificationConflicts"), 3);
  vtkDataArray* conflicts = projected->GetPointData()->GetArray("CADConflict");
  ASSERT_NE(conflicts, nullptr);
  for (vtkIdType p = 0; p < mesh->GetNumberOfPoints(); ++p)
  {
    Point3 before;
    mesh->GetPoint(p, before.data());
    if (norm(before) == 0)
    {
      EXPECT_EQ(conflicts->GetTuple1(p), 1);
    }
    else if (conflicts->GetTuple1(p) != 0)
    {
      EXPECT_NEAR(norm(before), 1.0 / 3, 1e-12);
      EXPECT_EQ(projected->GetPointData()->GetArray("CADDimension")->GetTuple1(p), 0);
    }
  }
}

TEST(Conflicts, areNoneWhereTheMeshIsFineEnough)
{
  const cadtest::TemporaryFolder folder;
  const cadtest::FilterRun filters(cadtest::writeInto(folder, cadtest::box(1, 1, 1), ".brep"));
  const auto projected = filters.project(cadtest::toGrid(cadtest::cubeMesh(3, 0, 1)));
  EXPECT_EQ(cadtest::fieldValue(projected, "ClassificationConflicts"), 0);
}

/// Angles between the normals of two cones and their axis, in degrees: of the upper one, and of the
/// lower one.
using EarCase = std::pair<double, double>;

class Ears : public testing::TestWithParam<EarCase>
{
};

INSTANTIATE_TEST_SUITE_P(
  Cones, Ears, testing::Values(EarCase(70, 70), EarCase(55, 45), EarCase(70, 45)));

/// Two cones base to base, and six points on the circle between them. The upper one has an ear
/// there, a triangle of three of these points, which fits neither cone, or the lower one better:
/// its long side is not on the circle.
TEST_P(Ears, areOnTheFaceBeyondTheirLongSide)
{
  const auto slopeOf = [](double degrees)
  { return std::tan(degrees * 3.14159265358979323846 / 180); };
  const double height = slopeOf(GetParam().first);
  const double depth = slopeOf(GetParam().second);
  Mesh mesh;
  for (const double degrees : { 0, 45, 120, 180, 240, 300 })
  {
    const double angle = degrees * 3.14159265358979323846 / 180;
    mesh.points.push_back({ std::cos(angle), std::sin(angle), 0 });
  }
  const Index top = 6;
  const Index bottom = 7;
  const Index middle = 8;
  mesh.points.insert(mesh.points.end(), { { 0, 0, height }, { 0, 0, -depth }, { 0, 0, -0.5 } });
  mesh.ids.resize(mesh.points.size());
  std::iota(mesh.ids.begin(), mesh.ids.end(), GlobalId{ 0 });
  for (Index k = 0; k < 6; ++k)
  {
    mesh.tetrahedra.push_back({ k, (k + 1) % 6, bottom, middle });
    if (k >= 2)
    {
      mesh.tetrahedra.push_back({ (k + 1) % 6, k, top, middle });
    }
  }
  mesh.tetrahedra.push_back({ 2, 0, top, middle });
  mesh.tetrahedra.push_back({ 0, 2, 1, middle });
  ASSERT_TRUE(cadtest::isValid(mesh));
  const cadtest::TemporaryFolder folder;
  const cadtest::FilterRun filters(
    cadtest::writeInto(folder, cadtest::doubleCone(1, height, depth), ".brep"));
  const auto fine = filters.refineUniformly(filters.project(cadtest::toGrid(mesh)));
  EXPECT_EQ(cadtest::fieldValue(fine, "UnprojectedVertices"), 0);
  vtkDataArray* dimensions = fine->GetPointData()->GetArray("CADDimension");
  int onCircle = 0;
  for (vtkIdType p = 0; p < fine->GetNumberOfPoints(); ++p)
  {
    Point3 point;
    fine->GetPoint(p, point.data());
    onCircle += dimensions->GetTuple1(p) >= 0 && std::abs(point[2]) < 1e-9;
  }
  EXPECT_EQ(onCircle, 12);
}

} // namespace
