#include "balancing/Redistribution.h"

#include "comm/CollectiveErrors.h"
#include "mesh/GlobalIdReading.h"

#include <cadrefine/base/IndicesWhere.h>
#include <cadrefine/base/LargeMemory.h>
#include <cadrefine/mesh/VertexFlags.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>
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

  /// Makes a part of these cells, with the places of its vertices in the piece. `cells` are in the
  /// order of makePointSet, and ascend. Work: linear in their number.
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
    reserveLong(part_.cellIds[dimension], part_.cellIds[dimension].size() + count);
    for (; next_ != end_ && *next_ < last; ++next_)
    {
      const auto& corners = cells[*next_ - begin];
      auto& newCorners = taken.emplace_back();
      std::transform(corners.begin(), corners.end(), newCorners.begin(),
        [&](Index vertex) { return newVertex(vertex); });
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
  std::vector<Index> vertexOf_; ///< The part's vertex for each of the piece's, or -1.
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

Messages pack(const std::vector<ConvertedMesh>& parts)
{
  const std::size_t ranks = parts.size();
  Messages messages{ std::vector<std::vector<PlacedVertex>>(ranks),
    std::vector<std::vector<std::int64_t>>(ranks), std::vector<std::vector<Index>>(ranks) };
  for (std::size_t rank = 0; rank < ranks; ++rank)
  {
    const auto& [mesh, pointOf, cellOf, cellIds, midNodes] = parts[rank];
    if (mesh.cellCount() == 0)
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

/// Takes out the cells that go to other ranks. Returns the vertices that are left, by their old
/// numbers.
std::vector<Index> takeOut(const std::vector<int>& ranks, int here, ConvertedMesh& piece)
{
  auto rank = ranks.begin();
  for (int d = 0; d < 4; ++d)
  {
    auto& ids = piece.cellIds[d];
    auto id = ids.begin();
    auto keptId = ids.begin();
    visitShapes(piece.mesh, d,
      [&](auto, auto& cells)
      {
        auto kept = cells.begin();
        for (const auto& cell : cells)
        {
          if (*rank++ == here)
          {
            *kept++ = cell;
            *keptId++ = *id;
          }
          ++id;
        }
        cells.erase(kept, cells.end());
      });
    ids.erase(keptId, ids.end());
  }
  std::vector<Index> vertices = usedVertices(piece.mesh);
  keepVertices(vertices, piece.mesh);
  return vertices;
}

/// Puts the other parts of a row of parts behind this rank's own.
class PartJoiner
{
public:
  PartJoiner(std::vector<ConvertedMesh>& parts, std::size_t own) : parts_(parts), own_(own) {}

  /// Returns what becomes of this rank's own part. Of a vertex that it has already, which is one of
  /// `candidates`, or that several parts have, the first one is kept. Work: linear in the cells,
  /// and beside that in the other parts and the candidates.
  ConvertedMesh join(const std::vector<Index>& candidates, Delivery& delivery)
  {
    for (const ConvertedMesh& part : parts_)
    {
      delivery.points.push_back(part.mesh.points.size());
      delivery.cells.push_back(part.mesh.cellCount());
    }
    addVertices(candidates, firstPlaces(delivery.points), delivery.kept.points.emplace());
    addCells(firstPlaces(delivery.cells), delivery.kept.cells.emplace());
    return std::move(parts_[own_]);
  }

private:
  static std::vector<vtkIdType> firstPlaces(const std::vector<std::size_t>& counts)
  {
    std::vector<vtkIdType> firsts(counts.size());
    std::exclusive_scan(counts.begin(), counts.end(), firsts.begin(), vtkIdType{ 0 });
    return firsts;
  }

  template<class Use>
  void forOthers(const Use& use) const
  {
    for (std::size_t p = 0; p < parts_.size(); ++p)
    {
      if (p != own_)
      {
        use(p, parts_[p]);
      }
    }
  }

  /// Adds the vertices of the other parts. `firsts`: where those that came from each rank begin.
  void addVertices(const std::vector<Index>& candidates, const std::vector<vtkIdType>& firsts,
    std::vector<vtkIdType>& places)
  {
    Mesh& own = parts_[own_].mesh;
    places.resize(own.points.size());
    std::iota(places.begin(), places.end(), firsts[own_]);
    std::vector<GlobalId> ids;
    std::transform(candidates.begin(), candidates.end(), std::back_inserter(ids),
      [&](Index vertex) { return own.ids[vertex]; });
    forOthers([&](std::size_t, const ConvertedMesh& part)
      { ids.insert(ids.end(), part.mesh.ids.begin(), part.mesh.ids.end()); });
    const std::vector<Index> numbers = numberByIds(ids, [](std::size_t) { return true; });
    const auto known = static_cast<Index>(candidates.size());
    const auto firstNew = static_cast<Index>(own.points.size());
    auto number = numbers.begin() + known;
    forOthers(
      [&](std::size_t p, const ConvertedMesh& part)
      {
        for (std::size_t v = 0; v < part.mesh.points.size(); ++v)
        {
          const Index n = *number++;
          vertexOf_.push_back(n < known ? candidates[n] : firstNew + n - known);
          if (vertexOf_.back() == static_cast<Index>(own.points.size()))
          {
            places.push_back(firsts[p] + static_cast<vtkIdType>(v));
            own.points.push_back(part.mesh.points[v]);
            own.ids.push_back(part.mesh.ids[v]);
          }
        }
      });
  }

  void addCells(std::vector<vtkIdType> firsts, std::vector<vtkIdType>& places)
  {
    ConvertedMesh& own = parts_[own_];
    for (int d = 0; d < 4; ++d)
    {
      std::vector<std::size_t> nextIds(parts_.size(), 0);
      std::vector<GlobalId> ids;
      visitShapes(own.mesh, d,
        [&](auto shape, auto& all)
        {
          const auto take = [&](std::size_t p, std::size_t count)
          {
            const auto first =
              parts_[p].cellIds[d].begin() + static_cast<std::ptrdiff_t>(nextIds[p]);
            ids.insert(ids.end(), first, first + static_cast<std::ptrdiff_t>(count));
            nextIds[p] += count;
            places.resize(places.size() + count);
            std::iota(places.end() - static_cast<std::ptrdiff_t>(count), places.end(), firsts[p]);
            firsts[p] += static_cast<vtkIdType>(count);
          };
          take(own_, all.size());
          std::size_t firstVertex = 0;
          forOthers(
            [&](std::size_t p, const ConvertedMesh& part)
            {
              const auto& cells = part.mesh.*decltype(shape)::cells;
              take(p, cells.size());
              for (auto cell : cells)
              {
                std::transform(cell.begin(), cell.end(), cell.begin(),
                  [&](Index vertex) { return vertexOf_[firstVertex + vertex]; });
                all.push_back(cell);
              }
              firstVertex += part.mesh.points.size();
            });
        });
      own.cellIds[d] = std::move(ids);
    }
  }

  std::vector<ConvertedMesh>& parts_;
  const std::size_t own_;
  std::vector<Index> vertexOf_; ///< The own part's vertex for each vertex of the other parts.
};

} // namespace

Redistribution redistribute(
  RankExchange& exchange, DistributedMesh mesh, const std::vector<int>& ranks)
{
  const auto here = static_cast<std::size_t>(exchange.rank());
  std::vector<ConvertedMesh> parts(exchange.size());
  Redistribution result;
  Messages messages;
  std::vector<Index> candidates; // vertices that other ranks may hold
  agreeOnFailure(exchange,
    [&]
    {
      std::vector<std::vector<vtkIdType>> cellsTo(parts.size());
      reserveLong(cellsTo[here], ranks.size());
      for (std::size_t cell = 0; cell < ranks.size(); ++cell)
      {
        cellsTo[ranks[cell]].push_back(static_cast<vtkIdType>(cell));
      }
      std::vector<unsigned char> isCandidate(mesh.mesh().points.size(), 0);
      for (const Index vertex : mesh.shared.all)
      {
        isCandidate[vertex] = 1;
      }
      PartMaker maker(mesh);
      for (std::size_t rank = 0; rank < parts.size(); ++rank)
      {
        if (rank != here)
        {
          parts[rank] = maker.make(cellsTo[rank]);
          for (const vtkIdType vertex : parts[rank].pointOf)
          {
            isCandidate[vertex] = 1;
          }
        }
      }
      messages = pack(parts);
      const std::vector<Index> own = takeOut(ranks, exchange.rank(), mesh.converted);
      candidates =
        indicesWhere(own.size(), [&](std::size_t v) { return isCandidate[own[v]] != 0; });
      parts[here] = std::move(mesh.converted);
      parts[here].pointOf.assign(own.begin(), own.end());
      parts[here].cellOf = {};
      for (std::size_t rank = 0; rank < parts.size(); ++rank)
      {
        result.delivery.toRanks.push_back(
          { std::move(parts[rank].pointOf), std::move(cellsTo[rank]) });
      }
    });
  messages.vertices = exchange.allToAll(messages.vertices);
  messages.cells = exchange.allToAll(messages.cells);
  messages.corners = exchange.allToAll(messages.corners);
  std::size_t ownVertices = 0;
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
      ownVertices = parts[here].mesh.points.size();
      result.mesh.converted = PartJoiner(parts, here).join(candidates, result.delivery);
    });
  const std::vector<GlobalId>& ids = result.mesh.mesh().ids;
  result.mesh.vertexIdBound = mesh.vertexIdBound;
  for (std::size_t v = ownVertices; v < ids.size(); ++v)
  {
    candidates.push_back(static_cast<Index>(v));
  }
  result.mesh.shared = findSharedVertices(exchange, ids, candidates);
  return result;
}

} // namespace cadrefine
