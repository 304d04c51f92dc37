// What single filters make of pieces is what they make of the whole.

#include "DataSets.h"
#include "FilterRun.h"
#include "ParallelTest.h"
#include "Partition.h"
#include "TestMeshes.h"
#include "TestShapes.h"

#include <vtkCellData.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>

#include <utility>

namespace cadrefine
{

namespace
{

/// Points alone, and filters by themselves.
class SinglePieces : public ParallelTest
{
protected:
  cadtest::TemporaryFolder folder;
  std::string cadFile = cadtest::writeInto(folder, cadtest::sphere(2), ".step");

  vtkSmartPointer<vtkPointSet> ownPieceOf(vtkPointSet* whole) const
  {
    return cadtest::pieceOf(whole, cadtest::deal(cadtest::Dealing::Random, whole, exchange.size()),
      exchange.rank(), false);
  }

  /// Runs a filter on the pieces and on the whole, and compares.
  template<class Filter, class Configure>
  void expectSame(vtkPointSet* whole, const Configure& configure)
  {
    const cadtest::FilterRun filters(cadFile, worldController());
    const auto pieces =
      cadtest::gather(exchange, filters.run<Filter>(ownPieceOf(whole), configure));
    if (exchange.rank() == 0)
    {
      RankExchange alone(nullptr);
      const auto serial =
        cadtest::gather(alone, cadtest::FilterRun(cadFile).run<Filter>(whole, configure));
      EXPECT_EQ(pieces.contradictions, 0);
      EXPECT_TRUE(pieces.points == serial.points);
      EXPECT_TRUE(pieces.cells == serial.cells);
      EXPECT_FALSE(serial.points.empty());
    }
  }
};

TEST_F(SinglePieces, projectAPointCloud)
{
  Mesh cloud = cadtest::cubeMesh(4, 0.2, 1);
  cloud.tetrahedra.clear();
  for (Index v = 0; v < static_cast<Index>(cloud.points.size()); ++v)
  {
    cloud.vertices.push_back({ v });
  }
  expectSame<vtkProjectOntoCAD>(cadtest::toGrid(cloud), [](vtkProjectOntoCAD*) {});
}

TEST_F(SinglePieces, measureValidity)
{
  Mesh mesh = cadtest::cubeMesh(3, 0.1, 1);
  std::swap(mesh.tetrahedra[7][0], mesh.tetrahedra[7][1]);
  expectSame<vtkMeshValidity>(cadtest::toGrid(mesh), [](vtkMeshValidity*) {});
}

/// Numbers for points and cells, also of second order, come from coordinates.
TEST_F(SinglePieces, measureCellsOfSecondOrderWithoutIds)
{
  const cadtest::FilterRun filters(cadFile);
  const auto mesh = filters.run<vtkRefineWithCAD>(filters.project(cadtest::taggedBall()),
    [](vtkRefineWithCAD* filter) { filter->QuadraticCellsOn(); });
  mesh->GetPointData()->SetGlobalIds(nullptr);
  mesh->GetCellData()->SetGlobalIds(nullptr);
  expectSame<vtkMeshValidity>(mesh, [](vtkMeshValidity*) {});
  expectSame<vtkCADGeometricError>(mesh, [](vtkCADGeometricError*) {});
}

TEST_F(SinglePieces, refineStraight)
{
  auto mesh = cadtest::taggedBall();
  cadtest::addArrays(mesh);
  expectSame<vtkRefineWithCAD>(mesh,
    [](vtkRefineWithCAD* filter)
    {
      filter->ProjectNewVerticesOff();
      filter->SetLevels(4);
    });
}

/// Where cells go to other ranks, too.
TEST_F(SinglePieces, keepArraysWithoutNames)
{
  const auto mesh = cadtest::taggedBall();
  cadtest::addArrays(mesh);
  const auto addUnnamed = [](vtkDataSetAttributes* attributes, const char* like)
  {
    const auto copy =
      vtkSmartPointer<vtkDataArray>::Take(attributes->GetArray(like)->NewInstance());
    copy->DeepCopy(attributes->GetArray(like));
    copy->SetName(nullptr);
    attributes->AddArray(copy);
  };
  const auto expectCopy = [](vtkDataSetAttributes* attributes, const char* like)
  {
    vtkDataArray* copy = nullptr;
    for (int a = 0; a < attributes->GetNumberOfArrays(); ++a)
    {
      copy = attributes->GetArray(a)->GetName() ? copy : attributes->GetArray(a);
    }
    ASSERT_TRUE(copy) << like;
    for (vtkIdType i = 0; i < copy->GetNumberOfTuples(); ++i)
    {
      ASSERT_EQ(copy->GetTuple1(i), attributes->GetArray(like)->GetTuple1(i)) << like;
    }
  };
  addUnnamed(mesh->GetPointData(), "Linear");
  addUnnamed(mesh->GetCellData(), "Tag");
  const auto rankOfCell = cadtest::deal(cadtest::Dealing::EmptyRank, mesh, exchange.size());
  const auto piece =
    cadtest::FilterRun(cadFile, worldController())
      .run<vtkRefineWithCAD>(cadtest::pieceOf(mesh, rankOfCell, exchange.rank(), false),
        [](vtkRefineWithCAD* filter)
        {
          filter->ProjectNewVerticesOff();
          filter->SetLevels(4);
        });
  EXPECT_GT(piece->GetNumberOfCells(), 0);
  expectCopy(piece->GetPointData(), "Linear");
  expectCopy(piece->GetCellData(), "Tag");
}

} // namespace

} // namespace cadrefine
