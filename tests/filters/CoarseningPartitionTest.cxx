// Coarsening over ranks: the same mesh, bit for bit, and the first independent set.

#include "DataSets.h"
#include "FilterRun.h"
#include "MeshChecks.h"
#include "ParallelTest.h"
#include "Partition.h"
#include "SamePieces.h"
#include "operations/VertexRemoval.h"
#include "pipeline/Coarsening.h"

#include <cadrefine/cad/import/CADFile.h>

#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>

#include <map>
#include <set>

namespace cadrefine
{
namespace
{

/// The box with a hole, refined, with an array that is small where x is, and numbers of the cells.
vtkSmartPointer<vtkPointSet> fineMesh(const cadtest::FilterRun& filters)
{
  auto mesh = filters.refineUniformly(
    filters.project(cadtest::readGrid(CADREFINE_TRUTH "/box_minus_cylinder_coarse.vtu")));
  cadtest::addLargestX(mesh, "Indicator");
  vtkNew<vtkIntArray> numbers; // no tags, also on a rank that has no cells at first
  numbers->SetName("Number");
  for (vtkIdType c = 0; c < mesh->GetNumberOfCells(); ++c)
  {
    numbers->InsertNextValue(static_cast<int>(c));
  }
  mesh->GetCellData()->AddArray(numbers);
  mesh->GetFieldData()->Initialize();
  return mesh;
}

class CoarseningPartition
  : public ParallelTest
  , public testing::WithParamInterface<cadtest::Dealing>
{
protected:
  struct Run
  {
    vtkSmartPointer<vtkPointSet> mesh;
    std::int64_t gone = 0;
  };

  static Run coarsened(RankExchange& ranks, vtkPointSet* piece, const CADModel& model)
  {
    RunStatistics statistics;
    const PipelineContext context{ ranks, model, statistics, [](const std::string&) {} };
    MeshState state = readMesh(ranks, piece);
    readClassification(context, piece, state);
    CoarseningOptions options;
    options.criteria = { { "Indicator", MarkingCriterion::Strategy::AtLeast, 3 } };
    options.maximumDistance = 0.1;
    options.levels = 2;
    options.largestBlock = 1000;
    const std::int64_t gone = coarsenMesh(context, state, options);
    return { makeDataSet(state), gone };
  }
};

TEST_P(CoarseningPartition, isThatOfOneRank)
{
  const cadtest::FilterRun filters(CADREFINE_TRUTH "/box_minus_cylinder.brep");
  const auto whole = fineMesh(filters);
  const auto model = readCADFile(CADREFINE_TRUTH "/box_minus_cylinder.brep");
  const auto rankOfCell = cadtest::deal(GetParam(), whole, exchange.size());
  const auto piece = cadtest::pieceOf(whole, rankOfCell, exchange.rank(), false);
  const Run pieces = coarsened(exchange, piece, *model);
  RankExchange alone(nullptr);
  const Run serial = exchange.rank() == 0 ? coarsened(alone, whole, *model) : Run{};
  cadtest::expectSame(exchange, pieces.mesh, serial.mesh);
  if (exchange.rank() == 0)
  {
    EXPECT_EQ(pieces.gone, serial.gone);
    EXPECT_EQ(whole->GetNumberOfPoints() - serial.mesh->GetNumberOfPoints(), serial.gone);
    EXPECT_GT(serial.gone, whole->GetNumberOfPoints() / 3);
    EXPECT_TRUE(cadtest::isValid(cadtest::toMesh(serial.mesh)));
    EXPECT_TRUE(cadtest::hasNoHangingVertex(cadtest::toMesh(serial.mesh)));
  }
}

/// Of the vertices inside the mesh, taken one after the other in the order of their ids, those
/// stay that have no neighbour that stays.
TEST_P(CoarseningPartition, setIsTheFirstInTheOrderOfIds)
{
  const cadtest::FilterRun filters(CADREFINE_TRUTH "/box_minus_cylinder.brep");
  const auto whole = fineMesh(filters);
  const auto model = readCADFile(CADREFINE_TRUTH "/box_minus_cylinder.brep");
  const auto rankOfCell = cadtest::deal(GetParam(), whole, exchange.size());
  const auto piece = cadtest::pieceOf(whole, rankOfCell, exchange.rank(), false);
  RunStatistics statistics;
  const PipelineContext context{ exchange, *model, statistics, [](const std::string&) {} };
  MeshState state = readMesh(exchange, piece);
  readClassification(context, piece, state);
  const ClassifiedBoundary& boundary = boundaryOf(context, state);
  const Mesh& mesh = state.mesh.mesh();
  std::vector<unsigned char> mayGo(mesh.points.size());
  std::transform(boundary.boundary.onBoundary.begin(), boundary.boundary.onBoundary.end(),
    mayGo.begin(), [](unsigned char onBoundary) { return onBoundary == 0; });
  const auto goes = verticesToRemove(exchange, state.mesh, *state.classification, boundary, mayGo);

  const Mesh all = cadtest::toMesh(whole);
  std::map<GlobalId, std::set<GlobalId>> neighbours;
  std::set<GlobalId> inside(all.ids.begin(), all.ids.end());
  for (const Index vertex : cadtest::outerVertices(all))
  {
    inside.erase(all.ids[vertex]);
  }
  for (const auto& cell : all.tetrahedra)
  {
    for (const Index a : cell)
    {
      for (const Index b : cell)
      {
        neighbours[all.ids[a]].insert(all.ids[b]);
      }
    }
  }
  std::set<GlobalId> stay;
  for (const GlobalId id : all.ids)
  {
    if (inside.count(id) == 0)
    {
      stay.insert(id);
    }
  }
  for (const GlobalId id : inside)
  {
    const auto& around = neighbours[id];
    if (std::none_of(
          around.begin(), around.end(), [&](GlobalId other) { return stay.count(other) > 0; }))
    {
      stay.insert(id);
    }
  }
  for (std::size_t v = 0; v < goes.size(); ++v)
  {
    EXPECT_EQ(goes[v] == 0, stay.count(mesh.ids[v]) > 0) << mesh.ids[v];
  }
}

INSTANTIATE_TEST_SUITE_P(Dealings, CoarseningPartition,
  testing::Values(cadtest::Dealing::Blocks, cadtest::Dealing::Random, cadtest::Dealing::KdTree,
    cadtest::Dealing::EmptyRank));

} // namespace
} // namespace cadrefine
