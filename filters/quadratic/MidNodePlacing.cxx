#include "quadratic/MidNodePlacing.h"

#include "classification/EdgeMidpoints.h"
#include "comm/Threads.h"
#include "mesh/MeshPlane.h"

#include <cadrefine/quadratic/MidNodeGuard.h>

#include <algorithm>
#include <utility>

namespace cadrefine
{
namespace
{

/// Makes the mesh one of second order, given its edges.
void makeMidNodes(RankExchange& exchange, DistributedMesh& mesh, MarkedEdges edges)
{
  auto ids =
    numberMidpoints(exchange, mesh.shared, mesh.mesh().ids, mesh.vertexIdBound, edges.table.edges);
  MidNodes& nodes = mesh.converted.midNodes.emplace();
  nodes.ids = std::move(ids);
  nodes.table = std::move(edges.table);
  nodes.points.reserve(nodes.table.edges.size());
  for (const auto& ends : nodes.table.edges)
  {
    nodes.points.push_back(middleOf(mesh.mesh(), ends));
  }
  mesh.sharedPoints = findSharedPoints(mesh, edges.sharedEdges);
}

/// Takes the moves back until all cells of all ranks are valid.
void settle(RankExchange& exchange, const DistributedMesh& mesh, const MarkedEdges& edges,
  MidNodeMoves& moves)
{
  const Mesh& piece = mesh.mesh();
  const Vector3 plane = piece.dimension == 2 ? planeNormal(exchange, piece) : Vector3{};
  const auto combine = [&]
  {
    combineShared(exchange, edges.sharedEdges, moves.fractions,
      [](double a, double b) { return std::min(a, b); });
  };
  keepPyramidsStraight(edges.table, moves);
  combine();
  MidNodeGuard guard(piece, edges.table, moves, plane, forOnThreads(exchange));
  while (exchange.any(guard.stepBack(moves)))
  {
    combine();
  }
}

} // namespace

void addMidNodes(RankExchange& exchange, DistributedMesh& mesh)
{
  makeMidNodes(exchange, mesh, findEdges(exchange, mesh, 1));
}

std::int64_t placeMidNodes(RankExchange& exchange, DistributedMesh& mesh,
  const ClassifiedBoundary& classified, Classification& classification, bool move,
  RunStatistics& statistics)
{
  const RunStatistics::Stopwatch watch(statistics, "seconds mid nodes");
  MarkedEdges edges = findEdges(exchange, mesh, 1);
  const auto hits = projectMidpoints(exchange, mesh.mesh(), edges,
    edgeCodes(exchange, edges, classified), classified, classification, statistics);
  MidNodeMoves moves(mesh.mesh(), edges.table);
  for (const MidpointOnCAD& hit : hits)
  {
    if (move)
    {
      moves.add(static_cast<Index>(hit.place), hit.where.point);
    }
  }
  settle(exchange, mesh, edges, moves);
  makeMidNodes(exchange, mesh, std::move(edges));
  const std::size_t vertices = mesh.mesh().points.size();
  classifyMidpoints(hits, mesh.pointCount(), classification);
  for (const MidpointOnCAD& hit : hits)
  {
    const auto edge = static_cast<Index>(hit.place);
    const Point3 position = moves.position(edge);
    mesh.converted.midNodes->points[edge] = position;
    classification.distances[vertices + edge] = distance(position, hit.where.point);
  }
  return countHits(exchange, mesh.sharedPoints, vertices, hits);
}

} // namespace cadrefine
