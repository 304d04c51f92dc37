#include "operations/BlockOperations.h"

#include "comm/CollectiveErrors.h"
#include "refinement/DistributedRefinement.h"

#include <cadrefine/motion/MoveGuard.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace cadrefine
{
namespace
{

constexpr std::int64_t noBlock = -1;
constexpr std::int64_t manyBlocks = -2;

std::int64_t joined(std::int64_t a, std::int64_t b)
{
  constexpr std::int64_t unknown = std::numeric_limits<std::int64_t>::max();
  if (a == unknown || b == unknown || a == b)
  {
    return std::min(a, b);
  }
  return manyBlocks;
}

/// The block that all cells at a vertex, of all ranks, are of; none, or many, where it stays.
std::vector<std::int64_t> blocksOfVertices(
  RankExchange& exchange, const DistributedMesh& mesh, const std::vector<std::int64_t>& ofCells)
{
  std::vector<std::int64_t> result(
    mesh.mesh().points.size(), std::numeric_limits<std::int64_t>::max());
  const auto& cells = mesh.mesh().tetrahedra;
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    for (const Index vertex : cells[c])
    {
      result[vertex] = joined(result[vertex], ofCells[c]);
    }
  }
  for (const auto& [vertex] : mesh.mesh().vertices)
  {
    result[vertex] = manyBlocks; // it is listed
  }
  combineShared(exchange, mesh.shared, result, joined);
  return result;
}

/// The cells of the lower dimension that have a vertex within a block.
template<std::size_t Corners>
std::int64_t blockOf(
  const std::array<Index, Corners>& corners, const std::vector<std::int64_t>& ofVertices)
{
  for (const Index vertex : corners)
  {
    if (ofVertices[vertex] >= 0)
    {
      return ofVertices[vertex];
    }
  }
  return noBlock;
}

/// Numbers of things that belong to a block.
struct Members
{
  std::vector<Index> cells;
  std::vector<Index> facets; ///< Of the boundary.
  std::vector<Index> triangles;
  std::vector<Index> segments;
};

/// A block as a mesh of its own.
class BlockMesh
{
public:
  /// `blocksOfVertices`: negative for those that stay.
  BlockMesh(const DistributedMesh& mesh, const std::vector<std::int64_t>& blocksOfVertices,
    const Classification& classification, const ClassifiedBoundary& boundary,
    const CellLabels& labels)
    : mesh_(mesh.mesh()), blocksOfVertices_(blocksOfVertices), classification_(classification),
      boundary_(boundary), labels_(labels)
  {
  }

  void fill(const Members& members, const std::vector<GlobalId>& cellIds)
  {
    std::vector<Index> cells = members.cells;
    std::sort(
      cells.begin(), cells.end(), [&](Index a, Index b) { return cellIds[a] < cellIds[b]; });
    for (const Index cell : cells)
    {
      const auto& corners = mesh_.tetrahedra[cell];
      vertices_.insert(vertices_.end(), corners.begin(), corners.end());
    }
    std::sort(vertices_.begin(), vertices_.end(),
      [&](Index a, Index b) { return mesh_.ids[a] < mesh_.ids[b]; });
    vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
    for (std::size_t v = 0; v < vertices_.size(); ++v)
    {
      numbers_.emplace(vertices_[v], static_cast<Index>(v));
      block_.addVertex(vertexOf(vertices_[v]));
    }
    for (const Index cell : cells)
    {
      block_.addCell({ localCorners(mesh_.tetrahedra[cell]), labels_.ofTetrahedra[cell], cell });
    }
    addFacets(members);
    addSegments(members);
    block_.closeFacets();
  }

  EditableMesh& mesh() { return block_; }
  /// Of the whole piece, by those here.
  const std::vector<Index>& vertices() const { return vertices_; }

private:
  EditableMesh::Vertex vertexOf(Index v) const
  {
    EditableMesh::Vertex vertex{ mesh_.points[v], mesh_.points[v], classification_.entities[v],
      classification_.entities[v].dimension == 0, blocksOfVertices_[v] < 0 };
    if (classification_.distances[v] > 0)
    {
      vertex.wanted = boundary_.projector.nearestOn(vertex.entity, vertex.point).point;
    }
    return vertex;
  }

  template<std::size_t Corners>
  std::array<Index, Corners> localCorners(std::array<Index, Corners> corners) const
  {
    for (Index& vertex : corners)
    {
      vertex = numbers_.at(vertex);
    }
    return corners;
  }

  template<std::size_t Corners>
  static std::array<Index, Corners> sorted(std::array<Index, Corners> corners)
  {
    std::sort(corners.begin(), corners.end());
    return corners;
  }

  /// In the order of their corners. Those that are not on the CAD, and listed ones inside the mesh,
  /// have labels of their own, so that they stay.
  void addFacets(const Members& members)
  {
    std::map<std::array<Index, 3>, LabelledSimplex<3>> facets;
    for (const Index f : members.facets)
    {
      const auto corners = localCorners(boundary_.boundary.facets[f].vertices);
      const bool onCAD = boundary_.classes.facets[f].onCAD != 0;
      facets[sorted(corners)] = { corners, onCAD ? 0 : -2 - f, -1 };
    }
    for (const Index t : members.triangles)
    {
      const auto corners = localCorners(mesh_.triangles[t]);
      const auto found = facets.find(sorted(corners));
      if (found == facets.end())
      {
        const auto f = static_cast<Index>(boundary_.boundary.facets.size()) + t;
        facets[sorted(corners)] = { corners, -2 - f, t };
        continue;
      }
      found->second.parent = t;
      found->second.label += found->second.label < 0 ? 0 : 1 + labels_.ofTriangles[t];
    }
    for (const auto& [key, facet] : facets)
    {
      block_.addFacet(facet);
    }
  }

  void addSegments(const Members& members)
  {
    const EdgeList& edges = boundary_.boundary.edges;
    std::map<std::array<Index, 2>, LabelledSimplex<2>> segments;
    for (const Index f : members.facets)
    {
      for (const Index e : boundary_.boundary.facetEdges[f])
      {
        const EdgeClass& edgeClass = boundary_.classes.ofEdges[e];
        if (edgeClass.kind != EdgeClass::Smooth)
        {
          const auto corners = sorted(localCorners(edges.edges()[e]));
          const bool isOnEdge = edgeClass.kind == EdgeClass::OnEdge;
          segments[corners] = { corners, isOnEdge ? edgeClass.edge : -1, -1 };
        }
      }
    }
    for (const Index s : members.segments)
    {
      const auto corners = sorted(localCorners(mesh_.segments[s]));
      const auto [place, isNew] =
        segments.try_emplace(corners, LabelledSimplex<2>{ corners, -1, s });
      place->second.parent = s;
    }
    for (const auto& [key, segment] : segments)
    {
      block_.addSegment(segment);
    }
  }

  const SimplexMesh& mesh_;
  const std::vector<std::int64_t>& blocksOfVertices_;
  const Classification& classification_;
  const ClassifiedBoundary& boundary_;
  const CellLabels& labels_;
  EditableMesh block_;
  std::vector<Index> vertices_;
  std::map<Index, Index> numbers_;
};

/// A simplex of the new mesh and what it comes from.
template<std::size_t Corners>
struct Descendant
{
  Index parent;
  std::array<Index, Corners> corners;
};

/// Puts a piece together anew from what is left of it and what blocks made.
class PieceMaker
{
public:
  explicit PieceMaker(const SimplexMesh& mesh) : mesh_(mesh), points_(mesh.points) {}

  /// Cells that are in no block.
  void keep(const Members& others)
  {
    const auto keepAll = [](const auto& cells, const std::vector<Index>& kept, auto& into)
    {
      for (const Index cell : kept)
      {
        into.push_back({ cell, cells[cell] });
      }
    };
    keepAll(mesh_.tetrahedra, others.cells, tetrahedra_);
    keepAll(mesh_.triangles, others.triangles, triangles_);
    keepAll(mesh_.segments, others.segments, segments_);
  }

  void add(const BlockMesh& block, const EditableMesh& result,
    const std::vector<AddedVertex>& addedVertices, std::int64_t number)
  {
    std::vector<Index> vertices = block.vertices();
    for (std::size_t v = 0; v < vertices.size(); ++v)
    {
      points_[vertices[v]] = result.vertex(static_cast<Index>(v)).point;
    }
    for (const AddedVertex& vertex : addedVertices)
    {
      points_.push_back(result.vertex(static_cast<Index>(vertices.size())).point);
      vertices.push_back(static_cast<Index>(points_.size()) - 1);
      std::array<Index, 2> ends{ vertices[vertex.parents[0]], vertices[vertex.parents[1]] };
      if (comesBefore(ends[1], ends[0]))
      {
        std::swap(ends[0], ends[1]);
      }
      parents_.push_back(ends);
      places_.push_back(vertex.where);
      blocks_.push_back(number);
    }
    const auto take = [&](const auto& store, auto& into)
    {
      for (std::size_t s = 0; s < store.size(); ++s)
      {
        const auto simplex = static_cast<Index>(s);
        if (store.exists(simplex) && store[simplex].parent >= 0)
        {
          auto corners = store[simplex].corners;
          std::transform(
            corners.begin(), corners.end(), corners.begin(), [&](Index v) { return vertices[v]; });
          into.push_back({ store[simplex].parent, corners });
        }
      }
    };
    take(result.cells(), tetrahedra_);
    take(result.facets(), triangles_);
    take(result.segments(), segments_);
  }

  /// Of the new vertices, in the order of their numbers.
  const std::vector<std::array<Index, 2>>& parents() const { return parents_; }
  const std::vector<ClosestPoint>& places() const { return places_; }
  const std::vector<std::int64_t>& blocks() const { return blocks_; }

  /// With all vertices, also those that no cell has any more; no ids of new ones.
  SimplexMesh make(ChildRanges& firstChildren)
  {
    SimplexMesh result;
    result.dimension = mesh_.dimension;
    result.points = points_;
    result.ids = mesh_.ids;
    result.vertices = mesh_.vertices;
    firstChildren[0].resize(mesh_.vertices.size() + 1);
    std::iota(firstChildren[0].begin(), firstChildren[0].end(), 0);
    order(segments_, mesh_.segments.size(), result.segments, firstChildren[1]);
    order(triangles_, mesh_.triangles.size(), result.triangles, firstChildren[2]);
    order(tetrahedra_, mesh_.tetrahedra.size(), result.tetrahedra, firstChildren[3]);
    return result;
  }

private:
  /// By ids, which grow with the numbers of new vertices.
  bool comesBefore(Index a, Index b) const
  {
    const auto old = static_cast<Index>(mesh_.ids.size());
    return a < old && b < old ? mesh_.ids[a] < mesh_.ids[b] : a < b;
  }

  template<std::size_t Corners>
  static void order(std::vector<Descendant<Corners>>& descendants, std::size_t parentCount,
    Simplices<Corners>& cells, std::vector<Index>& firsts)
  {
    std::stable_sort(descendants.begin(), descendants.end(),
      [](const auto& a, const auto& b) { return a.parent < b.parent; });
    firsts.assign(parentCount + 1, 0);
    for (const auto& descendant : descendants)
    {
      cells.push_back(descendant.corners);
      ++firsts[descendant.parent + 1];
    }
    std::partial_sum(firsts.begin(), firsts.end(), firsts.begin());
  }

  const SimplexMesh& mesh_;
  std::vector<Point3> points_;
  std::vector<std::array<Index, 2>> parents_;
  std::vector<ClosestPoint> places_;
  std::vector<std::int64_t> blocks_;
  std::vector<Descendant<4>> tetrahedra_;
  std::vector<Descendant<3>> triangles_;
  std::vector<Descendant<2>> segments_;
};

/// Ids of new vertices: by the order of their blocks, and in a block by that in which they came.
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

/// The vertices that cells have, ascending.
std::vector<Index> usedVertices(const SimplexMesh& mesh)
{
  std::vector<unsigned char> used(mesh.points.size(), 0);
  const auto mark = [&](const auto& cells)
  {
    for (const auto& cell : cells)
    {
      for (const Index vertex : cell)
      {
        used[vertex] = 1;
      }
    }
  };
  mark(mesh.tetrahedra);
  mark(mesh.triangles);
  mark(mesh.segments);
  mark(mesh.vertices);
  std::vector<Index> result;
  for (std::size_t v = 0; v < used.size(); ++v)
  {
    if (used[v])
    {
      result.push_back(static_cast<Index>(v));
    }
  }
  return result;
}

template<class T>
void keepOnly(const std::vector<Index>& kept, std::vector<T>& list)
{
  for (std::size_t i = 0; i < kept.size(); ++i)
  {
    list[i] = list[kept[i]];
  }
  list.resize(kept.size());
}

/// Takes vertices out of a mesh that no cell of it has. Those of other ranks stay.
void dropVertices(
  const std::vector<Index>& kept, DistributedMesh& mesh, Classification& classification)
{
  SimplexMesh& cells = mesh.mesh();
  std::vector<Index> numbers(cells.points.size(), -1);
  for (std::size_t i = 0; i < kept.size(); ++i)
  {
    numbers[kept[i]] = static_cast<Index>(i);
  }
  const auto renumber = [&](auto& list)
  {
    for (auto& cell : list)
    {
      for (Index& vertex : cell)
      {
        vertex = numbers[vertex];
      }
    }
  };
  renumber(cells.tetrahedra);
  renumber(cells.triangles);
  renumber(cells.segments);
  renumber(cells.vertices);
  keepOnly(kept, cells.points);
  keepOnly(kept, cells.ids);
  keepOnly(kept, classification.entities);
  keepOnly(kept, classification.parameters);
  keepOnly(kept, classification.distances);
  auto items = mesh.shared.items;
  renumber(items);
  mesh.shared = makeSharedItems(mesh.shared.rank, mesh.shared.neighbours, std::move(items));
}

/// What each block has, and what is in none.
std::pair<std::map<std::int64_t, Members>, Members> findMembers(const DistributedMesh& mesh,
  const std::vector<std::int64_t>& ofCells, const std::vector<std::int64_t>& ofVertices,
  const DistributedBoundary& boundary)
{
  std::map<std::int64_t, Members> members;
  Members others;
  const auto sort = [&](std::int64_t block, std::vector<Index> Members::*list, std::size_t number)
  { ((block >= 0 ? members[block] : others).*list).push_back(static_cast<Index>(number)); };
  for (std::size_t c = 0; c < ofCells.size(); ++c)
  {
    sort(ofCells[c], &Members::cells, c);
  }
  for (std::size_t f = 0; f < boundary.facets.size(); ++f)
  {
    sort(ofCells[boundary.facets[f].cell], &Members::facets, f);
  }
  const SimplexMesh& cells = mesh.mesh();
  for (std::size_t t = 0; t < cells.triangles.size(); ++t)
  {
    sort(blockOf(cells.triangles[t], ofVertices), &Members::triangles, t);
  }
  for (std::size_t s = 0; s < cells.segments.size(); ++s)
  {
    sort(blockOf(cells.segments[s], ofVertices), &Members::segments, s);
  }
  return { std::move(members), std::move(others) };
}

OperationCounts sum(RankExchange& exchange, const OperationCounts& counts)
{
  const auto sums = exchange.sum(std::vector<std::int64_t>{ counts.edgeRemovals,
    counts.faceRemovals, counts.collapses, counts.splits, counts.moves, counts.cells });
  return { sums[0], sums[1], sums[2], sums[3], sums[4], sums[5] };
}

void add(const OperationCounts& counts, OperationCounts& all)
{
  all.edgeRemovals += counts.edgeRemovals;
  all.faceRemovals += counts.faceRemovals;
  all.collapses += counts.collapses;
  all.splits += counts.splits;
  all.moves += counts.moves;
  all.cells += counts.cells;
}

} // namespace

OperationBlocks findOperationBlocks(RankExchange& exchange, const DistributedMesh& mesh,
  std::vector<unsigned char> flags, const BlockSettings& settings, const ParallelFor& parallelFor)
{
  const auto larger = [](unsigned char a, unsigned char b) { return std::max(a, b); };
  const SimplexMesh& piece = mesh.mesh();
  combineShared(exchange, mesh.shared, flags, larger);
  for (int ring = 1; ring < settings.rings; ++ring)
  {
    flagVertices(piece, cellsAt(piece, flags, parallelFor), flags);
    combineShared(exchange, mesh.shared, flags, larger);
  }
  std::vector<Index> cells = cellsAt(piece, flags, parallelFor);
  cells.erase(std::remove_if(cells.begin(), cells.end(),
                [&](Index cell) { return !settings.mayChange(piece.tetrahedra[cell]); }),
    cells.end());
  std::vector<Point3> centres;
  centres.reserve(cells.size());
  for (const Index cell : cells)
  {
    const auto& [a, b, c, d] = piece.tetrahedra[cell];
    centres.push_back(
      0.25 * (piece.points[a] + piece.points[b] + piece.points[c] + piece.points[d]));
  }
  const Blocks found =
    findBlocks(exchange, centres, findBounds(exchange, piece), settings.round, settings.largest);
  OperationBlocks blocks{ std::vector<std::int64_t>(piece.tetrahedra.size(), noBlock),
    found.sizes };
  for (std::size_t i = 0; i < cells.size(); ++i)
  {
    blocks.ofCells[cells[i]] = found.ofPoints[i];
  }
  return blocks;
}

std::vector<int> ranksOfBlocks(
  RankExchange& exchange, const DistributedMesh& mesh, const OperationBlocks& blocks)
{
  const std::int64_t here = exchange.rank();
  const auto ofVertices = blocksOfVertices(exchange, mesh, blocks.ofCells);
  const SimplexMesh& piece = mesh.mesh();
  std::vector<std::int64_t> lowest(blocks.sizes.size(), exchange.size());
  std::vector<std::int64_t> highest(blocks.sizes.size(), -1);
  std::vector<std::int64_t> ofCells(piece.vertices.size(), noBlock);
  for (const auto& segment : piece.segments)
  {
    ofCells.push_back(blockOf(segment, ofVertices));
  }
  for (const auto& triangle : piece.triangles)
  {
    ofCells.push_back(blockOf(triangle, ofVertices));
  }
  ofCells.insert(ofCells.end(), blocks.ofCells.begin(), blocks.ofCells.end());
  for (const std::int64_t block : ofCells)
  {
    if (block >= 0)
    {
      lowest[block] = here;
      highest[block] = here;
    }
  }
  if (exchange.min(lowest) == exchange.max(highest))
  {
    return {};
  }
  const std::vector<int> owners = ownersOf(blocks.sizes, exchange.size());
  std::vector<int> ranks;
  ranks.reserve(ofCells.size());
  for (const std::int64_t block : ofCells)
  {
    ranks.push_back(block >= 0 ? owners[block] : exchange.rank());
  }
  return ranks;
}

OperationTrace operateOnBlocks(RankExchange& exchange, DistributedMesh& mesh,
  Classification& classification, const ClassifiedBoundary& boundary, const OperationTask& task,
  const ParallelFor& parallelFor)
{
  const auto ofVertices = blocksOfVertices(exchange, mesh, task.blocks.ofCells);
  const auto [members, others] =
    findMembers(mesh, task.blocks.ofCells, ofVertices, boundary.boundary);
  const SurfaceRule rule(boundary.projector);
  std::vector<std::pair<std::int64_t, const Members*>> list;
  for (const auto& [number, ofBlock] : members)
  {
    list.emplace_back(number, &ofBlock);
  }
  std::vector<BlockMesh> meshes(
    list.size(), BlockMesh(mesh, ofVertices, classification, boundary, task.labels));
  std::vector<ImprovementResult> results(list.size());
  agreeOnFailure(exchange,
    [&]
    {
      forEachIndex(parallelFor, list.size(), 1,
        [&](std::size_t i)
        {
          meshes[i].fill(*list[i].second, mesh.converted.cellIds[3]);
          results[i] = improveCells(meshes[i].mesh(), &rule, task.limits);
        });
    });

  OperationTrace trace;
  PieceMaker maker(mesh.mesh());
  maker.keep(others);
  for (std::size_t i = 0; i < list.size(); ++i)
  {
    maker.add(meshes[i], meshes[i].mesh(), results[i].added, list[i].first);
    add(results[i].counts, trace.counts);
  }
  trace.counts = sum(exchange, trace.counts);
  SimplexMesh made = maker.make(trace.cells.firstChildren);
  numberNewVertices(exchange, maker.blocks(), task.blocks.sizes.size(), mesh, made.ids);
  mesh.converted.cellIds = numberChildren(exchange, mesh, trace.cells.firstChildren);
  trace.cells.parentEdges = maker.parents();
  const std::size_t oldCount = mesh.mesh().points.size();
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
  trace.keptVertices = usedVertices(mesh.mesh());
  dropVertices(trace.keptVertices, mesh, classification);
  return trace;
}

} // namespace cadrefine
