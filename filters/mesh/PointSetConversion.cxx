#include "mesh/PointSetConversion.h"

#include "comm/CollectiveErrors.h"
#include "comm/GlobalNumbering.h"
#include "comm/Threads.h"
#include "mesh/ArrayAccess.h"
#include "mesh/CellReading.h"
#include "mesh/GlobalIdReading.h"
#include "mesh/MidNodeReading.h"

#include <cadrefine/base/Error.h>
#include <cadrefine/base/LargeMemory.h>

#include <vtkCellData.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <string>

namespace cadrefine
{
namespace
{

/// Makes a cell of dimension 0 of each point of a data set of points alone, which has no cells.
void addLonePoints(vtkPointSet* input, ConvertedMesh& result)
{
  for (vtkIdType p = 0; p < input->GetNumberOfPoints(); ++p)
  {
    result.mesh.vertices.push_back({ static_cast<Index>(p) });
    result.cellOf[0].push_back(-1);
  }
}

int highestDimension(RankExchange& exchange, const ConvertedMesh& converted)
{
  int dimension = -1;
  for (int d = 0; d < 4; ++d)
  {
    dimension = converted.cellOf[d].empty() ? dimension : d;
  }
  return static_cast<int>(exchange.max(dimension));
}

std::vector<Point3> readPoints(vtkPointSet* input)
{
  std::vector<Point3> points(input->GetNumberOfPoints());
  if (!points.empty())
  {
    copyValues(input->GetPoints()->GetData(), points.front().data());
  }
  return points;
}

/// The ids of points, and the array that they are from, if any.
struct PointIds
{
  std::vector<GlobalId> ids;
  vtkDataArray* given = nullptr;
};

/// The data set's point ids where every rank with points has them, otherwise from coordinates.
PointIds pointIds(RankExchange& exchange, vtkPointSet* input, const std::vector<Point3>& points,
  const ParallelFor& parallelFor)
{
  vtkDataArray* given = input->GetPointData()->GetGlobalIds();
  if (!exchange.any(!given && !points.empty()))
  {
    return { readGlobalIds(given, parallelFor), given };
  }
  std::vector<Key<3>> keys(points.size());
  std::transform(points.begin(), points.end(), keys.begin(),
    [](const Point3& point) { return coordinateKey(point); });
  return { numberDistinct(exchange, keys).numbers };
}

template<class Use, std::size_t Corners>
void forEachCorner(Cells<Corners>& cells, const ParallelFor& parallelFor, const Use& use)
{
  forEachIndex(parallelFor, cells.size(), fineGrain,
    [&](std::size_t c) { std::for_each(cells[c].begin(), cells[c].end(), use); });
}

template<class Use>
void forEachCorner(Mesh& mesh, const ParallelFor& parallelFor, const Use& use)
{
  visitShapes(mesh, [&](auto, auto& cells) { forEachCorner(cells, parallelFor, use); });
}

/// Flags that threads may set at once.
using Flags = std::vector<std::atomic<unsigned char>>;

/// 1 for the points that cells use.
Flags findUsed(Mesh& mesh, std::size_t points, const ParallelFor& parallelFor)
{
  Flags used(points);
  forEachCorner(
    mesh, parallelFor, [&](Index point) { used[point].store(1, std::memory_order_relaxed); });
  return used;
}

/// Throws Error for a cell that names a vertex twice. `cellOf` has the numbers of these cells in
/// the data set.
template<std::size_t Corners>
void checkCells(
  const Cells<Corners>& cells, const vtkIdType* cellOf, const ParallelFor& parallelFor)
{
  const auto check = [&](std::size_t c)
  {
    bool distinct = true;
    for (std::size_t k = 1; k < Corners; ++k)
    {
      for (std::size_t i = 0; i < k; ++i)
      {
        distinct = distinct && cells[c][i] != cells[c][k];
      }
    }
    if (!distinct)
    {
      throw Error(
        "cell " + std::to_string(cellOf[c]) + " of the mesh has repeated or coincident points");
    }
  };
  forEachIndex(parallelFor, cells.size(), fineGrain, check);
}

/// The sixth power of a longer length overflows: cells are judged by squares of volumes.
constexpr double largestCoordinate = 0x1p170;

void checkCoordinates(const Point3& point, vtkIdType number)
{
  for (const double x : point)
  {
    if (!std::islessequal(std::abs(x), largestCoordinate))
    {
      throw Error(std::string("the mesh has a coordinate that is ") +
                  (std::isfinite(x) ? "beyond 1.5e51" : "not finite") + " (point " +
                  std::to_string(number) + "); correct it, or remove the cells that use the point");
    }
  }
}

void checkPoint(const Point3& point, const PointIds& ids, vtkIdType number)
{
  checkCoordinates(point, number);
  if (ids.given)
  {
    checkGlobalId(ids.ids[number], ids.given, number, "point");
  }
}

/// Makes vertices of the points that cells use.
void takeVertices(const std::vector<Point3>& points, const PointIds& ids,
  const std::vector<Index>& vertexOf, ConvertedMesh& result)
{
  reserveLong(result.pointOf, points.size());
  reserveLong(result.mesh.points, points.size());
  reserveLong(result.mesh.ids, points.size());
  for (std::size_t p = 0; p < points.size(); ++p)
  {
    const auto point = static_cast<vtkIdType>(p);
    if (vertexOf[p] < 0)
    {
      continue;
    }
    checkPoint(points[p], ids, point);
    if (vertexOf[p] == static_cast<Index>(result.pointOf.size()))
    {
      result.pointOf.push_back(point);
      result.mesh.points.push_back(points[p]);
      result.mesh.ids.push_back(ids.ids[p]);
    }
    else if (points[p] != result.mesh.points[vertexOf[p]])
    {
      throw Error("the points " + std::to_string(result.pointOf[vertexOf[p]]) + " and " +
                  std::to_string(p) + " of the mesh have the same global id, " +
                  std::to_string(ids.ids[p]) + ", but different coordinates");
    }
  }
}

/// Makes vertices of the points that cells use, and makes the cells name them.
void makeVertices(const std::vector<Point3>& points, const PointIds& ids, ConvertedMesh& result,
  const ParallelFor& parallelFor)
{
  const Flags used = findUsed(result.mesh, points.size(), parallelFor);
  const std::vector<Index> vertexOf =
    numberByIds(ids.ids, [&](std::size_t point) { return used[point] != 0; });
  takeVertices(points, ids, vertexOf, result);
  forEachCorner(result.mesh, parallelFor, [&](Index& corner) { corner = vertexOf[corner]; });
  for (int d = 1; d < 4; ++d)
  {
    const vtkIdType* cellOf = result.cellOf[d].data();
    visitShapes(result.mesh, d,
      [&](auto, const auto& cells)
      {
        checkCells(cells, cellOf, parallelFor);
        cellOf += cells.size();
      });
  }
}

/// Makes the wedges turn counter-clockwise, where most of all ranks turn the other way. Wedges
/// among them that do turn counter-clockwise are then inverted cells.
void turnWedges(RankExchange& exchange, Mesh& mesh)
{
  std::int64_t turns = 0;
  for (const auto& wedge : mesh.wedges)
  {
    const auto at = [&](int corner) { return mesh.points[wedge[corner]]; };
    const Vector3 up = at(3) + at(4) + at(5) - (at(0) + at(1) + at(2));
    const double turn = determinant(up, at(1) - at(0), at(2) - at(0));
    turns += (turn > 0) - (turn < 0);
  }
  mesh.wedgesAsDocumented = exchange.sum(turns) <= 0; // also those that refinement will make
  if (mesh.wedgesAsDocumented)
  {
    std::transform(mesh.wedges.begin(), mesh.wedges.end(), mesh.wedges.begin(), turned);
  }
}

/// The ids of these cells of the data set.
std::vector<GlobalId> cellIds(vtkDataArray* given, const std::vector<GlobalId>& idOf,
  const std::vector<vtkIdType>& cells, const ParallelFor& parallelFor)
{
  std::vector<GlobalId> ids;
  resizeLong(ids, cells.size(), parallelFor);
  const auto take = [&](std::size_t c)
  {
    checkGlobalId(idOf[cells[c]], given, cells[c], "cell");
    ids[c] = idOf[cells[c]];
  };
  forEachIndex(parallelFor, cells.size(), fineGrain, take);
  return ids;
}

/// The data set's cell ids where every rank with cells has them, otherwise none.
void readCellIds(
  RankExchange& exchange, vtkPointSet* input, ConvertedMesh& result, const ParallelFor& parallelFor)
{
  vtkDataArray* given = input->GetCellData()->GetGlobalIds();
  if (exchange.any(!given && result.mesh.cellCount() > 0))
  {
    return;
  }
  const std::vector<GlobalId> idOf = readGlobalIds(given, parallelFor);
  agreeOnFailure(exchange,
    [&]
    {
      for (int d = 0; d < 4; ++d)
      {
        result.cellIds[d] = cellIds(given, idOf, result.cellOf[d], parallelFor);
      }
    });
}

} // namespace

ConvertedMesh convert(RankExchange& exchange, vtkPointSet* input, CellOrder order)
{
  const ParallelFor parallelFor = forOnThreads(exchange);
  ConvertedMesh result;
  NodesOfCells nodes;
  agreeOnFailure(exchange, [&] { nodes = readCells(input, order, result, parallelFor); });
  if (exchange.sum(input->GetNumberOfPoints()) == 0)
  {
    throw Error("the mesh has no points");
  }
  if (exchange.sum(input->GetNumberOfCells()) == 0)
  {
    addLonePoints(input, result);
  }
  result.mesh.dimension = highestDimension(exchange, result);
  if (result.mesh.dimension < 0)
  {
    throw Error("all cells of the mesh are empty, or marked as ghosts or hidden");
  }
  if (result.mesh.dimension == 1)
  {
    throw Error("the mesh consists of lines only; CADRefine refines triangles, quadrilaterals and "
                "volume cells");
  }
  const std::vector<Point3> points = readPoints(input);
  const auto ids = pointIds(exchange, input, points, parallelFor);
  agreeOnFailure(exchange, [&] { makeVertices(points, ids, result, parallelFor); });
  turnWedges(exchange, result.mesh);
  if (order == CellOrder::FirstOrSecond && isOfSecondOrder(exchange, result, nodes))
  {
    agreeOnFailure(exchange,
      [&]
      {
        readMidNodes(points, ids.ids, nodes, result);
        for (std::size_t v = result.mesh.points.size(); v < result.pointOf.size(); ++v)
        {
          checkPoint(points[result.pointOf[v]], ids, result.pointOf[v]);
        }
      });
  }
  readCellIds(exchange, input, result, parallelFor);
  return result;
}

} // namespace cadrefine
