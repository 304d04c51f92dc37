#include "balancing/Redistribution.h"

#include "comm/CollectiveErrors.h"
#include "mesh/GlobalIdReading.h"

#include <cadrefine/base/IndicesWhere.h>
#include <cadrefine/base/LargeMemory.h>

#include <algorithm>
#include <array>
#include <utility>

namespace cadrefine
{
namespace
{

/// Makes parts of a piece's cells.
class PartMaker
{
public:
  explicit PartMaker(const DistributedMesh& mesh)
    : mesh_(mesh), vertexOf_(mesh.mesh().points.size(), -1)
  {
  }

  /// With its places in the piece. `cells` are in the order of makePointSet, and ascend. Work:
  /// linear in their number.
  ConvertedMesh make(const std::vector<vtkIdType>& cells)
  {
    part_ = {};
    next_ = cells.begin();
    end_ = cells.end();
    for (int d = 0; d < 4; ++d)
    {
      std::size_t first = 0; // of the shape, among those of the dimension
      visitShapes(mesh_.mesh(), d,
        [&](auto shape, const auto& all)
        {
          take(d, first, all, part_.mesh.*decltype(shape)::cells);
          first += all.size();
        });
    }
    for (const vtkIdType vertex : part_.pointOf)
    {
      vertexOf_[vertex] = -1;
    }
    return std::move(part_);
  }

private:
  template<std::size_t Corners>
  void take(
    int dimension, std::size_t firstOfShape, const Cells<Corners>& cells, Cells<Corners>& taken)
  {
    const vtkIdType first = firstCellOfDimension(mesh_.mesh(), dimension);
    const auto begin = first + static_cast<vtkIdType>(firstOfShape);
    const auto last = begin + static_cast<vtkIdType>(cells.size());
    const auto count = static_cast<std::size_t>(std::lower_bound(next_, end_, last) - next_);
    reserveLong(taken, count);
    reserveLong(part_.cellOf[dimension], part_.cellOf[dimension].size() + count);
    reserveLong(part_.cellIds[dimension], part_.cellIds[dimension].size() + count);
    for (; next_ != end_ && *next_ < last; ++next_)
    {
      const auto& corners = cells[*next_ - begin];
      auto& newCorners = taken.emplace_back();
      std::transform(corners.begin(), corners.end(), newCorners.begin(),
        [&](Index vertex) { return newVertex(vertex); });
      part_.cellOf[dimension].push_back(*next_);
      part_.cellIds[dimension].push_back(mesh_.converted.cellIds[dimension][*next_ - first]);
    }
  }

  Index newVertex(Index vertex)
  {
    if (vertexOf_[vertex] < 0)
    {
      vertexOf_[vertex] = static_cast<Index>(part_.pointOf.size());
      part_.pointOf.push_back(vertex);
      part_.mesh.points.push_back(mesh_.mesh().points[vertex]);
      part_.mesh.ids.push_back(mesh_.mesh().ids[vertex]);
    }
    return vertexOf_[vertex];
  }

  const DistributedMesh& mesh_;
  std::vector<Index> vertexOf_; ///< Vertex of the part, or -1.
  ConvertedMesh part_;
  std::vector<vtkIdType>::const_iterator next_;
  std::vector<vtkIdType>::const_iterator end_;
};

template<class T>
std::vector<T> joined(const std::array<std::vector<T>, 4>& lists)
{
  std::vector<T> all;
  reserveLong(all, lists[0].size() + lists[1].size() + lists[2].size() + lists[3].size());
  for (const auto& list : lists)
  {
    all.insert(all.end(), list.begin(), list.end());
  }
  return all;
}

struct PlacedVertex
{
  Point3 point;
  GlobalId id;
};

/// Parts for all ranks, this one's left out, as lists to be sent.
struct Messages
{
  std::vector<std::vector<PlacedVertex>> vertices;
  std::vector<std::vector<std::int64_t>> cells; ///< How many of each shape, then their ids.
  std::vector<std::vector<Index>> corners;
};

Messages pack(const std::vector<ConvertedMesh>& parts, int here)
{
  const std::size_t ranks = parts.size();
  Messages messages{ std::vector<std::vector<PlacedVertex>>(ranks),
    std::vector<std::vector<std::int64_t>>(ranks), std::vector<std::vector<Index>>(ranks) };
  for (std::size_t rank = 0; rank < ranks; ++rank)
  {
    const auto& [mesh, pointOf, cellOf, cellIds, midNodes] = parts[rank];
    if (static_cast<int>(rank) == here || mesh.cellCount() == 0)
    {
      continue;
    }
    for (std::size_t v = 0; v < mesh.points.size(); ++v)
    {
      messages.vertices[rank].push_back({ mesh.points[v], mesh.ids[v] });
    }
    visitShapes(mesh,
      [&, rank = rank](auto, const auto& cells)
      {
        messages.cells[rank].push_back(static_cast<std::int64_t>(cells.size()));
        for (const auto& cell : cells)
        {
          messages.corners[rank].insert(messages.corners[rank].end(), cell.begin(), cell.end());
        }
      });
    const auto ids = joined(cellIds);
    messages.cells[rank].insert(messages.cells[rank].end(), ids.begin(), ids.end());
  }
  return messages;
}

/// A part without its places in the piece that it came from.
ConvertedMesh unpack(const std::vector<PlacedVertex>& vertices,
  const std::vector<std::int64_t>& cellList, const std::vector<Index>& corners)
{
  ConvertedMesh part;
  for (const auto& [point, id] : vertices)
  {
    part.mesh.points.push_back(point);
    part.mesh.ids.push_back(id);
  }
  auto count = cellList.begin();
  auto corner = corners.begin();
  visitShapes(part.mesh,
    [&](auto, auto& cells)
    {
      cells.resize(cellList.empty() ? 0 : static_cast<std::size_t>(*count++));
      for (auto& cell : cells)
      {
        std::copy_n(corner, cell.size(), cell.begin());
        corner += static_cast<std::ptrdiff_t>(cell.size());
      }
    });
  for (int d = 0; d < 4; ++d)
  {
    const auto last = count + static_cast<std::ptrdiff_t>(part.mesh.cellCount(d));
    part.cellIds[d].assign(count, last);
    count = last;
  }
  return part;
}

/// The parts in a row, each vertex once: `kept` of those of all parts.
ConvertedMesh join(const std::vector<ConvertedMesh>& parts, ArraySelection& kept)
{
  ConvertedMesh result;
  Mesh& mesh = result.mesh;
  std::vector<GlobalId> ids;
  for (const ConvertedMesh& part : parts)
  {
    ids.insert(ids.end(), part.mesh.ids.begin(), part.mesh.ids.end());
  }
  const std::vector<Index> vertexOf = numberByIds(ids, [](std::size_t) { return true; });
  auto& points = kept.points.emplace();
  reserveLong(points, ids.size());
  reserveLong(mesh.points, ids.size());
  reserveLong(mesh.ids, ids.size());
  std::size_t place = 0;
  for (const ConvertedMesh& part : parts)
  {
    for (const Point3& point : part.mesh.points)
    {
      if (vertexOf[place] == static_cast<Index>(points.size()))
      {
        points.push_back(static_cast<vtkIdType>(place));
        mesh.points.push_back(point);
        mesh.ids.push_back(ids[place]);
      }
      ++place;
    }
  }
  constexpr std::size_t shapes = 8;
  std::array<std::vector<vtkIdType>, shapes> placesOf; // in the order in which shapes are visited
  std::array<std::vector<GlobalId>, shapes> idsOf;
  std::size_t firstVertex = 0;
  vtkIdType nextPlace = 0;
  for (const ConvertedMesh& part : parts)
  {
    const auto cellIds = joined(part.cellIds);
    auto nextId = cellIds.begin();
    std::size_t s = 0;
    visitShapes(part.mesh,
      [&](auto shape, const auto& cells)
      {
        auto& all = mesh.*decltype(shape)::cells;
        reserveLong(all, all.size() + cells.size());
        reserveLong(placesOf[s], all.size() + cells.size());
        reserveLong(idsOf[s], all.size() + cells.size());
        for (auto cell : cells)
        {
          std::transform(cell.begin(), cell.end(), cell.begin(),
            [&](Index vertex) { return vertexOf[firstVertex + vertex]; });
          all.push_back(cell);
          placesOf[s].push_back(nextPlace++);
          idsOf[s].push_back(*nextId++);
        }
        ++s;
      });
    firstVertex += part.mesh.points.size();
  }
  auto& cells = kept.cells.emplace();
  std::size_t s = 0;
  for (int d = 0; d < 4; ++d)
  {
    visitShapes(mesh, d,
      [&](auto, auto&)
      {
        cells.insert(cells.end(), placesOf[s].begin(), placesOf[s].end());
        result.cellIds[d].insert(result.cellIds[d].end(), idsOf[s].begin(), idsOf[s].end());
        ++s;
      });
  }
  return result;
}

} // namespace

Redistribution redistribute(
  RankExchange& exchange, const DistributedMesh& mesh, const std::vector<int>& ranks)
{
  const auto here = static_cast<std::size_t>(exchange.rank());
  std::vector<ConvertedMesh> parts(exchange.size());
  Redistribution result;
  Messages messages;
  // Vertices that other ranks may hold.
  std::vector<unsigned char> isCandidate(mesh.mesh().points.size(), 0);
  agreeOnFailure(exchange,
    [&]
    {
      std::vector<std::vector<vtkIdType>> cellsTo(parts.size());
      for (std::size_t cell = 0; cell < ranks.size(); ++cell)
      {
        cellsTo[ranks[cell]].push_back(static_cast<vtkIdType>(cell));
      }
      for (const Index vertex : mesh.shared.all)
      {
        isCandidate[vertex] = 1;
      }
      PartMaker maker(mesh);
      for (std::size_t rank = 0; rank < parts.size(); ++rank)
      {
        parts[rank] = maker.make(cellsTo[rank]);
        result.delivery.push_back({ parts[rank].pointOf, joined(parts[rank].cellOf) });
        for (const vtkIdType vertex : parts[rank].pointOf)
        {
          isCandidate[vertex] = isCandidate[vertex] || rank != here;
        }
      }
      messages = pack(parts, exchange.rank());
    });
  messages.vertices = exchange.allToAll(messages.vertices);
  messages.cells = exchange.allToAll(messages.cells);
  messages.corners = exchange.allToAll(messages.corners);
  agreeOnFailure(exchange,
    [&]
    {
      for (std::size_t rank = 0; rank < parts.size(); ++rank)
      {
        if (rank != here)
        {
          parts[rank] =
            unpack(messages.vertices[rank], messages.cells[rank], messages.corners[rank]);
        }
      }
      result.mesh.converted = join(parts, result.kept);
    });
  Mesh& joined = result.mesh.mesh();
  joined.dimension = mesh.mesh().dimension;
  joined.wedgesAsDocumented = mesh.mesh().wedgesAsDocumented;
  result.mesh.vertexIdBound = mesh.vertexIdBound;
  std::size_t firstOwn = 0;
  for (std::size_t rank = 0; rank < here; ++rank)
  {
    firstOwn += parts[rank].mesh.points.size();
  }
  const std::vector<vtkIdType>& own = *result.delivery[here].points;
  const auto mayBeShared = [&](std::size_t v)
  {
    const std::size_t place = static_cast<std::size_t>((*result.kept.points)[v]) - firstOwn;
    return place >= own.size() || isCandidate[own[place]]; // huge where it is below
  };
  result.mesh.shared =
    findSharedVertices(exchange, joined.ids, indicesWhere(joined.points.size(), mayBeShared));
  return result;
}

} // namespace cadrefine
