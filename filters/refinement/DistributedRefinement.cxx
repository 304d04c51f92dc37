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
#include <cadrefine/mesh/VertexFlags.h>
#include <cadrefine/motion/MovesOntoCAD.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <sstream>
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
  combineFlags(exchange, plan.sharedEdges, plan.marks);
  fresh.erase(
    std::remove_if(fresh.begin(), fresh.end(), [&](Index edge) { return !plan.marks[edge]; }),
    fresh.end());
  return fresh;
}

/// The flags `onBoundary` of the old vertices, then those of the new ones on edges and in these
/// quadrilaterals.
std::vector<unsigned char> onRefinedBoundary(const RefinementPlan& plan,
  const std::vector<SharedClass>& ofEdges, const std::vector<Index>& quads,
  const std::vector<SharedClass>& ofQuads, const std::vector<unsigned char>& onBoundary)
{
  auto result = onBoundary;
  result.reserve(onBoundary.size() + ofEdges.size());
  for (std::size_t e = 0; e < ofEdges.size(); ++e)
  {
    if (plan.marks[e])
    {
      result.push_back(ofEdges[e].onBoundary != 0);
    }
  }
  std::transform(quads.begin(), quads.end(), std::back_inserter(result),
    [&](Index quad) { return ofQuads[quad].onBoundary != 0; });
  return result;
}

/// The new vertices of a mesh, with their ids, and which vertices are then shared.
struct NewVerticesOfMesh
{
  Midpoints midpoints;
  std::vector<GlobalId> ids;
  SharedVertices shared;
};

/// Appends the ids of new vertices in the middle of corners of cells, in the order of the cells'
/// ids.
void numberInCells(RankExchange& exchange, DistributedMesh& mesh, NewVerticesOfMesh& made)
{
  const auto& idsOfCells = mesh.converted.cellIds[mesh.mesh().dimension];
  std::vector<GlobalId> cells;
  for (const Index cell : made.midpoints.cells)
  {
    cells.push_back(idsOfCells[cell]);
  }
  const std::vector<Index> ones(cells.size(), 1);
  const Numbering numbering = denseOffsets(exchange, std::move(cells), ones);
  for (const GlobalId number : numbering.numbers)
  {
    made.ids.push_back(mesh.vertexIdBound + number);
  }
  mesh.vertexIdBound += numbering.count;
}

/// Makes the new vertices on edges, then those in quadrilaterals, whose ids follow from those on
/// edges, and so on.
NewVerticesOfMesh makeNewVertices(
  RankExchange& exchange, DistributedMesh& mesh, const RefinementPlan& plan)
{
  NewVerticesOfMesh made;
  made.midpoints =
    makeMidpoints(mesh.mesh(), plan.table, plan.quads.table, plan.marks, plan.uniform);
  const auto& parents = made.midpoints.parentEdges;
  if (!plan.quads.any)
  {
    made.ids = numberMidpoints(exchange, mesh.shared, mesh.mesh().ids, mesh.vertexIdBound, parents);
    made.shared = sharedWithMidpoints(mesh.shared, plan.sharedEdges, made.midpoints.ofEdge);
    return made;
  }
  std::vector<GlobalId> ids = mesh.mesh().ids;
  const auto number = [&](std::size_t count)
  {
    const auto first = parents.begin() + static_cast<std::ptrdiff_t>(made.ids.size());
    const auto numbers = numberMidpoints(exchange, made.shared, ids, mesh.vertexIdBound,
      { first, first + static_cast<std::ptrdiff_t>(count) });
    ids.insert(ids.end(), numbers.begin(), numbers.end());
    made.ids.insert(made.ids.end(), numbers.begin(), numbers.end());
  };
  made.shared = mesh.shared;
  number(made.midpoints.edges.size());
  made.shared = sharedWithMidpoints(made.shared, plan.sharedEdges, made.midpoints.ofEdge);
  number(made.midpoints.quads.size());
  made.shared = sharedWithMidpoints(made.shared, plan.quads.shared, made.midpoints.ofQuad);
  number(made.midpoints.hexahedra.size());
  numberInCells(exchange, mesh, made);
  return made;
}

/// Makes edges that stand over each other count as the longest of them, on whatever rank.
/// Collective.
void orderStacks(RankExchange& exchange, const Mesh& mesh, RefinementPlan& plan)
{
  if (!exchange.any(!mesh.wedges.empty()))
  {
    return;
  }
  EdgeStacks stacks(plan.table, mesh.ids);
  stacks.spread();
  do
  {
    combineLargest(exchange, plan.sharedEdges, stacks.lengths());
  } while (exchange.any(stacks.spread()));
  stacks.writeTo(plan.table);
}

template<std::size_t Corners>
[[noreturn]] void complainOfBadCut(
  const DistributedMesh& mesh, Index cell, const std::array<Index, Corners>& corners)
{
  std::ostringstream reason;
  const Point3& place = mesh.mesh().points[corners[0]];
  reason << "the cell with the id " << mesh.converted.cellIds[mesh.mesh().dimension][cell]
         << ", with " << Corners << " vertices, at (" << place[0] << ", " << place[1] << ", "
         << place[2]
         << "), is too distorted to be cut into valid cells; improve the mesh there, or refine "
            "by longest edge bisection";
  throw Error(reason.str());
}

/// Marks all edges of cells that would be cut badly. Returns whether there are any. Throws Error
/// for one all of whose edges are marked. Collective.
bool markBadlyCut(RankExchange& exchange, const DistributedMesh& mesh, RefinementPlan& plan)
{
  const Mesh& piece = mesh.mesh();
  const std::vector<Index> bad =
    cellsCutBadly(piece, plan.table, plan.quads.table, plan.marks, plan.uniform);
  std::vector<Index> toMark; // at once: a cell whose neighbours mark all its edges has another try
  agreeOnFailure(exchange,
    [&]
    {
      std::size_t first = 0;
      visitOwnShapes(piece,
        [&](auto shape, const auto& cells)
        {
          for (const Index cell : cellsOfShape(bad, first, cells.size()))
          {
            const auto& edges = (plan.table.*edgesOfCells(shape))[cell];
            if (std::all_of(
                  edges.begin(), edges.end(), [&](Index edge) { return plan.marks[edge] != 0; }))
            {
              complainOfBadCut(mesh, static_cast<Index>(first) + cell, cells[cell]);
            }
            toMark.insert(toMark.end(), edges.begin(), edges.end());
          }
          first += cells.size();
        });
    });
  for (const Index edge : toMark)
  {
    plan.marks[edge] = 1;
  }
  return exchange.any(!bad.empty());
}

/// A plan that cuts nothing.
RefinementPlan planNone(RankExchange& exchange, const DistributedMesh& mesh, bool keepLayers)
{
  RefinementPlan plan{ findEdges(exchange, mesh, 0) };
  plan.quads = findQuads(exchange, mesh, plan.table);
  if (keepLayers && plan.quads.any)
  {
    orderStacks(exchange, mesh.mesh(), plan);
  }
  return plan;
}

/// Marks edges until no vertex hangs on any rank.
void closeMarks(
  RankExchange& exchange, const DistributedMesh& mesh, bool keepLayers, RefinementPlan& plan)
{
  do
  {
    combineMarks(exchange, plan);
    MarkClosure closure(plan.table, mesh.mesh().dimension, keepLayers, plan.marks);
    bool changed = exchange.any(closure.closeAll());
    while (changed)
    {
      changed = exchange.any(closure.closeFrom(combineMarks(exchange, plan)));
    }
  } while (plan.quads.any && markBadlyCut(exchange, mesh, plan));
}

/// The tags of the parents; none where there are none.
std::vector<std::uint64_t> tagsOfChildren(
  int dimension, const RefinementTrace& trace, const std::vector<std::uint64_t>& tags)
{
  std::vector<std::uint64_t> result;
  if (!tags.empty())
  {
    result.resize(trace.firstChildren[dimension].back());
    trace.visitChildren(
      dimension, [&](Index parent, Index child) { result[child] = tags[parent]; });
  }
  return result;
}

} // namespace

std::array<std::vector<GlobalId>, 4> numberChildren(
  RankExchange& exchange, const DistributedMesh& mesh, const RefinementTrace& trace)
{
  const auto& parentIds = mesh.converted.cellIds;
  const std::size_t cells = std::accumulate(parentIds.begin(), parentIds.end(), std::size_t{ 0 },
    [](std::size_t sum, const std::vector<GlobalId>& list) { return sum + list.size(); });
  std::vector<GlobalId> parents;
  std::vector<Index> weights;
  reserveLong(parents, cells);
  reserveLong(weights, cells);
  for (int d = 0; d < 4; ++d)
  {
    const auto& firsts = trace.firstChildren[d];
    parents.insert(parents.end(), parentIds[d].begin(), parentIds[d].end());
    for (std::size_t c = 0; c < parentIds[d].size(); ++c)
    {
      weights.push_back(firsts[c + 1] - firsts[c]);
    }
  }
  std::vector<GlobalId> firstIds;
  try
  {
    firstIds = denseOffsets(exchange, std::move(parents), weights).numbers;
  }
  catch (const AgreedError&)
  {
    complainOfRepeatedCells(exchange, mesh.mesh(), parentIds);
  }
  std::array<std::vector<GlobalId>, 4> ids;
  auto parent = firstIds.begin();
  for (int d = 0; d < 4; ++d)
  {
    const auto& firsts = trace.firstChildren[d];
    resizeLong(ids[d], firsts.back());
    Index place = 0;
    trace.visitChildren(
      d, [&](Index cell, Index child) { ids[d][child] = parent[cell] + (place++ - firsts[cell]); });
    parent += static_cast<std::ptrdiff_t>(firsts.size()) - 1;
  }
  return ids;
}

RefinementPlan planUniform(RankExchange& exchange, const DistributedMesh& mesh)
{
  RefinementPlan plan{ findEdges(exchange, mesh, 1), {}, true };
  plan.quads = findQuads(exchange, mesh, plan.table);
  if (plan.quads.any)
  {
    markBadlyCut(exchange, mesh, plan); // which all edges are: an error
  }
  return plan;
}

RefinementPlan planLongestEdge(RankExchange& exchange, const DistributedMesh& mesh,
  const std::vector<unsigned char>& cellMarks, const FacetsToCut* toCut, bool keepLayers)
{
  RefinementPlan plan = planNone(exchange, mesh, keepLayers);
  markLongestEdges(mesh.mesh(), plan.table, cellMarks, keepLayers, plan.marks);
  if (toCut)
  {
    markFacets(toCut->boundary, toCut->classification, plan.table, cellMarks, plan.marks);
  }
  closeMarks(exchange, mesh, keepLayers, plan);
  return plan;
}

RefinementPlan planFromEdges(
  RankExchange& exchange, const DistributedMesh& mesh, const EdgeMarks& edges, bool keepLayers)
{
  RefinementPlan plan = planNone(exchange, mesh, keepLayers);
  plan.marks = edges;
  closeMarks(exchange, mesh, keepLayers, plan);
  return plan;
}

ChildRanges countChildren(const Mesh& mesh, const RefinementPlan& plan)
{
  return plan.uniform ? countUniformChildren(mesh)
                      : countMarkedChildren(mesh, plan.table, plan.quads.table, plan.marks);
}

RefinementTrace refine(RankExchange& exchange, DistributedMesh& mesh, const RefinementPlan& plan,
  RunStatistics& statistics)
{
  NewVerticesOfMesh made;
  {
    const RunStatistics::Stopwatch watch(statistics, "seconds numbering");
    made = makeNewVertices(exchange, mesh, plan);
  }
  SplitMesh split;
  {
    exchange.progress().say(0.5, "splitting cells");
    const RunStatistics::Stopwatch watch(statistics, "seconds cutting");
    split = plan.uniform
              ? splitUniformly(mesh.mesh(), plan.table, plan.quads.table, made.midpoints, made.ids)
              : splitMarked(
                  mesh.mesh(), plan.table, plan.quads.table, plan.marks, made.midpoints, made.ids);
  }
  const RunStatistics::Stopwatch watch(statistics, "seconds numbering");
  RefinementTrace trace{ std::move(split.parentEdges), std::move(split.firstChildren),
    std::move(split.children) };
  trace.ofVertices = std::move(split.ofVertices);
  mesh.converted.cellIds = numberChildren(exchange, mesh, trace);
  mesh.mesh() = std::move(split.mesh);
  mesh.converted.pointOf.clear();
  mesh.converted.cellOf = {};
  mesh.shared = std::move(made.shared);
  return trace;
}

CutOntoCAD refineOntoCAD(RankExchange& exchange, DistributedMesh& mesh, const RefinementPlan& plan,
  const ClassifiedBoundary& classified, Classification& classification, const CutSettings& settings,
  RunStatistics& statistics)
{
  WorkSteps steps(exchange.progress(), statistics);
  steps.begin(0.2, 0.5, "seconds projection");
  const BoundaryProjector& projector = classified.projector;
  const auto ofEdges = classesOfEdges(exchange, plan, classified);
  auto hits =
    projectMidpoints(exchange, mesh.mesh(), plan, ofEdges, classified, classification, statistics);
  const auto ofQuads = classesOfQuads(exchange, plan.table, plan.quads, classified);
  const std::vector<Index> quads = quadsCutInFour(plan.quads.table, plan.marks);
  const auto edges = static_cast<std::size_t>(std::count(plan.marks.begin(), plan.marks.end(), 1));
  projectQuads(
    exchange, mesh.mesh(), { plan.quads, quads, ofQuads, edges }, classified, classification, hits);
  auto onBoundary =
    onRefinedBoundary(plan, ofEdges, quads, ofQuads, classified.boundary.onBoundary);
  const std::size_t oldCount = mesh.mesh().points.size();
  steps.end();
  RefinementTrace trace = refine(exchange, mesh, plan, statistics);
  onBoundary.resize(mesh.mesh().points.size(), 0); // others are inside cells
  steps.begin(0.7, 1, "seconds moves");
  trace.projectedPoints = countHits(exchange, mesh.shared, oldCount, hits);
  if (settings.newVertices == NewVertices::StayStraight)
  {
    classifyMidpoints(hits, mesh.mesh().points.size(), classification);
    trace.onBoundary = std::move(onBoundary);
    return { std::move(trace), {} };
  }
  Moves moves = movesOntoCAD(mesh.mesh(), projector, classification);
  classifyMidpoints(hits, mesh.mesh().points.size(), classification);
  for (const MidpointOnCAD& hit : hits)
  {
    moves.add(static_cast<Index>(oldCount + hit.place), hit.where.point);
  }
  const auto tags = tagsOfChildren(mesh.mesh().dimension, trace, settings.tags);
  MotionTrace motion = moveOntoCAD(exchange, mesh, std::move(moves), classification,
    { projector, onBoundary, tags, settings.newVertices == NewVertices::MoveAndMend, true,
      plan.withOperations, &trace.parentEdges });
  trace.onBoundary = std::move(onBoundary);
  return { std::move(trace), std::move(motion) };
}

} // namespace cadrefine
