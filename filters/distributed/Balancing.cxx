#include "Balancing.h"

#include "Agreement.h"
#include "ArrayTransfer.h"
#include "Error.h"
#include "GlobalNumbering.h"

#include <vtkAppendFilter.h>
#include <vtkCellData.h>
#include <vtkCharArray.h>
#include <vtkCommunicator.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>

namespace cadrefine
{
namespace
{

/// Place on the Morton curve: the bits of the three coordinates in turn, 21 of each.
std::int64_t mortonCode(const MeshBounds& bounds, const Point3& point)
{
  constexpr int bits = 21;
  std::int64_t code = 0;
  for (int k = 0; k < 3; ++k)
  {
    const double extent = bounds.high[k] - bounds.low[k];
    const double part = extent > 0 ? (point[k] - bounds.low[k]) / extent : 0;
    const auto step = static_cast<std::int64_t>(std::clamp(part, 0.0, 1.0) * ((1 << bits) - 1));
    for (int bit = 0; bit < bits; ++bit)
    {
      code |= ((step >> bit) & 1) << (3 * bit + k);
    }
  }
  return code;
}

template<std::size_t Corners>
void appendKeys(const SimplexMesh& mesh, const MeshBounds& bounds,
  const std::vector<std::array<Index, Corners>>& cells, const std::vector<GlobalId>& ids,
  std::vector<Key<2>>& keys)
{
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    Point3 centre{};
    for (const Index vertex : cells[c])
    {
      centre = centre + (1.0 / Corners) * mesh.points[vertex];
    }
    keys.push_back({ mortonCode(bounds, centre), ids[c] });
  }
}

/// The rank that each cell goes to, cells of dimension 0 first.
std::vector<int> chooseRanks(
  RankExchange& exchange, const DistributedMesh& mesh, const std::vector<std::int64_t>& weights)
{
  const SimplexMesh& piece = mesh.mesh();
  const MeshBounds bounds = findBounds(exchange, piece);
  const auto& ids = mesh.converted.cellIds;
  std::vector<Key<2>> keys;
  appendKeys(piece, bounds, piece.vertices, ids[0], keys);
  appendKeys(piece, bounds, piece.segments, ids[1], keys);
  appendKeys(piece, bounds, piece.triangles, ids[2], keys);
  appendKeys(piece, bounds, piece.tetrahedra, ids[3], keys);
  const Numbering before = offsets(exchange, keys, weights);
  std::vector<int> ranks;
  for (const GlobalId weight : before.numbers)
  {
    const double part = static_cast<double>(weight) / static_cast<double>(before.count);
    ranks.push_back(std::min(exchange.size() - 1, static_cast<int>(part * exchange.size())));
  }
  return ranks;
}

/// The cells of a piece that go to one rank.
class PartMaker
{
public:
  PartMaker(const DistributedMesh& mesh, const std::vector<int>& ranks, int rank)
    : mesh_(mesh), ranks_(ranks), rank_(rank), vertexOf_(mesh.mesh().points.size(), -1)
  {
    const SimplexMesh& piece = mesh.mesh();
    part_.mesh.dimension = piece.dimension;
    take(0, piece.vertices, part_.mesh.vertices);
    take(1, piece.segments, part_.mesh.segments);
    take(2, piece.triangles, part_.mesh.triangles);
    take(3, piece.tetrahedra, part_.mesh.tetrahedra);
  }

  const ConvertedMesh& part() const { return part_; }

private:
  template<std::size_t Corners>
  void take(int dimension, const std::vector<std::array<Index, Corners>>& cells,
    std::vector<std::array<Index, Corners>>& taken)
  {
    const vtkIdType first = firstCellOfDimension(mesh_.mesh(), dimension);
    for (std::size_t c = 0; c < cells.size(); ++c)
    {
      const vtkIdType cell = first + static_cast<vtkIdType>(c);
      if (ranks_[cell] == rank_)
      {
        auto& corners = taken.emplace_back();
        std::transform(cells[c].begin(), cells[c].end(), corners.begin(),
          [&](Index vertex) { return newVertex(vertex); });
        part_.cellOf[dimension].push_back(cell);
        part_.cellIds[dimension].push_back(mesh_.converted.cellIds[dimension][c]);
      }
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
  const std::vector<int>& ranks_;
  int rank_;
  std::vector<Index> vertexOf_;
  ConvertedMesh part_;
};

std::vector<char> pack(const ConvertedMesh& part, vtkPointSet* input)
{
  vtkNew<vtkUnstructuredGrid> grid;
  grid->ShallowCopy(makePointSet(grid, part.mesh));
  copyArrays(input, part, grid);
  grid->GetFieldData()->Initialize();
  vtkNew<vtkCharArray> bytes;
  if (!vtkCommunicator::MarshalDataObject(grid, bytes))
  {
    throw Error("a part of the mesh cannot be sent to another rank");
  }
  return { bytes->GetPointer(0), bytes->GetPointer(0) + bytes->GetNumberOfValues() };
}

vtkSmartPointer<vtkDataObject> unpack(const std::vector<char>& bytes)
{
  vtkNew<vtkCharArray> array;
  array->SetNumberOfValues(static_cast<vtkIdType>(bytes.size()));
  std::copy(bytes.begin(), bytes.end(), array->GetPointer(0));
  auto part = vtkCommunicator::UnMarshalDataObject(array);
  if (!vtkUnstructuredGrid::SafeDownCast(part))
  {
    throw Error("a part of the mesh from another rank cannot be read");
  }
  return part;
}

/// The appended parts lose which arrays are the global ids.
void markGlobalIds(vtkDataSetAttributes* source, vtkDataSetAttributes* output)
{
  if (vtkDataArray* ids = source->GetGlobalIds())
  {
    output->SetActiveAttribute(ids->GetName(), vtkDataSetAttributes::GLOBALIDS);
  }
}

} // namespace

vtkSmartPointer<vtkPointSet> redistribute(RankExchange& exchange, const DistributedMesh& mesh,
  vtkPointSet* input, const std::vector<std::int64_t>& weights)
{
  const std::vector<int> ranks = chooseRanks(exchange, mesh, weights);
  std::vector<std::vector<char>> outgoing(exchange.size());
  attempt(exchange,
    [&]
    {
      for (int rank = 0; rank < exchange.size(); ++rank)
      {
        const PartMaker maker(mesh, ranks, rank);
        if (maker.part().mesh.cellCount() > 0)
        {
          outgoing[rank] = pack(maker.part(), input);
        }
      }
    });
  const auto incoming = exchange.allToAll(outgoing);
  auto result = vtkSmartPointer<vtkUnstructuredGrid>::New();
  attempt(exchange,
    [&]
    {
      vtkNew<vtkAppendFilter> append;
      for (const auto& bytes : incoming)
      {
        if (!bytes.empty())
        {
          append->AddInputData(unpack(bytes));
        }
      }
      if (append->GetNumberOfInputConnections(0) > 0)
      {
        append->Update();
        result->ShallowCopy(append->GetOutput());
        markGlobalIds(input->GetPointData(), result->GetPointData());
        markGlobalIds(input->GetCellData(), result->GetCellData());
      }
    });
  result->GetFieldData()->PassData(input->GetFieldData());
  return result;
}

} // namespace cadrefine
