// The reference work's Figures 5.7, 5.9 and 5.10 (S. Strunk, KTH 2013) measured anew: initial
// projection of a region with and without balancing, with and without the search tree, and
// refinement with and without the known entity.
//
//   mpirun -np N nose_benchmark CAD MESH xmin xmax ymin ymax zmin zmax
//
// Each rank holds a block of the mesh's cells and uses one thread. Times are those of the slowest
// rank, the median of several runs.
#include "Partition.h"
#include "classification/DistributedBoundary.h"
#include "comm/LoadBalancedMap.h"
#include "mesh/DistributedMesh.h"

#include <cadrefine/cad/import/CADFile.h>
#include <cadrefine/cad/model/CADModel.h>
#include <cadrefine/classification/MidpointProjection.h>

#include <vtkMPIController.h>
#include <vtkNew.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>

namespace
{

using namespace cadrefine;

/// Midpoint of a boundary edge, and what the edge's ends lie on.
struct Middle
{
  Point3 point;
  std::array<EntityId, 2> classes;
};

vtkSmartPointer<vtkPointSet> readPiece(const char* file, int rank, int ranks)
{
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName(file);
  reader->Update();
  vtkUnstructuredGrid* whole = reader->GetOutput();
  return cadtest::pieceOf(
    whole, cadtest::deal(cadtest::Dealing::KdTree, whole, ranks), rank, false);
}

bool inside(const std::array<double, 6>& region, const Point3& p)
{
  return p[0] >= region[0] && p[0] <= region[1] && p[1] >= region[2] && p[1] <= region[3] &&
         p[2] >= region[4] && p[2] <= region[5];
}

/// The nearest point by screening every face, as the reference work does.
ClosestPoint screenAllFaces(const CADModel& model, const Point3& point)
{
  ClosestPoint best;
  for (std::int32_t face = 0; face < model.count(2); ++face)
  {
    const ClosestPoint hit = model.nearestOn({ 2, face }, point);
    if (hit.distance < best.distance)
    {
      best = hit;
    }
  }
  return best;
}

/// Seconds of the slowest rank.
double measure(RankExchange& exchange, const std::function<void()>& work)
{
  std::vector<double> times;
  for (int run = 0; run < 5; ++run)
  {
    exchange.any(false); // start together
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    times.push_back(exchange.max(seconds.count()));
  }
  std::sort(times.begin(), times.end());
  return times[times.size() / 2];
}

template<class Query, class Function>
void compare(RankExchange& exchange, const char* what, const std::vector<Query>& questions,
  const Function& answer)
{
  double balanced = 0;
  WorkBalance balance;
  const double alone = measure(exchange,
    [&]
    {
      for (const Query& question : questions)
      {
        answer(question);
      }
    });
  balanced = measure(
    exchange, [&] { balance = mapBalanced<ClosestPoint>(exchange, questions, answer).balance; });
  if (exchange.rank() == 0)
  {
    std::printf("| %s | %lld | %.2f | %.4f | %.2f | %.4f |\n", what,
      static_cast<long long>(balance.total), balance.before, alone, balance.after, balanced);
  }
}

void run(RankExchange& exchange, char** arguments)
{
  const auto model = readCADFile(arguments[1]);
  std::array<double, 6> region{};
  for (int k = 0; k < 6; ++k)
  {
    region[k] = std::atof(arguments[3 + k]);
  }
  auto piece = readPiece(arguments[2], exchange.rank(), exchange.size());
  const DistributedMesh mesh = makeDistributedMesh(exchange, piece);
  const DistributedBoundary boundary = findBoundary(exchange, mesh, *model);
  const BoundaryProjector projector(*model, boundary.kind);

  const auto& points = mesh.mesh().points;
  std::vector<Point3> vertices;
  std::vector<EntityId> entities(points.size());
  for (std::size_t v = 0; v < points.size(); ++v)
  {
    if (boundary.onBoundary[v] && inside(region, points[v]))
    {
      vertices.push_back(points[v]);
      entities[v] = model->nearest(points[v]).entity;
    }
  }
  std::vector<Middle> middles;
  for (const auto& [a, b] : boundary.edges.edges())
  {
    if (entities[a] && entities[b])
    {
      middles.push_back({ 0.5 * (points[a] + points[b]), { entities[a], entities[b] } });
    }
  }

  if (exchange.rank() == 0)
  {
    std::printf("%d ranks, %d faces\n", exchange.size(), model->count(2));
    std::printf(
      "| | points | imbalance | s | balanced: imbalance | s |\n|---|---|---|---|---|---|\n");
  }
  compare(exchange, "projection, every face screened", vertices,
    [&](const Point3& point) { return screenAllFaces(*model, point); });
  compare(exchange, "projection, search tree", vertices,
    [&](const Point3& point) { return model->nearest(point); });
  compare(exchange, "refinement, whole model", middles,
    [&](const Middle& middle) { return model->nearest(middle.point); });
  compare(exchange, "refinement, known entity", middles,
    [&](const Middle& middle)
    {
      return projectMidpoint(
        projector, { { EdgeClass::Smooth, -1 }, { middle.point, middle.point }, middle.classes });
    });
}

} // namespace

int main(int argc, char** argv)
{
  vtkNew<vtkMPIController> controller;
  controller->Initialize(&argc, &argv, 0);
  if (argc != 9)
  {
    std::fprintf(stderr, "usage: nose_benchmark CAD MESH xmin xmax ymin ymax zmin zmax\n");
    return 1;
  }
  setenv("VTK_SMP_MAX_THREADS", "1", 1);
  {
    RankExchange exchange(controller);
    run(exchange, argv);
  }
  controller->Finalize();
  return 0;
}
