#include "DistributedRefinement.h"

#include "Agreement.h"
#include "DistributedBoundary.h"
#include "DistributedMoves.h"
#include "EvenWork.h"
#include "FacetMarking.h"
#include "GlobalNumbering.h"
#include "LargeMemory.h"
#include "VertexNumbering.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <optional>
#include <utility>

namespace cadrefine
{
namespace
{

RefinementPlan makePlan(RankExchange& exchange, const DistributedMesh& mesh)
{
  RefinementPlan plan;
  plan.table = buildEdgeTable(mesh.mesh());
  plan.sharedEdges = findSharedEdges(exchange, mesh.shared, mesh.mesh().ids, plan.table.edges);
  return plan;
}

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

std::vector<GlobalId> numberNewVertices(RankExchange& exchange, DistributedMesh& mesh,
  const std::vector<std::array<Index, 2>>& parentEdges)
{
  const auto& ids = mesh.mesh().ids;
  std::vector<VertexKey<1>> keys;
  resizeLong(keys, parentEdges.size());
  std::transform(parentEdges.begin(), parentEdges.end(), keys.begin(),
    [&](const std::array<Index, 2>& ends) {
      return VertexKey<1>{ ends[0], { ids[ends[1]] } };
    });
  Numbering numbering = numberAtVertices(exchange, mesh.shared, ids, keys);
  for (GlobalId& number : numbering.numbers)
  {
    number += mesh.vertexIdBound;
  }
  mesh.vertexIdBound += numbering.count;
  return std::move(numbering.numbers);
}

/// Ids of the children: parents in the order of their ids, the children of each in a row.
std::array<std::vector<GlobalId>, 4> numberChildren(RankExchange& exchange,
  const std::array<std::vector<GlobalId>, 4>& parentIds, const ChildRanges& firstChildren)
{
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
  const auto firstIds = denseOffsets(exchange, parents, weights).numbers;
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

/// The shared vertices of the refined mesh: those that were, and the midpoints of shared edges.
/// New ids are larger than old ones, and in the order of their edges.
SharedVertices sharedAfter(
  const SharedVertices& before, const RefinementPlan& plan, const Midpoints& midpoints)
{
  auto items = before.items;
  for (std::size_t n = 0; n < plan.sharedEdges.neighbours.size(); ++n)
  {
    const auto neighbour = std::lower_bound(
      before.neighbours.begin(), before.neighbours.end(), plan.sharedEdges.neighbours[n]);
    auto& vertices = items[neighbour - before.neighbours.begin()];
    for (const Index edge : plan.sharedEdges.items[n])
    {
      if (plan.marks[edge])
      {
        vertices.push_back(midpoints.ofEdge[edge]);
      }
    }
  }
  return makeSharedItems(before.rank, before.neighbours, std::move(items));
}

/// Class of an edge and whether it lies on the boundary, as one number that ranks can combine by
/// the maximum: a rank without a facet at the edge has 0.
std::int64_t encode(const EdgeClass& edgeClass)
{
  return 1 + edgeClass.kind + 4 * static_cast<std::int64_t>(edgeClass.edge + 1);
}

EdgeClass decode(std::int64_t code)
{
  return code == 0 ? EdgeClass{}
                   : EdgeClass{ static_cast<EdgeClass::Kind>((code - 1) % 4),
                       static_cast<std::int32_t>((code - 1) / 4 - 1) };
}

/// The code of every edge of the piece, also of edges whose boundary facets are on other ranks.
std::vector<std::int64_t> edgeCodes(
  RankExchange& exchange, const RefinementPlan& plan, const ClassifiedBoundary& classified)
{
  std::vector<std::int64_t> codes(plan.table.edges.size(), 0);
  const auto& edges = classified.boundary.edges.edges();
  for (std::size_t e = 0; e < edges.size(); ++e)
  {
    codes[plan.table.find(edges[e][0], edges[e][1])] = encode(classified.classes.ofEdges[e]);
  }
  combineShared(exchange, plan.sharedEdges, codes,
    [](std::int64_t a, std::int64_t b) { return std::max(a, b); });
  return codes;
}

/// A new vertex that belongs onto the CAD.
struct NewOnCAD
{
  std::size_t place; ///< Among the new vertices.
  ClosestPoint where;
};

/// The middle of an edge, which looks for its place on the CAD.
struct MidpointQuestion
{
  EdgeClass edgeClass;
  std::array<Point3, 2> points;
  std::array<EntityId, 2> entities;
};

std::vector<NewOnCAD> projectMidpoints(RankExchange& exchange, const SimplexMesh& mesh,
  const RefinementPlan& plan, const std::vector<std::int64_t>& codes,
  const BoundaryProjector& projector, const Classification& classification,
  RunStatistics& statistics)
{
  std::vector<std::size_t> places;
  std::vector<MidpointQuestion> questions;
  std::size_t place = 0;
  for (std::size_t e = 0; e < codes.size(); ++e)
  {
    const EdgeClass edgeClass = decode(codes[e]);
    if (plan.marks[e] && edgeClass.kind != EdgeClass::Straight)
    {
      const auto [a, b] = plan.table.edges[e];
      places.push_back(place);
      questions.push_back({ edgeClass, { mesh.points[a], mesh.points[b] },
        { classification.entities[a], classification.entities[b] } });
    }
    place += plan.marks[e];
  }
  const auto answers = answerEvenly<ClosestPoint>(exchange, std::move(questions),
    [&](const MidpointQuestion& question)
    { return projector.projectMidpoint(question.edgeClass, question.points, question.entities); });
  recordBalance(statistics, "new points", answers.balance);
  std::vector<NewOnCAD> hits;
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    if (answers.values[i].entity)
    {
      hits.push_back({ places[i], answers.values[i] });
    }
  }
  return hits;
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

/// Appends the new vertices, at their distance from the CAD; the mesh has `count` vertices now.
void classifyNewVertices(
  const std::vector<NewOnCAD>& hits, std::size_t count, Classification& classification)
{
  const std::size_t oldCount = classification.entities.size();
  classification.resize(count);
  for (const NewOnCAD& hit : hits)
  {
    classification.set(static_cast<Index>(oldCount + hit.place), hit.where);
    classification.distances[oldCount + hit.place] = hit.where.distance;
  }
}

/// Moves of all vertices that are not at their places to these.
Moves movesOntoCAD(const SimplexMesh& mesh, const std::vector<NewOnCAD>& hits,
  const BoundaryProjector& projector, Classification& classification)
{
  Moves moves(mesh);
  const std::size_t oldCount = classification.entities.size();
  for (std::size_t v = 0; v < oldCount; ++v)
  {
    if (classification.distances[v] > 0)
    {
      const auto vertex = static_cast<Index>(v);
      const ClosestPoint where = projector.nearestOn(classification.entities[v], mesh.points[v]);
      classification.set(vertex, where);
      moves.add(vertex, where.point);
    }
  }
  classifyNewVertices(hits, mesh.points.size(), classification);
  for (const NewOnCAD& hit : hits)
  {
    moves.add(static_cast<Index>(oldCount + hit.place), hit.where.point);
  }
  return moves;
}

/// `oldCount`: vertices before the mesh was refined.
std::int64_t countOwnedHits(RankExchange& exchange, const DistributedMesh& mesh,
  std::size_t oldCount, const std::vector<NewOnCAD>& hits)
{
  return exchange.sum(std::count_if(hits.begin(), hits.end(),
    [&](const NewOnCAD& hit)
    { return mesh.shared.owner(static_cast<Index>(oldCount + hit.place)) == exchange.rank(); }));
}

} // namespace

RefinementPlan planUniform(RankExchange& exchange, const DistributedMesh& mesh)
{
  RefinementPlan plan = makePlan(exchange, mesh);
  plan.uniform = true;
  plan.marks.assign(plan.table.edges.size(), 1);
  return plan;
}

RefinementPlan planLongestEdge(RankExchange& exchange, const DistributedMesh& mesh,
  const std::vector<unsigned char>& cellMarks, const FacetsToCut* toCut)
{
  RefinementPlan plan = makePlan(exchange, mesh);
  plan.marks.assign(plan.table.edges.size(), 0);
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
    ids = numberNewVertices(exchange, mesh, midpoints.parentEdges);
  }
  SplitMesh split;
  {
    const RunStatistics::Stopwatch watch(statistics, "seconds cutting");
    split = plan.uniform ? splitUniformly(mesh.mesh(), plan.table, midpoints, ids)
                         : splitMarked(mesh.mesh(), plan.table, plan.marks, midpoints, ids);
  }
  const RunStatistics::Stopwatch watch(statistics, "seconds numbering");
  mesh.converted.cellIds = numberChildren(exchange, mesh.converted.cellIds, split.firstChildren);
  mesh.mesh() = std::move(split.mesh);
  mesh.converted.pointOf.clear();
  mesh.converted.cellOf = {};
  mesh.shared = sharedAfter(mesh.shared, plan, midpoints);
  return { std::move(split.parentEdges), std::move(split.firstChildren), 0 };
}

RefinementTrace refineOntoCAD(RankExchange& exchange, DistributedMesh& mesh,
  const RefinementPlan& plan, const ClassifiedBoundary& classified, Classification& classification,
  NewVertices newVertices, RunStatistics& statistics)
{
  std::optional<RunStatistics::Stopwatch> watch;
  watch.emplace(statistics, "seconds projection");
  const BoundaryProjector& projector = classified.projector;
  const auto codes = edgeCodes(exchange, plan, classified);
  const auto hits =
    projectMidpoints(exchange, mesh.mesh(), plan, codes, projector, classification, statistics);
  const auto onBoundary = onRefinedBoundary(plan, codes, classified.boundary.onBoundary);
  const std::size_t oldCount = mesh.mesh().points.size();
  watch.reset();
  RefinementTrace trace = refine(exchange, mesh, plan, statistics);
  watch.emplace(statistics, "seconds moves");
  trace.projectedPoints = countOwnedHits(exchange, mesh, oldCount, hits);
  if (newVertices == NewVertices::StayStraight)
  {
    classifyNewVertices(hits, mesh.mesh().points.size(), classification);
    return trace;
  }
  Moves moves = movesOntoCAD(mesh.mesh(), hits, projector, classification);
  moveOntoCAD(exchange, mesh, std::move(moves), classification,
    { projector, onBoundary, newVertices == NewVertices::MoveAndMend, true });
  return trace;
}

} // namespace cadrefine
