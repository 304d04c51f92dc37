#include "balancing/Balancing.h"

#include "balancing/WeightedPartition.h"
#include "comm/CollectiveErrors.h"
#include "fields/ArrayTransfer.h"
#include "fields/Marshalling.h"

#include <vtkAppendFilter.h>
#include <vtkNew.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

namespace cadrefine
{
namespace
{

template<std::size_t Corners>
void appendCentres(const Mesh& mesh, const std::vector<std::array<Index, Corners>>& cells,
  std::vector<Point3>& centres)
{
  for (const auto& cell : cells)
  {
    Point3& centre = centres.emplace_back(Point3{});
    for (const Index vertex : cell)
    {
      centre = centre + (1.0 / Corners) * mesh.points[vertex];
    }
  }
}

/// Centres of all cells, those of dimension 0 first.
std::vector<Point3> cellCentres(const Mesh& mesh)
{
  std::vector<Point3> centres;
  centres.reserve(mesh.cellCount());
  visitShapes(mesh, [&](auto, const auto& cells) { appendCentres(mesh, cells, centres); });
  return centres;
}

/// Makes meshes of some of a piece's cells.
class PartMaker
{
public:
  explicit PartMaker(const DistributedMesh& mesh)
    : mesh_(mesh), vertexOf_(mesh.mesh().points.size(), -1)
  {
  }

  /// `cells` count from the first one of dimension 0, and ascend. Work: linear in their number.
  ConvertedMesh make(const std::vector<vtkIdType>& cells)
  {
    part_ = {};
    const Mesh& piece = mesh_.mesh();
    part_.mesh.dimension = piece.dimension;
    part_.mesh.wedgesAsDocumented = piece.wedgesAsDocumented;
    next_ = cells.begin();
    end_ = cells.end();
    for (int d = 0; d < 4; ++d)
    {
      std::size_t first = 0; // of the shape, among those of the dimension
      visitShapes(piece, d,
        [&](auto shape, const auto& all)
        {
          take(d, first, all, part_.mesh.*decltype(shape)::cells);
          first += all.size();
        });
    }
    for (const Index vertex : taken_)
    {
      vertexOf_[vertex] = -1;
    }
    taken_.clear();
    return std::move(part_);
  }

private:
  template<std::size_t Corners>
  void take(int dimension, std::size_t firstOfShape,
    const std::vector<std::array<Index, Corners>>& cells,
    std::vector<std::array<Index, Corners>>& taken)
  {
    const vtkIdType first = firstCellOfDimension(mesh_.mesh(), dimension);
    const auto begin = first + static_cast<vtkIdType>(firstOfShape);
    const auto last = begin + static_cast<vtkIdType>(cells.size());
    for (; next_ != end_ && *next_ < last; ++next_)
    {
      const auto& corners = cells[*next_ - begin];
      auto& newCorners = taken.emplace_back();
      std::transform(corners.begin(), corners.end(), newCorners.begin(),
        [&](Index vertex) { return newVertex(vertex); });
      part_.cellOf[dimension].push_back(mesh_.converted.cellOf[dimension][*next_ - first]);
      part_.cellIds[dimension].push_back(mesh_.converted.cellIds[dimension][*next_ - first]);
    }
  }

  Index newVertex(Index vertex)
  {
    if (vertexOf_[vertex] < 0)
    {
      vertexOf_[vertex] = static_cast<Index>(taken_.size());
      taken_.push_back(vertex);
      part_.pointOf.push_back(mesh_.converted.pointOf[vertex]);
      part_.mesh.points.push_back(mesh_.mesh().points[vertex]);
      part_.mesh.ids.push_back(mesh_.mesh().ids[vertex]);
    }
    return vertexOf_[vertex];
  }

  const DistributedMesh& mesh_;
  std::vector<Index> vertexOf_; ///< Vertex of the part, or -1.
  std::vector<Index> taken_;    ///< Vertices of the mesh, in the order of those of the part.
  ConvertedMesh part_;
  std::vector<vtkIdType>::const_iterator next_;
  std::vector<vtkIdType>::const_iterator end_;
};

/// The parts of a piece, one for each rank.
struct Parts
{
  Delivery delivery;
  std::vector<std::vector<char>> cells;  ///< And points, without arrays.
  vtkSmartPointer<vtkPointSet> ownCells; ///< In the place of those for this rank.
  std::vector<std::vector<GlobalId>> pointIds;
  std::vector<std::vector<GlobalId>> cellIds;

  explicit Parts(int ranks) : delivery(ranks), cells(ranks), pointIds(ranks), cellIds(ranks) {}
};

std::vector<GlobalId> joined(const std::vector<std::vector<GlobalId>>& lists)
{
  std::vector<GlobalId> all;
  for (const auto& list : lists)
  {
    all.insert(all.end(), list.begin(), list.end());
  }
  return all;
}

Parts makeParts(const RankExchange& exchange, const DistributedMesh& mesh, vtkPointSet* input,
  const std::vector<int>& rankOfCell)
{
  const int rankCount = exchange.size();
  std::vector<std::vector<vtkIdType>> cellsTo(rankCount);
  for (std::size_t cell = 0; cell < rankOfCell.size(); ++cell)
  {
    cellsTo[rankOfCell[cell]].push_back(static_cast<vtkIdType>(cell));
  }
  Parts parts(rankCount);
  PartMaker maker(mesh);
  for (int rank = 0; rank < rankCount; ++rank)
  {
    const ConvertedMesh part = maker.make(cellsTo[rank]);
    parts.delivery[rank] = selectionOf(input, part);
    if (!cellsTo[rank].empty())
    {
      const auto cells = makePointSet(vtkNew<vtkUnstructuredGrid>(), part.mesh);
      if (rank == exchange.rank())
      {
        parts.ownCells = cells;
      }
      else
      {
        parts.cells[rank] = marshal(cells);
      }
      parts.pointIds[rank] = part.mesh.ids;
      for (const auto& ids : part.cellIds)
      {
        parts.cellIds[rank].insert(parts.cellIds[rank].end(), ids.begin(), ids.end());
      }
    }
  }
  return parts;
}

/// The parts of all ranks in a row, `own` in the place of this one's.
vtkSmartPointer<vtkPointSet> appendParts(
  const std::vector<std::vector<char>>& parts, int rank, vtkPointSet* own)
{
  vtkNew<vtkAppendFilter> append;
  for (int r = 0; r < static_cast<int>(parts.size()); ++r)
  {
    if (r == rank && own)
    {
      append->AddInputData(own);
    }
    else if (!parts[r].empty())
    {
      append->AddInputData(unmarshal<vtkUnstructuredGrid>(parts[r]));
    }
  }
  auto result = vtkSmartPointer<vtkUnstructuredGrid>::New();
  if (append->GetNumberOfInputConnections(0) > 0)
  {
    append->Update();
    result->ShallowCopy(append->GetOutput());
  }
  return result;
}

/// A rank without points does not know how the arrays of ids are called elsewhere.
void agreeOnNamesOfIds(RankExchange& exchange, vtkPointSet* input, MeshArrays& arrays)
{
  const int root = static_cast<int>(
    exchange.min(input->GetNumberOfPoints() > 0 ? exchange.rank() : exchange.size() - 1));
  const auto fromRoot = [&](std::string& name)
  {
    const std::vector<char> text = exchange.broadcast({ name.begin(), name.end() }, root);
    name.assign(text.begin(), text.end());
  };
  fromRoot(arrays.vertexIdName);
  fromRoot(arrays.cellIdName);
}

} // namespace

bool isBalanced(
  RankExchange& exchange, const DistributedMesh& mesh, const std::vector<std::int64_t>& weights)
{
  constexpr double tolerance = 1.02;  // as good as partitionByWeight promises
  constexpr std::int64_t compact = 4; // times as many vertices as the interface has
  const std::int64_t mine = std::accumulate(weights.begin(), weights.end(), std::int64_t{ 0 });
  const std::int64_t largest = exchange.max(mine);
  const auto sums = exchange.sum({ mine, static_cast<std::int64_t>(mesh.shared.all.size()),
    static_cast<std::int64_t>(mesh.mesh().points.size()) });
  const double mean = static_cast<double>(sums[0]) / exchange.size();
  return static_cast<double>(largest) <= tolerance * mean && compact * sums[1] <= sums[2];
}

std::vector<int> ranksByWeight(
  RankExchange& exchange, const DistributedMesh& mesh, const std::vector<std::int64_t>& weights)
{
  return partitionByWeight(exchange, cellCentres(mesh.mesh()), weights);
}

Redistribution redistribute(RankExchange& exchange, const DistributedMesh& mesh, vtkPointSet* input,
  const std::vector<int>& ranks)
{
  Parts parts(exchange.size());
  agreeOnFailure(exchange, [&] { parts = makeParts(exchange, mesh, input, ranks); });
  Redistribution result;
  result.delivery = std::move(parts.delivery);
  ConvertedMesh ids;
  ids.mesh.ids = joined(exchange.allToAll(parts.pointIds));
  ids.cellIds[0] = joined(exchange.allToAll(parts.cellIds));
  const auto cells = exchange.allToAll(parts.cells);
  MeshArrays arrays = deliver(exchange, arraysOf(input), result.delivery);
  agreeOnNamesOfIds(exchange, input, arrays);
  agreeOnFailure(exchange,
    [&]
    {
      result.mesh = appendParts(cells, exchange.rank(), parts.ownCells);
      setArrays(arrays, ids, result.mesh);
    });
  return result;
}

} // namespace cadrefine
