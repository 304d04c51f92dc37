#include "motion/Untangling.h"

#include "comm/Threads.h"

#include <cadrefine/base/IndicesWhere.h>
#include <cadrefine/base/SortUniquely.h>
#include <cadrefine/mesh/VertexFlags.h>
#include <cadrefine/motion/PatchOptimiser.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <type_traits>
#include <unordered_map>

namespace cadrefine
{
namespace
{

/// The cells round free vertices, with the vertices of this rank first.
struct LocalPatch
{
  Patch patch;
  /// Mesh vertex of each of the patch's vertices that this rank holds.
  std::vector<Index> meshVertex;
  /// Patch vertex of each of the mesh's vertices; -1: it is not in the patch.
  std::vector<Index> patchVertex;
};

LocalPatch makePatch(const Mesh& mesh, const MovingVertices& vertices, const Vector3& plane)
{
  LocalPatch local{ {}, {}, std::vector<Index>(mesh.points.size(), -1) };
  Patch& patch = local.patch;
  patch.mesh.dimension = mesh.dimension;
  patch.plane = plane;
  patch.fairQuality = vertices.fairQuality;
  const auto patchVertex = [&](Index meshVertex)
  {
    Index& vertex = local.patchVertex[meshVertex];
    if (vertex < 0)
    {
      vertex = static_cast<Index>(local.meshVertex.size());
      local.meshVertex.push_back(meshVertex);
      patch.mesh.ids.push_back(mesh.ids[meshVertex]);
      patch.mesh.points.push_back(vertices.wanted[meshVertex]);
      patch.start.push_back(vertices.start[meshVertex]);
      patch.free.push_back(vertices.free[meshVertex]);
      patch.complete.push_back(1);
      patch.entities.push_back(vertices.entities[meshVertex]);
    }
    return vertex;
  };
  const auto add = [&](auto simplex, bool keepsShape)
  {
    if (std::any_of(simplex.begin(), simplex.end(), [&](Index v) { return vertices.free[v] != 0; }))
    {
      std::transform(simplex.begin(), simplex.end(), simplex.begin(), patchVertex);
      if constexpr (simplex.size() == 4)
      {
        patch.mesh.tetrahedra.push_back(simplex);
      }
      else
      {
        patch.mesh.triangles.push_back(simplex);
      }
      patch.keepsShape.push_back(keepsShape);
    }
  };
  std::size_t first = 0;
  visitOwnShapes(mesh,
    [&](auto shape, const auto& cells)
    {
      for (const Index c : cellsOfShape(vertices.cells, first, cells.size()))
      {
        if constexpr (isSimplex(shape))
        {
          add(cells[c], false);
        }
        else
        {
          constexpr bool isPyramid = std::is_same_v<decltype(shape), shapes::Pyramid>;
          for (const auto& corners : decltype(shape)::cornerSimplices)
          {
            std::array<Index, decltype(shape)::dimension + 1> simplex;
            std::transform(std::begin(corners), std::end(corners), simplex.begin(),
              [&](int corner) { return cells[c][corner]; });
            add(simplex, !isPyramid);
          }
        }
      }
      first += cells.size();
    });
  return local;
}

/// A cell as another rank needs it: the mesh's own dimension tells how many corners count.
struct CellRecord
{
  std::array<GlobalId, 4> ids{};
  std::array<Point3, 4> wanted{};
  std::array<Point3, 4> start{};
  std::array<unsigned char, 4> free{};
  std::int64_t keepsShape = 0;
};

template<std::size_t Corners>
CellRecord recordOf(const std::array<Index, Corners>& cell, bool keepsShape, const Patch& patch)
{
  CellRecord record;
  record.keepsShape = keepsShape;
  for (std::size_t k = 0; k < Corners; ++k)
  {
    const Index vertex = cell[k];
    record.ids[k] = patch.mesh.ids[vertex];
    record.wanted[k] = patch.mesh.points[vertex];
    record.start[k] = patch.start[vertex];
    record.free[k] = patch.free[vertex];
  }
  return record;
}

/// For each neighbour the records of the patch's cells at a vertex that it shares, given the
/// neighbours of each vertex.
template<std::size_t Corners>
void collectRecords(const Cells<Corners>& cells, const Patch& patch,
  const std::vector<std::vector<int>>& neighboursOf, std::vector<std::vector<CellRecord>>& toOthers)
{
  std::vector<int> receivers;
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    receivers.clear();
    for (const Index vertex : cells[c])
    {
      const auto& neighbours = neighboursOf[vertex];
      receivers.insert(receivers.end(), neighbours.begin(), neighbours.end());
    }
    sortUniquely(receivers);
    for (const int n : receivers)
    {
      toOthers[n].push_back(recordOf(cells[c], patch.keepsShape[c] != 0, patch));
    }
  }
}

/// For each neighbour the cells at free vertices that it shares.
std::vector<std::vector<CellRecord>> cellsForOthers(
  const SharedVertices& shared, const std::vector<unsigned char>& free, const LocalPatch& local)
{
  // A rank may share a free vertex at which it has no cell of its own dimension.
  std::vector<std::vector<int>> neighboursOf(local.meshVertex.size());
  for (std::size_t n = 0; n < shared.neighbours.size(); ++n)
  {
    for (const Index vertex : shared.items[n])
    {
      if (free[vertex] && local.patchVertex[vertex] >= 0)
      {
        neighboursOf[local.patchVertex[vertex]].push_back(static_cast<int>(n));
      }
    }
  }
  std::vector<std::vector<CellRecord>> toOthers(shared.neighbours.size());
  visitOwnSimplices(local.patch.mesh,
    [&](const auto& cells) { collectRecords(cells, local.patch, neighboursOf, toOthers); });
  return toOthers;
}

/// Appends cells of other ranks, and those of their vertices that the patch does not have.
void appendCells(const std::vector<std::vector<CellRecord>>& fromOthers, Patch& patch)
{
  std::unordered_map<GlobalId, Index> known;
  for (std::size_t v = 0; v < patch.mesh.ids.size(); ++v)
  {
    known.emplace(patch.mesh.ids[v], static_cast<Index>(v));
  }
  const auto vertexOf = [&](const CellRecord& record, std::size_t k)
  {
    const auto [entry, isNew] =
      known.emplace(record.ids[k], static_cast<Index>(patch.mesh.ids.size()));
    if (isNew)
    {
      patch.mesh.ids.push_back(record.ids[k]);
      patch.mesh.points.push_back(record.wanted[k]);
      patch.start.push_back(record.start[k]);
      patch.free.push_back(record.free[k]);
      patch.complete.push_back(0);
      patch.entities.emplace_back();
    }
    return entry->second;
  };
  const auto append = [&](const CellRecord& record, auto& cells)
  {
    auto& cell = cells.emplace_back();
    for (std::size_t k = 0; k < cell.size(); ++k)
    {
      cell[k] = vertexOf(record, k);
    }
  };
  for (const auto& records : fromOthers)
  {
    for (const CellRecord& record : records)
    {
      visitOwnSimplices(patch.mesh, [&](auto& cells) { append(record, cells); });
      patch.keepsShape.push_back(record.keepsShape != 0);
    }
  }
}

SharedVertices findHolders(RankExchange& exchange, const Patch& patch)
{
  return findSharedVertices(exchange, patch.mesh.ids,
    indicesWhere(patch.free.size(), [&](std::size_t v) { return patch.free[v] != 0; }));
}

/// A vertex's place, and whether it has had its turn.
struct Placed
{
  Point3 point{};
  std::int64_t done = 0;
};

Placed pickUpdated(const Placed& a, const Placed& b)
{
  return a.done ? a : b;
}

/// Sweeps over the patches of all ranks as if they were one.
void sweep(RankExchange& exchange, const SharedVertices& shared, Patch& patch,
  const BoundaryProjector& projector, int sweeps)
{
  PatchOptimiser optimiser(patch, &projector, forOnThreads(exchange));
  for (int k = 0; k < sweeps; ++k)
  {
    optimiser.beginSweep(exchange.min(optimiser.smallestMeasure()));
    while (exchange.any(optimiser.advance()))
    {
      std::vector<Placed> places(patch.mesh.points.size());
      for (const Index vertex : shared.all)
      {
        places[vertex] = { patch.mesh.points[vertex], optimiser.isDone(vertex) };
      }
      combineShared(exchange, shared, places, pickUpdated);
      for (const Index vertex : shared.all)
      {
        if (places[vertex].done && !optimiser.isDone(vertex))
        {
          optimiser.place(vertex, places[vertex].point);
        }
      }
    }
  }
}

/// The places of this rank's free vertices: also ranks that hold a vertex, but none of the cells
/// round it, are to know where it is.
std::vector<VertexPlace> placesOfFree(RankExchange& exchange, const SharedVertices& sharedOfMesh,
  const std::vector<unsigned char>& free, const LocalPatch& local)
{
  std::vector<VertexPlace> result;
  for (std::size_t v = 0; v < local.meshVertex.size(); ++v)
  {
    if (local.patch.free[v])
    {
      result.push_back({ local.meshVertex[v], local.patch.mesh.points[v] });
    }
  }
  if (exchange.size() == 1)
  {
    return result;
  }
  std::vector<Placed> places(local.patchVertex.size());
  for (const VertexPlace& place : result)
  {
    places[place.vertex] = { place.point, 1 };
  }
  combineShared(exchange, sharedOfMesh, places, pickUpdated);
  for (const Index vertex : sharedOfMesh.all)
  {
    if (free[vertex] && local.patchVertex[vertex] < 0)
    {
      result.push_back({ vertex, places[vertex].point });
    }
  }
  return result;
}

} // namespace

std::vector<VertexPlace> untangle(RankExchange& exchange, const DistributedMesh& mesh,
  const MovingVertices& vertices, const Vector3& plane, const BoundaryProjector& projector,
  int sweeps)
{
  LocalPatch local = makePatch(mesh.mesh(), vertices, plane);
  SharedVertices shared;
  if (exchange.size() > 1)
  {
    const auto toOthers = cellsForOthers(mesh.shared, vertices.free, local);
    appendCells(exchange.exchange(mesh.shared.neighbours, toOthers), local.patch);
    shared = findHolders(exchange, local.patch);
  }
  sweep(exchange, shared, local.patch, projector, sweeps);
  return placesOfFree(exchange, mesh.shared, vertices.free, local);
}

} // namespace cadrefine
