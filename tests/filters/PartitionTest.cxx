// The same mesh, bit for bit, on any number of ranks and however it is split.

#include "Partition.h"
#include "DataSets.h"
#include "FilterRun.h"
#include "MeshChecks.h"
#include "ParallelTest.h"
#include "QuadraticRuns.h"
#include "SamePieces.h"
#include "SameSteps.h"
#include "TestMeshes.h"
#include "TestShapes.h"

#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>

namespace cadrefine
{

namespace
{

TopoDS_Shape sphere()
{
  return cadtest::sphere(2);
}

TopoDS_Shape circle()
{
  return cadtest::circle(2);
}

/// A mesh, its CAD, and where its boundary may lie.
struct Problem
{
  std::string name;
  std::string cadFile; ///< Empty: `shape`.
  vtkSmartPointer<vtkPointSet> (*mesh)();
  double threshold; ///< Cells with a larger error are bisected.
  bool (*onBoundary)(const std::vector<Point3>& side);
  TopoDS_Shape (*shape)() = sphere;
};

/// Its boundary on the CAD is inside.
vtkSmartPointer<vtkPointSet> ballInShell()
{
  return cadtest::toGrid(cadtest::ballInShellMesh(2, 0.03));
}

vtkSmartPointer<vtkPointSet> discInRing()
{
  return cadtest::toGrid(cadtest::discInRingMesh(2, 0.02, 9));
}

vtkSmartPointer<vtkPointSet> cubesAtAnEdge()
{
  return cadtest::toGrid(cadtest::cubesAtAnEdgeMesh(1));
}

vtkSmartPointer<vtkPointSet> threeSheets()
{
  return cadtest::toPolyData(cadtest::threeSheetsMesh(4));
}

vtkSmartPointer<vtkPointSet> surface()
{
  return cadtest::toPolyData(cadtest::sphereMesh(2, 0.03));
}

vtkSmartPointer<vtkPointSet> crowdedBall()
{
  return cadtest::toGrid(cadtest::crowdedBallMesh(2));
}

/// With a tetrahedron that has two facets on the sphere: vertices slide.
vtkSmartPointer<vtkPointSet> coarseBall()
{
  return cadtest::readGrid(CADREFINE_DATA "/ball_coarse.vtu");
}

vtkSmartPointer<vtkPointSet> wing()
{
  return cadtest::readGrid(CADREFINE_DATA "/naca0012_coarse.vtu");
}

vtkSmartPointer<vtkPointSet> arcs()
{
  return cadtest::readGrid(CADREFINE_DATA "/three_arcs_coarse.vtu");
}

bool onSphere(const std::vector<Point3>& side)
{
  return std::all_of(
    side.begin(), side.end(), [](const Point3& p) { return std::abs(norm(p) - 2) < 1e-11; });
}

/// Of a mesh some of whose vertices may be on the way to the sphere.
bool nearSphere(const std::vector<Point3>& side)
{
  return std::all_of(
    side.begin(), side.end(), [](const Point3& p) { return std::abs(norm(p) - 2) < 0.1; });
}

bool nowhere(const std::vector<Point3>&)
{
  return false;
}

/// On the section, or on one of the planes round it.
bool roundWing(const std::vector<Point3>& side)
{
  const auto isWall = [&](int k)
  {
    return std::all_of(side.begin(), side.end(),
      [&](const Point3& p) { return std::abs(p[k] - side[0][k]) < 1e-11; });
  };
  const bool nearSection = std::all_of(side.begin(), side.end(),
    [](const Point3& p) { return p[0] > -0.01 && p[0] < 3.01 && std::abs(p[2]) < 0.2; });
  return nearSection || isWall(0) || isWall(1) || isWall(2);
}

bool roundArcs(const std::vector<Point3>& side)
{
  const std::array<Point3, 3> centres{ { { 2, 3.75, 0 }, { -0.8125, -2.25, 0 }, { 2, 1.5, 0 } } };
  const std::array<double, 3> radii{ 4.25, 5.3125, 2.5 };
  for (std::size_t arc = 0; arc < 3; ++arc)
  {
    if (std::all_of(side.begin(), side.end(),
          [&](const Point3& p)
          { return std::abs(distance(p, centres[arc]) - radii[arc]) < 1e-11; }))
    {
      return true;
    }
  }
  return side[0][0] == side[1][0] || side[0][1] == side[1][1];
}

bool farOutside(const std::vector<Point3>& side)
{
  return std::all_of(side.begin(), side.end(), [](const Point3& p) { return norm(p) > 3; });
}

bool onCubes(const std::vector<Point3>& side)
{
  const auto isPlane = [&](int k)
  {
    const double plane = std::round(side[0][k]);
    return std::all_of(
      side.begin(), side.end(), [&](const Point3& p) { return std::abs(p[k] - plane) < 1e-11; });
  };
  return isPlane(0) || isPlane(1) || isPlane(2);
}

/// On the edge that the sheets have in common, or on the border of one.
bool roundSheets(const std::vector<Point3>& side)
{
  const auto all = [&](auto&& holds) { return std::all_of(side.begin(), side.end(), holds); };
  const auto radiusIs = [](double radius) {
    return [radius](const Point3& p) { return std::abs(std::hypot(p[0], p[1]) - radius) < 1e-11; };
  };
  const auto heightIs = [](double height)
  { return [height](const Point3& p) { return std::abs(p[2] - height) < 1e-11; }; };
  return all(radiusIs(0)) || all(radiusIs(1)) || all(heightIs(0)) || all(heightIs(1));
}

/// Of the end of a rounded cylinder only the rim is there.
vtkSmartPointer<vtkPointSet> flatEnd()
{
  return cadtest::toGrid(cadtest::prismMesh(1, 4, 6, 3));
}

TopoDS_Shape roundEnd()
{
  return cadtest::roundedCylinder(1, 4);
}

bool onRoundEnd(const std::vector<Point3>& side)
{
  return std::all_of(side.begin(), side.end(),
    [](const Point3& p)
    {
      const double radius = std::hypot(p[0], p[1], std::max(p[2] - 4, 0.0));
      return std::abs(radius - 1) < 1e-11 || std::abs(p[2]) < 1e-11;
    });
}

/// Creases, corners and a seam, found by facets on several ranks.
vtkSmartPointer<vtkPointSet> boxWithHole()
{
  return cadtest::readGrid(CADREFINE_TRUTH "/box_minus_cylinder_coarse.vtu");
}

bool roundBoxWithHole(const std::vector<Point3>& side)
{
  const Point3 size{ 2, 1.5, 1 };
  const auto onPlane = [&](int k, double value)
  {
    return std::all_of(
      side.begin(), side.end(), [&](const Point3& p) { return std::abs(p[k] - value) < 1e-11; });
  };
  const bool onCylinder = std::all_of(side.begin(), side.end(),
    [](const Point3& p) { return std::abs(std::hypot(p[0] - 0.9, p[1] - 0.7) - 0.4) < 1e-11; });
  return onCylinder || onPlane(0, 0) || onPlane(1, 0) || onPlane(2, 0) || onPlane(0, size[0]) ||
         onPlane(1, size[1]) || onPlane(2, size[2]);
}

const std::array<Problem, 12> problems{ { { "Ball", "", cadtest::taggedBall, 0.01, onSphere },
  { "Surface", "", surface, 0.01, nowhere },
  { "Wing", CADREFINE_DATA "/naca0012_sharp.igs", wing, 1e-4, roundWing },
  { "Arcs", CADREFINE_DATA "/three_arcs.igs", arcs, 1e-3, roundArcs },
  { "Crowded", "", crowdedBall, 0.01, onSphere },
  { "Hole", CADREFINE_TRUTH "/box_minus_cylinder.brep", boxWithHole, 1e-3, roundBoxWithHole },
  { "CoarseBall", "", coarseBall, 0.01, nearSphere },
  { "Shell", "", ballInShell, 0.01, farOutside },
  { "Cubes", "", cubesAtAnEdge, 0.01, onCubes, cadtest::cubesAtAnEdge },
  { "RoundEnd", "", flatEnd, 0.1, onRoundEnd, roundEnd },
  { "Sheets", "", threeSheets, 0.01, roundSheets, cadtest::threeSheets },
  { "Ring", "", discInRing, 1e-3, farOutside, circle } } };

struct Case
{
  std::size_t problem;
  cadtest::Dealing dealing;
  bool ids;
  bool ghosts;
  bool balance;
};

std::string nameOf(const Case& c)
{
  const char* dealings[] = { "Blocks", "Random", "KdTree", "EmptyRank" };
  return problems[c.problem].name + dealings[static_cast<int>(c.dealing)] +
         (c.ids ? "Ids" : "NoIds") + (c.ghosts ? "Ghosts" : "") + (c.balance ? "Balanced" : "");
}

std::vector<Case> cases()
{
  using cadtest::Dealing;
  std::vector<Case> result;
  for (std::size_t problem = 0; problem < problems.size(); ++problem)
  {
    result.push_back({ problem, Dealing::Blocks, true, false, true });
    result.push_back({ problem, Dealing::Random, true, true, false });
    result.push_back({ problem, Dealing::KdTree, true, false, true });
    result.push_back({ problem, Dealing::EmptyRank, true, false, true });
    result.push_back({ problem, Dealing::Blocks, false, true, false });
    result.push_back({ problem, Dealing::Random, false, false, true });
    result.push_back({ problem, Dealing::KdTree, false, true, false });
    result.push_back({ problem, Dealing::EmptyRank, false, false, false });
  }
  return result;
}

class Partition
  : public ParallelTest
  , public testing::WithParamInterface<Case>
{
protected:
  static inline cadtest::SerialSteps serial;
  const Problem& problem = problems[GetParam().problem];
  cadtest::TemporaryFolder folder;

  static void TearDownTestSuite() { serial = {}; }

  /// The CAD file; rank 0 alone reads it.
  std::string cadFile() const
  {
    return problem.cadFile.empty() ? cadtest::writeInto(folder, problem.shape(), ".brep")
                                   : problem.cadFile;
  }

  vtkSmartPointer<vtkPointSet> wholeMesh() const
  {
    auto mesh = problem.mesh();
    cadtest::addArrays(mesh);
    if (GetParam().ids)
    {
      cadtest::addGlobalIds(mesh);
    }
    return mesh;
  }

  using Steps = cadtest::Steps;

  /// Of each step that `runSteps` makes of a mesh. Returns the steps of this rank's piece.
  template<class RunSteps>
  Steps expectSameAsOnOneRank(const RunSteps& runSteps)
  {
    return cadtest::expectSameSteps(exchange, serial, problem.name + (GetParam().ids ? "Ids" : ""),
      wholeMesh(), GetParam().dealing, GetParam().ghosts, runSteps);
  }

  /// Of the mesh put together from all ranks.
  void expectSound(vtkPointSet* piece)
  {
    const cadtest::CanonicalMesh gathered = cadtest::gather(exchange, piece);
    if (exchange.rank() > 0)
    {
      return;
    }
    const Mesh mesh = cadtest::toMesh(gathered);
    EXPECT_TRUE(cadtest::isValid(mesh));
    EXPECT_TRUE(cadtest::hasNoHangingVertex(mesh));
    EXPECT_TRUE(cadtest::isWatertight(mesh, problem.onBoundary));
  }
};

INSTANTIATE_TEST_SUITE_P(Problems, Partition, testing::ValuesIn(cases()),
  [](const auto& each) { return nameOf(each.param); });

TEST_P(Partition, givesTheSameMeshAsOneRank)
{
  const Steps pieces = expectSameAsOnOneRank(
    [&](vtkPointSet* mesh, vtkMultiProcessController* controller)
    {
      return cadtest::refinementSteps(cadtest::FilterRun(cadFile(), controller), mesh,
        { problem.threshold, 3, GetParam().balance });
    });
  expectSound(pieces.back());
  cadtest::expectFieldValuesAgree(exchange, pieces.back());
}

/// Cells of second order, of the meshes that a vtkUnstructuredGrid can hold.
class QuadraticPartition : public Partition
{
protected:
  Steps runToQuadratic(vtkPointSet* mesh, vtkMultiProcessController* controller) const
  {
    const cadtest::FilterRun filters(cadFile(), controller);
    Steps steps{ filters.run<vtkRefineWithCAD>(filters.project(mesh),
      [&](vtkRefineWithCAD* filter)
      {
        filter->SetMethod(vtkRefineWithCAD::UNIFORM_BISECTION);
        filter->SetBalance(GetParam().balance);
        filter->QuadraticCellsOn();
      }) };
    steps.push_back(filters.measure(steps.back(), 2));
    steps.push_back(filters.run<vtkMeshValidity>(steps.back(), [](vtkMeshValidity*) {}));
    return steps;
  }
};

std::vector<Case> quadraticCases()
{
  std::vector<Case> result;
  for (const Case& each : cases())
  {
    const std::string& name = problems[each.problem].name;
    const bool holds = name != "Surface" && name != "Sheets"; // poly data
    const bool kdTree = each.dealing == cadtest::Dealing::KdTree && each.ids;
    const bool emptyRank = (name == "Ball" || name == "Arcs") &&
                           each.dealing == cadtest::Dealing::EmptyRank && !each.ids;
    if (holds && (kdTree || emptyRank))
    {
      result.push_back(each);
    }
  }
  return result;
}

INSTANTIATE_TEST_SUITE_P(Problems, QuadraticPartition, testing::ValuesIn(quadraticCases()),
  [](const auto& each) { return nameOf(each.param); });

TEST_P(QuadraticPartition, givesTheSameMeshAsOneRank)
{
  const Steps pieces =
    expectSameAsOnOneRank([&](vtkPointSet* mesh, vtkMultiProcessController* controller)
      { return runToQuadratic(mesh, controller); });
  EXPECT_EQ(cadtest::fieldValue(pieces.back(), "InvalidCells"), 0);
  EXPECT_GT(cadtest::fieldValue(pieces.back(), "CADVertices"), 0);
  cadtest::expectFieldValuesAgree(exchange, pieces.back());
}

class TooCurvedCells : public ParallelTest
{
};

/// Cells that are too curved once their mid nodes are on the CAD are bisected.
TEST_F(TooCurvedCells, areBisectedAsOnOneRank)
{
  const auto whole = cadtest::readGrid(CADREFINE_TRUTH "/linkrods_coarse.vtu");
  cadtest::addGlobalIds(whole);
  const auto toQuadratic = [](vtkPointSet* mesh, vtkMultiProcessController* controller)
  {
    const cadtest::FilterRun filters("/usr/share/opencascade/data/step/linkrods.step", controller);
    return cadtest::refineToQuadratic(filters, filters.project(mesh), 0);
  };
  const auto rankOfCell = cadtest::deal(cadtest::Dealing::Random, whole, exchange.size());
  const auto pieces =
    toQuadratic(cadtest::pieceOf(whole, rankOfCell, exchange.rank(), false), worldController());
  const auto serial = exchange.rank() == 0 ? toQuadratic(whole, nullptr) : nullptr;
  cadtest::expectSame(exchange, pieces, serial);
  EXPECT_GT(cadtest::fieldValue(pieces, "GlobalCells"), 2.0 * whole->GetNumberOfCells());
  EXPECT_EQ(cadtest::fieldValue(pieces, "UnprojectedVertices"), 0);
}

} // namespace

} // namespace cadrefine
