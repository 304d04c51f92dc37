#include "operations/BlockOperations.h"

#include "comm/CollectiveErrors.h"
#include "mesh/MeshPlane.h"
#include "operations/BlockMesh.h"
#include "operations/Blocks.h"
#include "operations/PieceMaker.h"
#include "operations/VertexBlocks.h"
#include "refinement/DistributedRefinement.h"

#include <cadrefine/base/IndicesWhere.h>
#include <cadrefine/base/LargeMemory.h>
#include <cadrefine/mesh/VertexFlags.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <numeric>
#include <utility>

namespace cadrefine
{
namespace
{

/// Appends the ids of new vertices: in the order of their blocks, and within a block in the order
/// in which they were made.
void numberNewVertices(RankExchange& exchange, const std::vector<std::int64_t>& blocks,
  std::size_t blockCount, DistributedMesh& mesh, std::vector<GlobalId>& ids)
{
  std::vector<std::int64_t> counts(blockCount, 0);
  for (const std::int64_t block : blocks)
  {
    ++counts[block];
  }
  counts = exchange.sum(counts);
  std::vector<GlobalId> next(counts.size());
  std::exclusive_scan(counts.begin(), counts.end(), next.begin(), mesh.vertexIdBound);
  for (const std::int64_t block : blocks)
  {
    ids.push_back(next[block]++);
  }
  mesh.vertexIdBound += std::accumulate(counts.begin(), counts.end(), std::int64_t{ 0 });
}

/// The shared vertices that are still shared, by their new `numbers`, which are below 0 for
/// vertices without cells here. Collective.
SharedVertices sharedOfKept(
  RankExchange& exchange, const DistributedMesh& mesh, const std::vector<Index>& numbers)
{
  const SharedVertices& shared = mesh.shared;
  std::vector<Index> left;
  for (const Index vertex : shared.all)
  {
    if (numbers[vertex] >= 0)
    {
      left.push_back(numbers[vertex]);
    }
  }
  if (exchange.any(left.size() < shared.all.size()))
  {
    return findSharedVertices(exchange, mesh.mesh().ids, left);
  }
  auto items = shared.items;
  for (auto& list : items)
  {
    std::transform(
      list.begin(), list.end(), list.begin(), [&](Index vertex) { return numbers[vertex]; });
  }
  return makeSharedItems(shared.rank, shared.neighbours, std::move(items));
}

/// Takes vertices out of a mesh that no cell of it has, though cells of other ranks may have them.
/// Collective.
void dropVertices(RankExchange& exchange, const std::vector<Index>& kept, DistributedMesh& mesh,
  Classification& classification)
{
  const std::vector<Index> numbers = keepVertices(kept, mesh.mesh());
  keepOnly(kept, classification.entities);
  keepOnly(kept, classification.parameters);
  keepOnly(kept, classification.distances);
  mesh.shared = sharedOfKept(exchange, mesh, numbers);
}

/// Gives vertices that moved along the CAD the parameters of their new places.
void moveParameters(const std::vector<Point3>& before, const std::vector<Point3>& after,
  const BoundaryProjector& projector, Classification& classification)
{
  for (std::size_t v = 0; v < before.size(); ++v)
  {
    const EntityId entity = classification.entities[v];
    if (entity && before[v] != after[v])
    {
      classification.parameters[v] = projector.nearestOn(entity, after[v]).parameters;
    }
  }
}

/// What belongs to each block, and what belongs to none.
std::pair<std::map<std::int64_t, Members>, Members> findMembers(const DistributedMesh& mesh,
  const std::vector<std::int64_t>& ofCells, const std::vector<std::int64_t>& ofVertices,
  const DistributedBoundary& boundary)
{
  std::map<std::int64_t, Members> members;
  Members others;
  reserveLong(others.cells, ofCells.size());
  const auto sort = [&](std::int64_t block, std::vector<Index> Members::*list, std::size_t number)
  { ((block >= 0 ? members[block] : others).*list).push_back(static_cast<Index>(number)); };
  for (std::size_t c = 0; c < countOwnSimplices(mesh.mesh()); ++c)
  {
    sort(ofCells[c], &Members::cells, c);
  }
  for (std::size_t f = 0; f < boundary.facets.size(); ++f)
  {
    sort(ofCells[boundary.facets[f].cell], &Members::facets, f);
  }
  const Mesh& cells = mesh.mesh();
  for (std::size_t t = 0; t < listedTriangles(cells); ++t)
  {
    sort(blockOf(cells.triangles[t], ofVertices), &Members::triangles, t);
  }
  for (std::size_t s = 0; s < cells.segments.size(); ++s)
  {
    sort(blockOf(cells.segments[s], ofVertices), &Members::segments, s);
  }
  return { std::move(members), std::move(others) };
}

template<std::size_t Corners>
std::vector<Point3> centresOf(
  const Cells<Corners>& all, const std::vector<Index>& cells, const std::vector<Point3>& points)
{
  std::vector<Point3> centres;
  centres.reserve(cells.size());
  for (const Index cell : cells)
  {
    Point3 sum = points[all[cell][0]];
    for (std::size_t k = 1; k < Corners; ++k)
    {
      sum = sum + points[all[cell][k]];
    }
    centres.push_back((1.0 / Corners) * sum);
  }
  return centres;
}

} // namespace

OperationBlocks findOperationBlocks(RankExchange& exchange, const DistributedMesh& mesh,
  std::vector<unsigned char> flags, const BlockSettings& settings, const ParallelFor& parallelFor)
{
  const Mesh& piece = mesh.mesh();
  flagRings(exchange, mesh, settings.rings - 1, flags, parallelFor);
  std::vector<Index> cells =
    cellsOfShape(cellsAt(piece, flags, parallelFor), 0, countOwnSimplices(piece));
  cells.erase(std::remove_if(
                cells.begin(), cells.end(), [&](Index cell) { return !settings.mayChange(cell); }),
    cells.end());
  const std::vector<Point3> centres =
    visitOwnSimplices(piece, [&](const auto& all) { return centresOf(all, cells, piece.points); });
  const Blocks found =
    findBlocks(exchange, centres, findBox(exchange, piece), settings.round, settings.largest);
  const std::size_t count = mesh.converted.cellIds[piece.dimension].size();
  OperationBlocks blocks{ std::vector<std::int64_t>(count, noBlock), found.sizes };
  for (std::size_t i = 0; i < cells.size(); ++i)
  {
    blocks.ofCells[cells[i]] = found.ofPoints[i];
  }
  return blocks;
}

std::vector<int> ranksOfBlocks(
  RankExchange& exchange, const DistributedMesh& mesh, const OperationBlocks& blocks)
{
  if (exchange.size() == 1)
  {
    return {};
  }
  const auto ofVertices = blocksOfVertices(exchange, mesh, blocks.ofCells);
  const Mesh& piece = mesh.mesh();
  std::vector<std::int64_t> ofCells(piece.vertices.size(), noBlock);
  for (const auto& segment : piece.segments)
  {
    ofCells.push_back(blockOf(segment, ofVertices));
  }
  for (std::size_t t = 0; t < listedTriangles(piece); ++t)
  {
    ofCells.push_back(blockOf(piece.triangles[t], ofVertices));
  }
  ofCells.resize(firstCellOfDimension(piece, piece.dimension), noBlock); // listed quadrilaterals
  ofCells.insert(ofCells.end(), blocks.ofCells.begin(), blocks.ofCells.end());
  // How many cells of each block a rank has, and the rank, in one number: the largest is that of
  // the rank with most.
  const std::int64_t size = exchange.size();
  const std::int64_t here = size - 1 - exchange.rank();
  std::vector<std::int64_t> shares(blocks.sizes.size(), here);
  for (const std::int64_t block : ofCells)
  {
    if (block >= 0)
    {
      shares[block] += size;
    }
  }
  shares = exchange.max(shares);
  std::vector<int> ranks;
  ranks.reserve(ofCells.size());
  for (const std::int64_t block : ofCells)
  {
    ranks.push_back(
      block >= 0 ? static_cast<int>(size - 1 - shares[block] % size) : exchange.rank());
  }
  const bool moves =
    std::any_of(ranks.begin(), ranks.end(), [&](int rank) { return rank != exchange.rank(); });
  return exchange.any(moves) ? ranks : std::vector<int>{};
}

OperationTrace operateOnBlocks(RankExchange& exchange, DistributedMesh& mesh,
  Classification& classification, const ClassifiedBoundary& boundary, const OperationTask& task,
  const ParallelFor& parallelFor)
{
  auto ofVertices = blocksOfVertices(exchange, mesh, task.blocks.ofCells);
  holdStrays(exchange, mesh, task.blocks.ofCells, ofVertices);
  markBesideOthers(exchange, mesh, ofVertices);
  const auto [members, others] =
    findMembers(mesh, task.blocks.ofCells, ofVertices, boundary.boundary);
  std::vector<std::pair<std::int64_t, const Members*>> list;
  for (const auto& [number, ofBlock] : members)
  {
    list.emplace_back(number, &ofBlock);
  }
  const Vector3 plane =
    planeNormal(exchange, mesh.mesh(), boundary.boundary.kind == BoundaryKind::Edges);
  std::vector<BlockMesh> meshes(list.size(),
    BlockMesh(mesh, task.wanted, plane, ofVertices, classification, boundary, task.labels));
  std::vector<OperationResult> results(list.size());
  std::vector<FieldRows> rows(list.size());
  std::vector<double> seconds(list.size(), 0);
  agreeOnFailure(exchange,
    [&]
    {
      forEachIndex(parallelFor, list.size(), 1,
        [&](std::size_t i)
        {
          meshes[i].fill(*list[i].second, mesh.converted.cellIds[mesh.mesh().dimension]);
          const MeshBefore before = meshes[i].before();
          const auto start = std::chrono::steady_clock::now();
          results[i] = task.work(meshes[i], SurfaceRule(boundary.projector));
          seconds[i] =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
          rows[i] = findFieldRows(meshes[i].mesh(), before, task.rows);
        });
    });

  OperationTrace trace;
  trace.seconds = std::accumulate(seconds.begin(), seconds.end(), 0.0);
  for (const OperationResult& result : results)
  {
    trace.operations += result.counts.operations();
  }
  trace.operations = exchange.sum(trace.operations);
  if (trace.operations == 0)
  {
    return trace;
  }
  PieceMaker maker(mesh.mesh(), others);
  for (std::size_t i = 0; i < list.size(); ++i)
  {
    maker.add(meshes[i], results[i].added, rows[i], list[i].first);
  }
  Mesh made = maker.make(trace.cells);
  numberNewVertices(exchange, maker.blocks(), task.blocks.sizes.size(), mesh, made.ids);
  mesh.converted.cellIds = numberChildren(exchange, mesh, trace.cells);
  const std::size_t oldCount = mesh.mesh().points.size();
  agreeOnFailure(exchange,
    [&] { moveParameters(mesh.mesh().points, made.points, boundary.projector, classification); });
  mesh.mesh() = std::move(made);
  mesh.converted.pointOf.clear();
  mesh.converted.cellOf = {};
  classification.resize(mesh.mesh().points.size());
  for (std::size_t n = 0; n < maker.places().size(); ++n)
  {
    const ClosestPoint& where = maker.places()[n];
    if (where.entity)
    {
      const auto vertex = static_cast<Index>(oldCount + n);
      classification.set(vertex, where);
      classification.distances[vertex] = distance(mesh.mesh().points[vertex], where.point);
    }
  }
  trace.onBoundary = maker.onBoundary();
  trace.keptVertices = usedVertices(mesh.mesh());
  dropVertices(exchange, trace.keptVertices, mesh, classification);
  return trace;
}

} // namespace cadrefine
