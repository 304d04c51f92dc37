#include "fields/VertexInterpolation.h"

#include "comm/CollectiveErrors.h"
#include "comm/Threads.h"
#include "fields/ArrayBytes.h"
#include "fields/ArrayRows.h"

#include <cadrefine/mesh/VertexFlags.h>

#include <vtkCellType.h>
#include <vtkGenericCell.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkTable.h>

#include <algorithm>
#include <array>
#include <limits>

namespace cadrefine
{
namespace
{

constexpr std::size_t mostCorners = 8;

/// VTK's type of a shape.
template<class Shape>
constexpr int typeOf(Shape)
{
  if constexpr (Shape::dimension == 3)
  {
    constexpr int types[] = { VTK_TETRA, VTK_PYRAMID, VTK_WEDGE, VTK_EMPTY_CELL, VTK_HEXAHEDRON };
    return types[Shape::corners - 4];
  }
  else
  {
    constexpr int types[] = { VTK_LINE, VTK_TRIANGLE, VTK_QUAD };
    return types[Shape::corners - 2];
  }
}

/// The place of a point in a cell.
struct PlaceInCell
{
  double outside = std::numeric_limits<double>::infinity(); ///< Squared distance from the cell.
  std::array<double, mostCorners> weights{};                ///< Shape functions of the corners.
};

/// Finds points in cells with their corners at these points.
class CellInversion
{
public:
  explicit CellInversion(const std::vector<Point3>& points) : points_(points) {}

  template<class Shape>
  PlaceInCell find(
    Shape shape, const std::array<Index, Shape::corners>& corners, const Point3& point)
  {
    cell_->SetCellType(typeOf(shape));
    for (std::size_t k = 0; k < corners.size(); ++k)
    {
      cell_->Points->SetPoint(static_cast<vtkIdType>(k), points_[corners[k]].data());
    }
    PlaceInCell place;
    int subId = 0;
    std::array<double, 3> parameters{};
    std::array<double, 3> closest{};
    double away = 0;
    const int state = cell_->EvaluatePosition(
      point.data(), closest.data(), subId, parameters.data(), away, place.weights.data());
    if (state >= 0)
    {
      place.outside = state == 1 ? 0 : away;
    }
    return place;
  }

private:
  const std::vector<Point3>& points_;
  vtkNew<vtkGenericCell> cell_;
};

/// The best cell for a vertex that moved.
struct Choice
{
  double outside = std::numeric_limits<double>::infinity();
  GlobalId id = std::numeric_limits<GlobalId>::max();
  std::int64_t rank = -1;
  Index cell = -1; ///< On that rank.
};

Choice better(const Choice& a, const Choice& b)
{
  const bool isFirst = a.outside != b.outside ? a.outside < b.outside : a.id <= b.id;
  return isFirst ? a : b;
}

/// The best of this rank's cells for each vertex of the mesh that is flagged.
std::vector<Choice> chooseHere(int rank, const DistributedMesh& distributed,
  CellInversion& inversion, const std::vector<unsigned char>& flags,
  const std::vector<Index>& cells)
{
  const Mesh& mesh = distributed.mesh();
  const auto& ids = distributed.converted.cellIds[mesh.dimension];
  std::vector<Choice> choices(flags.size());
  for (const Index cell : cells)
  {
    visitOwnCell(mesh, cell,
      [&](auto shape, const auto& corners)
      {
        for (const Index vertex : corners)
        {
          if (flags[vertex])
          {
            const double outside = inversion.find(shape, corners, mesh.points[vertex]).outside;
            if (outside < std::numeric_limits<double>::infinity())
            {
              choices[vertex] = better(choices[vertex], { outside, ids[cell], rank, cell });
            }
          }
        }
      });
  }
  return choices;
}

/// The values of these vertices, of all arrays; empty where there are none.
std::vector<char> valuesOf(const std::vector<Index>& vertices, vtkDataSetAttributes* arrays)
{
  vtkNew<vtkPointData> values;
  for (int a = 0; a < arrays->GetNumberOfArrays(); ++a)
  {
    vtkAbstractArray* array = arrays->GetAbstractArray(a);
    const auto part = emptyLike(array, static_cast<vtkIdType>(vertices.size()));
    copyTuples(array, { vertices.begin(), vertices.end() }, 0, vertices.size(), part);
    values->AddArray(part);
  }
  const bool isEmpty = vertices.empty() || values->GetNumberOfArrays() == 0;
  return isEmpty ? std::vector<char>{} : bytesOf(values);
}

/// Puts what another rank sent (see valuesOf) for these vertices into the arrays that both have.
void takeOver(
  const std::vector<char>& bytes, const std::vector<Index>& vertices, vtkDataSetAttributes* arrays)
{
  const auto table = arraysOf(bytes);
  vtkNew<vtkIdList> from;
  vtkNew<vtkIdList> to;
  for (std::size_t k = 0; k < vertices.size(); ++k)
  {
    from->InsertNextId(static_cast<vtkIdType>(k));
    to->InsertNextId(vertices[k]);
  }
  vtkDataSetAttributes* sent = table->GetRowData();
  for (int a = 0; a < sent->GetNumberOfArrays(); ++a)
  {
    if (vtkAbstractArray* mine = arrayLike(sent, a, arrays))
    {
      mine->InsertTuples(to, from, sent->GetAbstractArray(a));
    }
  }
}

} // namespace

std::optional<VertexInterpolation> interpolationOf(RankExchange& exchange,
  const DistributedMesh& distributed, const std::vector<Point3>& before,
  const std::vector<Index>& moved)
{
  if (!exchange.any(!moved.empty()))
  {
    return std::nullopt;
  }
  const Mesh& mesh = distributed.mesh();
  std::vector<unsigned char> flags(mesh.points.size(), 0);
  for (const Index vertex : moved)
  {
    flags[vertex] = 1;
  }
  CellInversion inversion(before);
  std::vector<Choice> choices = chooseHere(
    exchange.rank(), distributed, inversion, flags, cellsAt(mesh, flags, forOnThreads(exchange)));
  combineShared(exchange, distributed.shared, choices, better);

  VertexInterpolation result;
  for (const Index vertex : moved)
  {
    const Choice& choice = choices[vertex];
    if (choice.rank == exchange.rank())
    {
      visitOwnCell(mesh, choice.cell,
        [&](auto shape, const auto& corners)
        {
          const PlaceInCell place = inversion.find(shape, corners, mesh.points[vertex]);
          for (std::size_t k = 0; k < corners.size(); ++k)
          {
            if (place.weights[k] != 0)
            {
              result.rows.add(corners[k], place.weights[k]);
            }
          }
        });
      result.rows.endRow(vertex);
    }
  }
  const SharedVertices& shared = distributed.shared;
  result.neighbours = shared.neighbours;
  result.sent.resize(shared.neighbours.size());
  result.received.resize(shared.neighbours.size());
  for (std::size_t n = 0; n < shared.neighbours.size(); ++n)
  {
    for (const Index vertex : shared.items[n])
    {
      if (flags[vertex] && choices[vertex].rank == exchange.rank())
      {
        result.sent[n].push_back(vertex);
      }
      else if (flags[vertex] && choices[vertex].rank == shared.neighbours[n])
      {
        result.received[n].push_back(vertex);
      }
    }
  }
  return result;
}

MeshArrays withInterpolation(
  RankExchange& exchange, const MeshArrays& arrays, const VertexInterpolation& interpolation)
{
  MeshArrays result = withVertexRows(arrays, interpolation.rows);
  vtkNew<vtkPointData> changed;
  for (int a = 0; a < result.ofVertices->GetNumberOfArrays(); ++a)
  {
    vtkAbstractArray* array = result.ofVertices->GetAbstractArray(a);
    if (isReal(array))
    {
      changed->AddArray(array);
    }
  }
  std::vector<std::vector<char>> bytes(interpolation.neighbours.size());
  agreeOnFailure(exchange,
    [&]
    {
      for (std::size_t n = 0; n < bytes.size(); ++n)
      {
        bytes[n] = valuesOf(interpolation.sent[n], changed);
      }
    });
  bytes = exchange.exchange(interpolation.neighbours, bytes);
  agreeOnFailure(exchange,
    [&]
    {
      for (std::size_t n = 0; n < bytes.size(); ++n)
      {
        if (!bytes[n].empty())
        {
          takeOver(bytes[n], interpolation.received[n], changed);
        }
      }
    });
  return result;
}

} // namespace cadrefine
