#include "refinement/DistributedRefinement.h"

#include "classification/DistributedBoundary.h"
#include "comm/CollectiveErrors.h"
#include "comm/GlobalNumbering.h"
#include "comm/WorkSteps.h"
#include "mesh/PieceCheck.h"
#include "motion/BoundaryMotion.h"
#include "refinement/FacetMarking.h"

#include <cadrefine/base/Error.h>
#include <cadrefine/base/LargeMemory.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

namespace cadrefine
{
namespace
{

/// Marks the shared edges that any rank has marked. Returns those that are new to this one.
std::vector<Index> combineMarks(RankExchange& exchange, RefinementPlan& plan)
{
  std::vector<Index> fresh;
  const auto& shared = plan.sharedEdges.all;
  std::copy_if(shared.begin(), shared.end(), std::back_inserter(fresh),
    [&](Index edge) { return !plan.marks[edge]; });
  combineShared(exchange, plan.sharedEdges, plan.marks,
    [](unsigned char a, unsigned char b) { return std::max(a, b); });
  fresh.erase(
    std::remove_if(fresh.begin(), fresh.end(), [&](Index edge) { return !plan.marks[edge]; }),
    fresh.end());
  return fresh;
}

/// `onBoundary` of the vertices that were, and of the new ones.
std::vector<unsigned char> onRefinedBoundary(const RefinementPlan& plan,
  const std::vector<std::int64_t>& codes, const std::vector<unsigned char>& onBoundary)
{
  auto result = onBoundary;
  result.reserve(onBoundary.size() + codes.size());
  for (std::size_t e = 0; e < codes.size(); ++e)
  {
    if (plan.marks[e])
    {
      result.push_back(codes[e] != 0);
    }
  }
  return result;
}

} // namespace

std::array<std::vector<GlobalId>, 4> numberChildren(
  RankExchange& exchange, const DistributedMesh& mesh, const ChildRanges& firstChildren)
{
  const auto& parentIds = mesh.converted.cellIds;
  const std::size_t cells = std::accumulate(parentIds.begin(), parentIds.end(), std::size_t{ 0 },
    [](std::size_t sum, const std::vector<GlobalId>& list) { return sum + list.size(); });
  std::vector<GlobalId> parents;
  std::vector<std::int64_t> weights;
  reserveLong(parents, cells);
  reserveLong(weights, cells);
  for (int d = 0; d < 4; ++d)
  {
    const auto& firsts = firstChildren[d];
    parents.insert(parents.end(), parentIds[d].begin(), parentIds[d].end());
    for (std::size_t c = 0; c < parentIds[d].size(); ++c)
    {
      weights.push_back(firsts[c + 1] - firsts[c]);
    }
  }
  std::vector<GlobalId> firstIds;
  try
  {
    firstIds = denseOffsets(exchange, parents, weights).numbers;
  }
  catch (const AgreedError&)
  {
    complainOfRepeatedCells(exchange, mesh.mesh(), parentIds);
  }
  std::array<std::vector<GlobalId>, 4> ids;
  auto parent = firstIds.begin();
  for (int d = 0; d < 4; ++d)
  {
    const auto& firsts = firstChildren[d];
    resizeLong(ids[d], firsts.back());
    for (std::size_t c = 0; c + 1 < firsts.size(); ++c)
    {
      std::iota(ids[d].begin() + firsts[c], ids[d].begin() + firsts[c + 1], *parent);
      ++parent;
    }
  }
  return ids;
}

Moves movesOntoCAD(
  const SimplexMesh& mesh, const BoundaryProjector& projector, Classification& classification)
{
  Moves moves(mesh);
  for (std::size_t v = 0; v < classification.entities.size(); ++v)
  {
    if (classification.distances[v] > 0)
    {
      const auto vertex = static_cast<Index>(v);
      const ClosestPoint where = projector.nearestOn(classification.entities[v], mesh.points[v]);
      classification.set(vertex, where);
      moves.add(vertex, where.point);
    }
  }
  return moves;
}

RefinementPlan planUniform(RankExchange& exchange, const DistributedMesh& mesh)
{
  return { findEdges(exchange, mesh, 1), true };
}

RefinementPlan planLongestEdge(RankExchange& exchange, const DistributedMesh& mesh,
  const std::vector<unsigned char>& cellMarks, const FacetsToCut* toCut)
{
  RefinementPlan plan{ findEdges(exchange, mesh, 0), false };
  markLongestEdges(mesh.mesh(), plan.table, cellMarks, plan.marks);
  if (toCut)
  {
    markFacets(toCut->boundary, toCut->classification, plan.table, cellMarks, plan.marks);
  }
  combineMarks(exchange, plan);
  MarkClosure closure(plan.table, plan.marks);
  bool changed = exchange.any(closure.closeAll());
  while (changed)
  {
    changed = exchange.any(closure.closeFrom(combineMarks(exchange, plan)));
  }
  return plan;
}

ChildRanges countChildren(const SimplexMesh& mesh, const RefinementPlan& plan)
{
  return plan.uniform ? countUniformChildren(mesh)
                      : countMarkedChildren(mesh, plan.table, plan.marks);
}

RefinementTrace refine(RankExchange& exchange, DistributedMesh& mesh, const RefinementPlan& plan,
  RunStatistics& statistics)
{
  const Midpoints midpoints = makeMidpoints(mesh.mesh(), plan.table, plan.marks);
  std::vector<GlobalId> ids;
  {
    const RunStatistics::Stopwatch watch(statistics, "seconds numbering");
    ids = numberMidpoints(exchange, mesh, midpoints.parentEdges);
  }
  SplitMesh split;
  {
    exchange.progress().say(0.5, "splitting cells");
    const RunStatistics::Stopwatch watch(statistics, "seconds cutting");
    split = plan.uniform ? splitUniformly(mesh.mesh(), plan.table, midpoints, ids)
                         : splitMarked(mesh.mesh(), plan.table, plan.marks, midpoints, ids);
  }
  const RunStatistics::Stopwatch watch(statistics, "seconds numbering");
  mesh.converted.cellIds = numberChildren(exchange, mesh, split.firstChildren);
  mesh.mesh() = std::move(split.mesh);
  mesh.converted.pointOf.clear();
  mesh.converted.cellOf = {};
  mesh.shared = sharedWithMidpoints(mesh.shared, plan.sharedEdges, midpoints.ofEdge);
  return { std::move(split.parentEdges), std::move(split.firstChildren), 0 };
}

RefinementTrace refineOntoCAD(RankExchange& exchange, DistributedMesh& mesh,
  const RefinementPlan& plan, const ClassifiedBoundary& classified, Classification& classification,
  NewVertices newVertices, RunStatistics& statistics)
{
  WorkSteps steps(exchange.progress(), statistics);
  steps.begin(0.2, 0.5, "seconds projection");
  const BoundaryProjector& projector = classified.projector;
  const auto codes = edgeCodes(exchange, plan, classified);
  const auto hits =
    projectMidpoints(exchange, mesh.mesh(), plan, codes, classified, classification, statistics);
  auto onBoundary = onRefinedBoundary(plan, codes, classified.boundary.onBoundary);
  const std::size_t oldCount = mesh.mesh().points.size();
  steps.end();
  RefinementTrace trace = refine(exchange, mesh, plan, statistics);
  steps.begin(0.7, 1, "seconds moves");
  trace.projectedPoints = countHits(exchange, mesh.shared, oldCount, hits);
  if (newVertices == NewVertices::StayStraight)
  {
    classifyMidpoints(hits, mesh.mesh().points.size(), classification);
    trace.onBoundary = std::move(onBoundary);
    return trace;
  }
  Moves moves = movesOntoCAD(mesh.mesh(), projector, classification);
  classifyMidpoints(hits, mesh.mesh().points.size(), classification);
  for (const MidpointOnCAD& hit : hits)
  {
    moves.add(static_cast<Index>(oldCount + hit.place), hit.where.point);
  }
  moveOntoCAD(exchange, mesh, std::move(moves), classification,
    { projector, onBoundary, newVertices == NewVertices::MoveAndMend, true });
  trace.onBoundary = std::move(onBoundary);
  return trace;
}

} // namespace cadrefine
