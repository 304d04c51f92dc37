// Meshes of all shapes: the same mesh, bit for bit, on any number of ranks and however it is split.

#include "DataSets.h"
#include "FilterRun.h"
#include "MeshChecks.h"
#include "MixedMeshes.h"
#include "SameSteps.h"
#include "TestShapes.h"

#include <vtkAdaptToCAD.h>
#include <vtkCoarsenWithCAD.h>
#include <vtkFieldData.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>

namespace cadrefine
{

namespace
{

using cadtest::BoxKind;

const std::vector<double> heights{ 0.02, 0.06, 0.15, 0.5 };
constexpr double wallThickness = 0.06;

/// Of the shells round a sphere those of layers; the outermost is of another kind.
Mesh layers(BoxKind kind)
{
  constexpr int n = 2;
  const Mesh boxes = cadtest::hexahedralShellMesh(2, 0.02, n, heights);
  return cadtest::withListedBoundary(cadtest::mixedMesh(
    boxes, [=](std::size_t c) { return c < heights.size() * 6 * n * n ? kind : BoxKind::Fan; }, 1));
}

Mesh hexahedralBall()
{
  return cadtest::withListedBoundary(cadtest::hexahedralBallMesh(2, 0.02, 2, { 0.6, 1 }));
}

Mesh mixedBall()
{
  return cadtest::withListedBoundary(
    cadtest::randomlyMixedMesh(cadtest::hexahedralBallMesh(2, 0.02, 2, { 0.6, 1 }), 3));
}

Mesh ring()
{
  return cadtest::withListedBoundary(cadtest::quadrilateralRingMesh(2, 0.01, 12, heights));
}

vtkSmartPointer<vtkPointSet> surface()
{
  Mesh mesh = mixedBall();
  std::fill(mesh.ids.begin(), mesh.ids.end(), -1);
  Mesh result;
  result.dimension = 2;
  const auto vertexOf = [&](Index v)
  {
    if (mesh.ids[v] < 0)
    {
      mesh.ids[v] = static_cast<GlobalId>(result.points.size());
      result.points.push_back(mesh.points[v]);
    }
    return static_cast<Index>(mesh.ids[v]);
  };
  visitShapes(mesh, 2,
    [&](auto shape, const auto& cells)
    {
      for (auto cell : cells)
      {
        std::transform(cell.begin(), cell.end(), cell.begin(), vertexOf);
        (result.*decltype(shape)::cells).push_back(cell);
      }
    });
  return cadtest::toPolyData(result);
}

Mesh withTurnedWedges(Mesh mesh)
{
  for (auto& w : mesh.wedges)
  {
    w = { w[3], w[4], w[5], w[0], w[1], w[2] };
  }
  return mesh;
}

template<Mesh (*mesh)()>
vtkSmartPointer<vtkPointSet> gridOf()
{
  return cadtest::toGrid(mesh());
}

Mesh wedgeLayers()
{
  return layers(BoxKind::Wedges);
}

Mesh hexahedralLayers()
{
  return layers(BoxKind::Hexahedron);
}

/// Columns from two walls meet, also on planes of symmetry, which are not in the CAD.
Mesh gap()
{
  return cadtest::withListedBoundary(
    cadtest::eighthOf(cadtest::hexahedralShellMesh(2, 0.02, 4, heights)));
}

/// Both of whose sides are on the CAD, which bulges by more than it is thick.
Mesh thinWall()
{
  return cadtest::withListedBoundary(
    cadtest::hexahedralWallMesh(2, 2, { 0.01, 0.03, wallThickness }));
}

/// Between planes of symmetry, which the CAD does not have inside the sphere.
Mesh eighth(BoxKind kind)
{
  const Mesh boxes = cadtest::eighthOf(cadtest::hexahedralShellMesh(2, 0, 4, heights));
  return cadtest::withListedBoundary(cadtest::mixedMesh(
    boxes, [=](std::size_t) { return kind; }, 1));
}

Mesh eighthOfWedges()
{
  return eighth(BoxKind::Wedges);
}

/// As VTK's documentation draws them.
Mesh documentedWedges()
{
  return withTurnedWedges(eighthOfWedges());
}

Mesh eighthOfHexahedra()
{
  return eighth(BoxKind::Hexahedron);
}

TopoDS_Shape sphere()
{
  return cadtest::sphere(2);
}

TopoDS_Shape circle()
{
  return cadtest::circle(2);
}

TopoDS_Shape twoSpheres()
{
  return cadtest::together(cadtest::sphere(2), cadtest::sphere(6));
}

TopoDS_Shape sidesOfThinWall()
{
  return cadtest::together(cadtest::sphere(2), cadtest::sphere(2 + wallThickness));
}

TopoDS_Shape eighthOfShell()
{
  return cadtest::eighthOfShell(2, 6);
}

struct Problem
{
  std::string name;
  vtkSmartPointer<vtkPointSet> (*mesh)();
  TopoDS_Shape (*cad)();
  double threshold; ///< Cells with a larger error are cut.
};

const std::array<Problem, 11> problems{ { { "HexahedralBall", gridOf<hexahedralBall>, sphere,
                                            0.01 },
  { "MixedBall", gridOf<mixedBall>, sphere, 0.01 },
  { "WedgeLayers", gridOf<wedgeLayers>, sphere, 0.01 },
  { "HexahedralLayers", gridOf<hexahedralLayers>, sphere, 0.01 },
  { "DocumentedWedges", gridOf<documentedWedges>, eighthOfShell, 0.01 },
  { "Gap", gridOf<gap>, twoSpheres, 0.01 }, { "ThinWall", gridOf<thinWall>, sidesOfThinWall, 0.01 },
  { "EighthOfWedges", gridOf<eighthOfWedges>, eighthOfShell, 0.01 },
  { "EighthOfHexahedra", gridOf<eighthOfHexahedra>, eighthOfShell, 0.01 },
  { "Ring", gridOf<ring>, circle, 1e-3 }, { "Surface", surface, sphere, 0.01 } } };

struct Case
{
  std::size_t problem;
  cadtest::Dealing dealing;
  bool ids;
  bool ghosts;
  bool balance;
  bool keepLayers;
};

std::string nameOf(const Case& c)
{
  const char* dealings[] = { "Blocks", "Random", "KdTree", "EmptyRank" };
  return problems[c.problem].name + dealings[static_cast<int>(c.dealing)] +
         (c.ids ? "Ids" : "NoIds") + (c.ghosts ? "Ghosts" : "") + (c.balance ? "Balanced" : "") +
         (c.keepLayers ? "Kept" : "");
}

std::vector<Case> cases()
{
  using cadtest::Dealing;
  std::vector<Case> result;
  for (std::size_t problem = 0; problem < problems.size(); ++problem)
  {
    result.push_back({ problem, Dealing::Blocks, true, true, false, true });
    result.push_back({ problem, Dealing::EmptyRank, true, false, false, true });
    result.push_back({ problem, Dealing::Random, false, false, true, false });
    result.push_back({ problem, Dealing::KdTree, false, true, true, false });
  }
  return result;
}

/// Those with simplices, dealt at random.
std::vector<Case> coarsenedCases()
{
  std::vector<Case> result;
  for (const Case& c : cases())
  {
    const std::string& name = problems[c.problem].name;
    if (c.dealing == cadtest::Dealing::Random &&
        (name == "WedgeLayers" || name == "MixedBall" || name == "Ring" || name == "Surface"))
    {
      result.push_back(c);
    }
  }
  return result;
}

class MixedPartition
  : public ParallelTest
  , public testing::WithParamInterface<Case>
{
protected:
  static inline cadtest::SerialSteps serial;
  const Problem& problem = problems[GetParam().problem];
  cadtest::TemporaryFolder folder;
  const std::string cadFile = cadtest::writeInto(folder, problem.cad(), ".brep");

  static void TearDownTestSuite() { serial = {}; }

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

  void expectSound(vtkPointSet* piece)
  {
    const cadtest::CanonicalMesh gathered = cadtest::gather(exchange, piece);
    if (exchange.rank() > 0)
    {
      return;
    }
    Mesh mesh = cadtest::toMesh(gathered);
    if (problem.name == "DocumentedWedges")
    {
      mesh = withTurnedWedges(mesh);
    }
    EXPECT_TRUE(cadtest::isValid(mesh));
    EXPECT_TRUE(cadtest::hasNoHangingVertex(mesh));
    if (problem.name == "Surface")
    {
      EXPECT_TRUE(cadtest::isWatertight(mesh, [](const auto&) { return false; }));
    }
    else
    {
      EXPECT_TRUE(cadtest::isBoundedByListedCells(mesh));
    }
  }
};

INSTANTIATE_TEST_SUITE_P(Problems, MixedPartition, testing::ValuesIn(cases()),
  [](const auto& each) { return nameOf(each.param); });

TEST_P(MixedPartition, givesTheSameMeshAsOneRank)
{
  const cadtest::Steps pieces =
    cadtest::expectSameSteps(exchange, serial, problem.name + (GetParam().ids ? "Ids" : ""),
      wholeMesh(), GetParam().dealing, GetParam().ghosts,
      [&](vtkPointSet* mesh, vtkMultiProcessController* controller)
      {
        return cadtest::refinementSteps(cadtest::FilterRun(cadFile, controller), mesh,
          { problem.threshold, 1, GetParam().balance, GetParam().keepLayers });
      });
  constexpr std::size_t boundary = 4; // a step
  for (std::size_t step = 0; step < pieces.size(); ++step)
  {
    SCOPED_TRACE("after step " + std::to_string(step));
    if (step != boundary)
    {
      expectSound(pieces[step]);
    }
  }
  cadtest::expectFieldValuesAgree(exchange, pieces.back());
  EXPECT_EQ(cadtest::fieldValue(pieces.back(), "InvalidCells"), 0);
  if (GetParam().keepLayers) // else moves end at the first pyramid
  {
    EXPECT_EQ(cadtest::fieldValue(pieces.back(), "UnprojectedVertices"), 0);
  }
}

/// Coarsening takes vertices out of simplices alone.
class MixedCoarsening : public MixedPartition
{
protected:
  using Counts = std::array<std::int64_t, 4>; ///< Of simplices, pyramids, wedges, and hexahedra
                                              ///< and quadrilaterals, over all ranks.

  Counts countCells(vtkPointSet* piece)
  {
    const Mesh mesh = cadtest::toMesh(piece);
    std::vector<std::int64_t> counts(4, 0);
    visitOwnShapes(mesh,
      [&](auto shape, const auto& cells)
      {
        using Shape = decltype(shape);
        constexpr int place = isSimplex(Shape{})    ? 0
                              : Shape::corners == 5 ? 1
                              : Shape::corners == 6 ? 2
                                                    : 3;
        counts[place] += static_cast<std::int64_t>(cells.size());
      });
    counts = exchange.sum(counts);
    return { counts[0], counts[1], counts[2], counts[3] };
  }
};

INSTANTIATE_TEST_SUITE_P(Problems, MixedCoarsening, testing::ValuesIn(coarsenedCases()),
  [](const auto& each) { return nameOf(each.param); });

TEST_P(MixedCoarsening, leavesOtherCells)
{
  const cadtest::Steps steps = cadtest::expectSameSteps(exchange, serial, problem.name, wholeMesh(),
    GetParam().dealing, GetParam().ghosts,
    [&](vtkPointSet* mesh, vtkMultiProcessController* controller)
    {
      const cadtest::FilterRun filters(cadFile, controller);
      const auto refined = filters.run<vtkRefineWithCAD>(filters.project(mesh),
        [](vtkRefineWithCAD* filter)
        {
          filter->SetMethod(vtkRefineWithCAD::UNIFORM_BISECTION);
          filter->SetLevels(2);
        });
      return cadtest::Steps{ refined,
        filters.run<vtkCoarsenWithCAD>(
          refined, [](vtkCoarsenWithCAD* filter) { filter->SetMaximumDistance(0.2); }) };
    });
  expectSound(steps.back());
  EXPECT_EQ(cadtest::fieldValue(steps.back(), "UnprojectedVertices"), 0);
  const Counts before = countCells(steps.front());
  const Counts after = countCells(steps.back());
  EXPECT_LT(after[0], 0.96 * static_cast<double>(before[0]));
  for (int shape = 1; shape < 4; ++shape)
  {
    EXPECT_EQ(after[shape], before[shape]);
  }
}

} // namespace

} // namespace cadrefine
