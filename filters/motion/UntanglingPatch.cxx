#include "motion/UntanglingPatch.h"

#include "comm/Threads.h"

#include <algorithm>
#include <unordered_map>

namespace cadrefine
{
namespace
{

/// A cell as another rank needs it: the mesh's own dimension tells how many corners count.
struct CellRecord
{
  std::array<GlobalId, 4> ids{};
  std::array<Point3, 4> wanted{};
  std::array<Point3, 4> start{};
  std::array<unsigned char, 4> free{};
};

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

template<std::size_t Corners>
CellRecord recordOf(const std::array<Index, Corners>& cell, const Patch& patch)
{
  CellRecord record;
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
void collectRecords(const Simplices<Corners>& cells, const Patch& patch,
  const std::vector<std::vector<int>>& neighboursOf, std::vector<std::vector<CellRecord>>& toOthers)
{
  std::vector<int> receivers;
  for (const auto& cell : cells)
  {
    receivers.clear();
    for (const Index vertex : cell)
    {
      const auto& neighbours = neighboursOf[vertex];
      receivers.insert(receivers.end(), neighbours.begin(), neighbours.end());
    }
    std::sort(receivers.begin(), receivers.end());
    receivers.erase(std::unique(receivers.begin(), receivers.end()), receivers.end());
    for (const int n : receivers)
    {
      toOthers[n].push_back(recordOf(cell, patch));
    }
  }
}

template<std::size_t Corners, class VertexOf>
void appendCell(const CellRecord& record, const VertexOf& vertexOf, Simplices<Corners>& cells)
{
  auto& cell = cells.emplace_back();
  for (std::size_t k = 0; k < Corners; ++k)
  {
    cell[k] = vertexOf(record, k);
  }
}

} // namespace

UntanglingPatch::UntanglingPatch(RankExchange& exchange, const DistributedMesh& mesh,
  const MovingVertices& vertices, const Vector3& plane)
  : exchange_(exchange), sharedOfMesh_(mesh.shared), free_(vertices.free),
    patchVertex_(mesh.mesh().points.size(), -1)
{
  patch_.mesh.dimension = mesh.mesh().dimension;
  patch_.plane = plane;
  addOwnCells(mesh.mesh(), vertices);
  if (exchange.size() > 1)
  {
    addCellsOfOthers(mesh, vertices);
    findHolders();
  }
}

Index UntanglingPatch::localVertex(
  Index meshVertex, const SimplexMesh& mesh, const MovingVertices& vertices)
{
  Index& vertex = patchVertex_[meshVertex];
  if (vertex < 0)
  {
    vertex = static_cast<Index>(meshVertex_.size());
    meshVertex_.push_back(meshVertex);
    patch_.mesh.ids.push_back(mesh.ids[meshVertex]);
    patch_.mesh.points.push_back(vertices.wanted[meshVertex]);
    patch_.start.push_back(vertices.start[meshVertex]);
    patch_.free.push_back(vertices.free[meshVertex]);
    patch_.complete.push_back(1);
    patch_.entities.push_back(vertices.entities[meshVertex]);
  }
  return vertex;
}

void UntanglingPatch::addOwnCells(const SimplexMesh& mesh, const MovingVertices& vertices)
{
  const auto add = [&](const auto& cells, auto& ofPatch)
  {
    for (const Index c : vertices.cells)
    {
      auto cell = cells[c];
      if (std::any_of(cell.begin(), cell.end(), [&](Index v) { return vertices.free[v] != 0; }))
      {
        for (Index& vertex : cell)
        {
          vertex = localVertex(vertex, mesh, vertices);
        }
        ofPatch.push_back(cell);
      }
    }
  };
  if (mesh.dimension == 3)
  {
    add(mesh.tetrahedra, patch_.mesh.tetrahedra);
  }
  else
  {
    add(mesh.triangles, patch_.mesh.triangles);
  }
}

void UntanglingPatch::addCellsOfOthers(const DistributedMesh& mesh, const MovingVertices& vertices)
{
  // A rank may share a free vertex at which it has no cell of its own dimension.
  std::vector<std::vector<int>> neighboursOf(meshVertex_.size());
  for (std::size_t n = 0; n < mesh.shared.neighbours.size(); ++n)
  {
    for (const Index vertex : mesh.shared.items[n])
    {
      if (vertices.free[vertex] && patchVertex_[vertex] >= 0)
      {
        neighboursOf[patchVertex_[vertex]].push_back(static_cast<int>(n));
      }
    }
  }
  std::vector<std::vector<CellRecord>> toOthers(mesh.shared.neighbours.size());
  collectRecords(patch_.mesh.tetrahedra, patch_, neighboursOf, toOthers);
  collectRecords(patch_.mesh.triangles, patch_, neighboursOf, toOthers);
  const auto fromOthers = exchange_.exchange(mesh.shared.neighbours, toOthers);

  std::unordered_map<GlobalId, Index> known;
  for (std::size_t v = 0; v < patch_.mesh.ids.size(); ++v)
  {
    known.emplace(patch_.mesh.ids[v], static_cast<Index>(v));
  }
  const auto vertexOf = [&](const CellRecord& record, std::size_t k)
  {
    const auto [entry, isNew] =
      known.emplace(record.ids[k], static_cast<Index>(patch_.mesh.ids.size()));
    if (isNew)
    {
      meshVertex_.push_back(-1);
      patch_.mesh.ids.push_back(record.ids[k]);
      patch_.mesh.points.push_back(record.wanted[k]);
      patch_.start.push_back(record.start[k]);
      patch_.free.push_back(record.free[k]);
      patch_.complete.push_back(0);
      patch_.entities.emplace_back();
    }
    return entry->second;
  };
  for (const auto& records : fromOthers)
  {
    for (const CellRecord& record : records)
    {
      if (patch_.mesh.dimension == 3)
      {
        appendCell(record, vertexOf, patch_.mesh.tetrahedra);
      }
      else
      {
        appendCell(record, vertexOf, patch_.mesh.triangles);
      }
    }
  }
}

void UntanglingPatch::findHolders()
{
  std::vector<Index> candidates;
  for (std::size_t v = 0; v < patch_.free.size(); ++v)
  {
    if (patch_.free[v])
    {
      candidates.push_back(static_cast<Index>(v));
    }
  }
  shared_ = findSharedVertices(exchange_, patch_.mesh.ids, candidates);
}

std::vector<VertexPlace> UntanglingPatch::optimise(const BoundaryProjector& projector, int sweeps)
{
  PatchOptimiser optimiser(patch_, &projector, forOnThreads(exchange_));
  for (int sweep = 0; sweep < sweeps; ++sweep)
  {
    optimiser.beginSweep(exchange_.min(optimiser.smallestMeasure()));
    while (exchange_.any(optimiser.advance()))
    {
      std::vector<Placed> places(patch_.mesh.points.size());
      for (const Index vertex : shared_.all)
      {
        places[vertex] = { patch_.mesh.points[vertex], optimiser.isDone(vertex) };
      }
      combineShared(exchange_, shared_, places, pickUpdated);
      for (const Index vertex : shared_.all)
      {
        if (places[vertex].done && !optimiser.isDone(vertex))
        {
          optimiser.place(vertex, places[vertex].point);
        }
      }
    }
  }
  return placesOfFree();
}

/// Also ranks that hold a vertex, but none of the cells round it, are to know where it is.
std::vector<VertexPlace> UntanglingPatch::placesOfFree()
{
  std::vector<VertexPlace> result;
  for (std::size_t v = 0; v < meshVertex_.size(); ++v)
  {
    if (meshVertex_[v] >= 0 && patch_.free[v])
    {
      result.push_back({ meshVertex_[v], patch_.mesh.points[v] });
    }
  }
  if (exchange_.size() == 1)
  {
    return result;
  }
  std::vector<Placed> places(patchVertex_.size());
  for (const VertexPlace& place : result)
  {
    places[place.vertex] = { place.point, 1 };
  }
  combineShared(exchange_, sharedOfMesh_, places, pickUpdated);
  for (const Index vertex : sharedOfMesh_.all)
  {
    if (free_[vertex] && patchVertex_[vertex] < 0)
    {
      result.push_back({ vertex, places[vertex].point });
    }
  }
  return result;
}

} // namespace cadrefine
