// Meshes of one to five cells, where many ranks have none: the same bits as on one rank.

#include "DataSets.h"
#include "FilterRun.h"
#include "ParallelTest.h"
#include "Partition.h"
#include "TestMeshes.h"
#include "TestShapes.h"

#include <vtkAdaptToCAD.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

namespace cadrefine
{

namespace
{

using PointSet = vtkSmartPointer<vtkPointSet>;
using Work = std::function<PointSet(const cadtest::FilterRun&, vtkPointSet*)>;

struct NamedWork
{
  const char* name;
  Work run;
};

template<class Configure>
Work refining(const Configure& configure)
{
  return [configure](const cadtest::FilterRun& filters, vtkPointSet* mesh)
  { return filters.run<vtkRefineWithCAD>(filters.project(mesh), configure); };
}

std::vector<NamedWork> allWork()
{
  return {
    { "project",
      [](const cadtest::FilterRun& filters, vtkPointSet* mesh) { return filters.project(mesh); } },
    { "error", [](const cadtest::FilterRun& filters, vtkPointSet* mesh)
      { return filters.measure(filters.project(mesh), 2); } },
    { "validity", [](const cadtest::FilterRun& filters, vtkPointSet* mesh)
      { return filters.run<vtkMeshValidity>(mesh, [](vtkMeshValidity*) {}); } },
    { "longest edges", refining([](vtkRefineWithCAD* filter) { filter->SetLevels(2); }) },
    { "longest edges and facets",
      refining([](vtkRefineWithCAD* filter) { filter->CutFacetsOn(); }) },
    { "longest edges without balance", refining(
                                         [](vtkRefineWithCAD* filter)
                                         {
                                           filter->SetLevels(2);
                                           filter->BalanceOff();
                                         }) },
    { "uniform", refining([](vtkRefineWithCAD* filter)
                   { filter->SetMethod(vtkRefineWithCAD::UNIFORM_BISECTION); }) },
    { "uniform without balance", refining(
                                   [](vtkRefineWithCAD* filter)
                                   {
                                     filter->SetMethod(vtkRefineWithCAD::UNIFORM_BISECTION);
                                     filter->BalanceOff();
                                   }) },
    { "quadratic", refining([](vtkRefineWithCAD* filter) { filter->QuadraticCellsOn(); }) },
    { "adapt",
      [](const cadtest::FilterRun& filters, vtkPointSet* mesh)
      {
        return filters.run<vtkAdaptToCAD>(
          mesh, [](vtkAdaptToCAD* filter) { filter->SetMaximumSteps(2); });
      } },
  };
}

class SmallMeshes : public ParallelTest
{
protected:
  cadtest::TemporaryFolder folder;

  void expectSame(const cadtest::FilterRun& filters, vtkPointSet* whole)
  {
    const auto dealing =
      whole->GetNumberOfCells() % 2 == 0 ? cadtest::Dealing::Blocks : cadtest::Dealing::EmptyRank;
    const PointSet piece = cadtest::pieceOf(
      whole, cadtest::deal(dealing, whole, exchange.size()), exchange.rank(), false);
    const cadtest::FilterRun alone(filters.cad());
    for (const NamedWork& work : allWork())
    {
      SCOPED_TRACE(work.name);
      const auto pieces = cadtest::gather(exchange, work.run(filters, piece));
      if (exchange.rank() == 0)
      {
        RankExchange oneRank(nullptr);
        const auto serial = cadtest::gather(oneRank, work.run(alone, whole));
        EXPECT_EQ(pieces.contradictions, 0);
        EXPECT_FALSE(serial.cells.empty());
        EXPECT_TRUE(pieces.points == serial.points);
        EXPECT_TRUE(pieces.cells == serial.cells);
      }
    }
  }

  /// The first one to five of the mesh's cells, with all filters.
  void expectSameOfFirst(const TopoDS_Shape& shape, const Mesh& mesh)
  {
    const cadtest::FilterRun filters(cadtest::writeInto(folder, shape, ".brep"), worldController());
    const std::size_t most = exchange.size() > 8 ? 2 : 5; // many ranks take long
    for (std::size_t count = 1; count <= most; ++count)
    {
      SCOPED_TRACE(count);
      const auto cells = cadtest::toGrid(mesh);
      std::vector<int> isTaken(static_cast<std::size_t>(cells->GetNumberOfCells()), 1);
      std::fill_n(isTaken.begin(), count, 0);
      expectSame(filters, cadtest::pieceOf(cells, isTaken, 0, false));
    }
  }
};

TEST_F(SmallMeshes, tetrahedra)
{
  expectSameOfFirst(cadtest::sphere(2), cadtest::ballMesh(2, 0.03));
}

TEST_F(SmallMeshes, trianglesInThePlane)
{
  expectSameOfFirst(cadtest::circle(2), cadtest::discMesh(2, 0.03, 7));
}

TEST_F(SmallMeshes, trianglesInSpace)
{
  expectSameOfFirst(cadtest::sphere(2), cadtest::sphereMesh(2, 0.03));
}

} // namespace

} // namespace cadrefine
