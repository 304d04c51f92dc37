// Cells of second order of all shapes: the same, bit for bit, on any number of ranks and however
// they are split.

#include "BlockMeshes.h"
#include "DataSets.h"
#include "FilterRun.h"
#include "MixedMeshes.h"
#include "SameSteps.h"
#include "TestShapes.h"

#include <vtkUnstructuredGrid.h>

namespace cadrefine
{

namespace
{

struct Problem
{
  std::string name;
  TopoDS_Shape (*shape)();
  cadtest::Grid (*mesh)();
};

TopoDS_Shape sphere()
{
  return cadtest::sphere(2);
}

/// Pyramids and tetrahedra, too, on the sphere and inside.
cadtest::Grid mixedBall()
{
  return cadtest::toGrid(cadtest::withListedBoundary(
    cadtest::randomlyMixedMesh(cadtest::hexahedralBallMesh(2, 0.02, 2, { 0.6, 1 }), 3)));
}

const Problem problems[] = { { "MixedBall", sphere, mixedBall },
  { "BallWithPyramids", sphere, [] { return cadtest::ballWithPyramids(2); } },
  { "DocumentedWedges", [] { return cadtest::cylinder(2, 3); },
    [] { return cadtest::cylinderOfWedges(2, 3, 8, 2, true); } },
  { "Disc", [] { return cadtest::circle(2); }, [] { return cadtest::discOfQuadrilaterals(2); } },
  { "Surface", sphere, [] { return cadtest::sphereOfQuadrilaterals(2); } } };

class MixedQuadraticPartition
  : public ParallelTest
  , public testing::WithParamInterface<std::tuple<Problem, cadtest::Dealing>>
{
protected:
  static inline cadtest::SerialSteps serial;
  cadtest::TemporaryFolder folder;
  const Problem& problem = std::get<0>(GetParam());
  const std::string cadFile = cadtest::writeInto(folder, problem.shape(), ".brep");

  static void TearDownTestSuite() { serial = {}; }

  using Steps = cadtest::Steps;

  /// The mesh refined and made quadratic, measured with its boundary's cells, judged.
  Steps run(vtkPointSet* mesh, vtkMultiProcessController* controller) const
  {
    const cadtest::FilterRun filters(cadFile, controller);
    Steps steps{ filters.run<vtkRefineWithCAD>(filters.project(mesh),
      [&](vtkRefineWithCAD* filter)
      {
        filter->SetMethod(vtkRefineWithCAD::UNIFORM_BISECTION);
        filter->QuadraticCellsOn();
      }) };
    steps.push_back(filters.run<vtkCADGeometricError>(steps.back(),
      [](vtkCADGeometricError* filter)
      {
        filter->SetRecursionDepth(2);
        filter->SetBoundaryCells(true);
      }));
    steps.push_back(filters.run<vtkMeshValidity>(steps.front(), [](vtkMeshValidity*) {}));
    return steps;
  }
};

INSTANTIATE_TEST_SUITE_P(Problems, MixedQuadraticPartition,
  testing::Combine(testing::ValuesIn(problems),
    testing::Values(cadtest::Dealing::KdTree, cadtest::Dealing::EmptyRank)),
  [](const auto& each)
  {
    return std::get<0>(each.param).name +
           (std::get<1>(each.param) == cadtest::Dealing::KdTree ? "KdTree" : "EmptyRank");
  });

TEST_P(MixedQuadraticPartition, givesTheSameMeshAsOneRank)
{
  const auto whole = problem.mesh();
  cadtest::addArrays(whole);
  const Steps pieces =
    cadtest::expectSameSteps(exchange, serial, problem.name, whole, std::get<1>(GetParam()), true,
      [&](vtkPointSet* mesh, vtkMultiProcessController* controller)
      { return run(mesh, controller); });
  EXPECT_EQ(cadtest::fieldValue(pieces.back(), "InvalidCells"), 0);
  EXPECT_GT(cadtest::fieldValue(pieces.back(), "CADVertices"), 0);
}

} // namespace

} // namespace cadrefine
