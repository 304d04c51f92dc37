#include "PointSetConversion.h"

#include "Agreement.h"
#include "ArrayAccess.h"
#include "Error.h"
#include "GlobalNumbering.h"
#include "LargeMemory.h"
#include "MidNodeReading.h"
#include "RadixOrder.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkCellTypes.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

namespace cadrefine
{
namespace
{

/// A cell type that CADRefine takes, or with a dimension of -1 one that it does not.
struct CellKind
{
  int dimension = -1;
  bool secondOrder = false;
};

CellKind kindOf(int cellType)
{
  switch (cellType)
  {
    case VTK_VERTEX:
      return { 0, false };
    case VTK_LINE:
      return { 1, false };
    case VTK_TRIANGLE:
      return { 2, false };
    case VTK_TETRA:
      return { 3, false };
    case VTK_QUADRATIC_EDGE:
      return { 1, true };
    case VTK_QUADRATIC_TRIANGLE:
      return { 2, true };
    case VTK_QUADRATIC_TETRA:
      return { 3, true };
    default:
      return {};
  }
}

/// A readable name such as "hexahedron" for a cell type.
std::string nameOf(int cellType)
{
  std::string name = vtkCellTypes::GetClassNameFromTypeId(cellType);
  name = name.rfind("vtk", 0) == 0 ? name.substr(3) : name;
  std::transform(name.begin(), name.end(), name.begin(), ::tolower);
  return name;
}

bool isGhost(vtkUnsignedCharArray* ghosts, vtkIdType cell)
{
  return ghosts && (ghosts->GetValue(cell) & vtkDataSetAttributes::DUPLICATECELL);
}

void checkCell(int type, const CellKind& kind, CellOrder order, vtkIdType cell)
{
  const auto holds = [&]
  { return "the mesh holds a " + nameOf(type) + " (cell " + std::to_string(cell) + "); "; };
  if (kind.dimension < 0)
  {
    throw Error(holds() +
                "CADRefine takes triangles and tetrahedra (the filters Tetrahedralize and "
                "Triangulate make them)");
  }
  if (kind.secondOrder && order == CellOrder::First)
  {
    throw Error(holds() + "this filter takes cells of first order: refine the mesh of first order, "
                          "and choose Quadratic Cells in the last step");
  }
}

template<class Point, std::size_t Corners>
void appendCell(const Point* points, std::size_t expected, Simplices<Corners>& cells)
{
  if (cells.empty())
  {
    reserveLong(cells, expected);
  }
  auto& cell = cells.emplace_back();
  std::transform(
    points, points + Corners, cell.begin(), [](Point point) { return static_cast<Index>(point); });
}

/// Appends cell `number` of the data set; `expected` is how many may follow.
template<class Point>
void appendCell(
  int dimension, const Point* points, vtkIdType number, std::size_t expected, ConvertedMesh& result)
{
  auto& numbers = result.cellOf[dimension];
  if (numbers.empty())
  {
    reserveLong(numbers, expected);
  }
  numbers.push_back(number);
  switch (dimension)
  {
    case 0:
      return appendCell(points, expected, result.mesh.vertices);
    case 1:
      return appendCell(points, expected, result.mesh.segments);
    case 2:
      return appendCell(points, expected, result.mesh.triangles);
    default:
      return appendCell(points, expected, result.mesh.tetrahedra);
  }
}

/// Calls use(cell, type, points) for every cell, `points` being a pointer and a count.
template<class Use>
void forEachCell(vtkPointSet* input, const Use& use)
{
  const vtkIdType count = input->GetNumberOfCells();
  auto* grid = vtkUnstructuredGrid::SafeDownCast(input);
  if (grid && count > 0 && grid->GetCells()->IsStorage64Bit())
  {
    const auto* offsets = grid->GetCells()->GetOffsetsArray64()->GetPointer(0);
    const auto* corners = grid->GetCells()->GetConnectivityArray64()->GetPointer(0);
    const unsigned char* types = grid->GetCellTypesArray()->GetPointer(0);
    for (vtkIdType c = 0; c < count; ++c)
    {
      use(c, types[c], corners + offsets[c], offsets[c + 1] - offsets[c]);
    }
    return;
  }
  vtkNew<vtkIdList> buffer;
  const vtkIdType* points = nullptr;
  vtkIdType pointCount = 0;
  for (vtkIdType c = 0; c < count; ++c)
  {
    input->GetCellPoints(c, pointCount, points, buffer);
    use(c, input->GetCellType(c), points, pointCount);
  }
}

/// Reads the cells, with the numbers of the data set's points for vertices.
NodesOfCells readCells(vtkPointSet* input, CellOrder order, ConvertedMesh& result)
{
  vtkUnsignedCharArray* ghosts = input->GetCellGhostArray();
  const vtkIdType total = input->GetNumberOfCells();
  NodesOfCells nodes;
  forEachCell(input,
    [&](vtkIdType cell, int type, const auto* points, vtkIdType count)
    {
      if (isGhost(ghosts, cell) || type == VTK_EMPTY_CELL)
      {
        return;
      }
      const bool isPolyVertex = type == VTK_POLY_VERTEX;
      const bool isSegment = type == VTK_POLY_LINE && count == 2;
      const CellKind kind = kindOf(isPolyVertex ? VTK_VERTEX : isSegment ? VTK_LINE : type);
      checkCell(type, kind, order, cell);
      for (vtkIdType part = 0; part < (isPolyVertex ? count : 1); ++part)
      {
        appendCell(kind.dimension, points + part, cell, total - cell, result);
      }
      if (kind.secondOrder)
      {
        appendNodes(kind.dimension, points, nodes);
      }
    });
  return nodes;
}

/// Points alone: a cell of dimension 0 each, without a cell in the data set.
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

std::vector<GlobalId> readIds(vtkDataArray* array)
{
  std::vector<GlobalId> ids(array ? array->GetNumberOfTuples() : 0);
  if (!ids.empty())
  {
    copyValues(array, ids.data());
  }
  return ids;
}

/// The data set's point ids where every rank with points has them, otherwise from coordinates.
std::vector<GlobalId> pointIds(
  RankExchange& exchange, vtkPointSet* input, const std::vector<Point3>& points)
{
  vtkDataArray* given = input->GetPointData()->GetGlobalIds();
  if (!exchange.any(!given && !points.empty()))
  {
    return readIds(given);
  }
  std::vector<Key<3>> keys(points.size());
  std::transform(points.begin(), points.end(), keys.begin(),
    [](const Point3& point) { return coordinateKey(point); });
  return numberDistinct(exchange, keys).numbers;
}

template<class Use, std::size_t Corners>
void forEachCorner(Simplices<Corners>& cells, const Use& use)
{
  for (auto& cell : cells)
  {
    std::for_each(cell.begin(), cell.end(), use);
  }
}

template<class Use>
void forEachCorner(SimplexMesh& mesh, const Use& use)
{
  forEachCorner(mesh.vertices, use);
  forEachCorner(mesh.segments, use);
  forEachCorner(mesh.triangles, use);
  forEachCorner(mesh.tetrahedra, use);
}

/// The vertex that each point becomes, numbered in the order of the points: one for each id; -1 for
/// points that are not used.
std::vector<Index> numberVertices(
  const std::vector<GlobalId>& ids, const std::vector<unsigned char>& used)
{
  std::vector<PlacedKey> keys;
  keys.reserve(ids.size());
  for (std::size_t p = 0; p < ids.size(); ++p)
  {
    if (used[p])
    {
      keys.push_back({ orderedBits(ids[p]), static_cast<std::uint32_t>(p) });
    }
  }
  radixSort(keys);
  std::vector<Index> firstWithId(ids.size(), -1);
  for (std::size_t k = 0; k < keys.size(); ++k)
  {
    const bool again = k > 0 && keys[k - 1].key == keys[k].key;
    firstWithId[keys[k].place] =
      again ? firstWithId[keys[k - 1].place] : static_cast<Index>(keys[k].place);
  }
  std::vector<Index> vertexOf = std::move(firstWithId);
  Index next = 0;
  for (std::size_t p = 0; p < vertexOf.size(); ++p)
  {
    if (vertexOf[p] >= 0)
    {
      vertexOf[p] = vertexOf[p] == static_cast<Index>(p) ? next++ : vertexOf[vertexOf[p]];
    }
  }
  return vertexOf;
}

template<std::size_t Corners>
void checkCells(const Simplices<Corners>& cells, const std::vector<vtkIdType>& cellOf)
{
  for (std::size_t c = 0; c < cells.size(); ++c)
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
      throw Error("cell " + std::to_string(cellOf[c]) +
                  " of the mesh names a point twice, or two points at the same place");
    }
  }
}

/// Makes vertices of the points that cells use, and makes the cells name them.
void makeVertices(
  const std::vector<Point3>& points, const std::vector<GlobalId>& ids, ConvertedMesh& result)
{
  std::vector<unsigned char> used(points.size(), 0);
  forEachCorner(result.mesh, [&](Index point) { used[point] = 1; });
  const std::vector<Index> vertexOf = numberVertices(ids, used);
  for (std::size_t p = 0; p < points.size(); ++p)
  {
    if (vertexOf[p] == static_cast<Index>(result.pointOf.size()))
    {
      checkFinite(points[p], static_cast<vtkIdType>(p));
      result.pointOf.push_back(static_cast<vtkIdType>(p));
      result.mesh.points.push_back(points[p]);
      result.mesh.ids.push_back(ids[p]);
    }
  }
  forEachCorner(result.mesh, [&](Index& corner) { corner = vertexOf[corner]; });
  checkCells(result.mesh.segments, result.cellOf[1]);
  checkCells(result.mesh.triangles, result.cellOf[2]);
  checkCells(result.mesh.tetrahedra, result.cellOf[3]);
}

/// The data set's cell ids where every rank with cells has them, otherwise none.
void readCellIds(RankExchange& exchange, vtkPointSet* input, ConvertedMesh& result)
{
  vtkDataArray* given = input->GetCellData()->GetGlobalIds();
  if (exchange.any(!given && result.mesh.cellCount() > 0))
  {
    return;
  }
  const std::vector<GlobalId> idOf = readIds(given);
  for (int d = 0; d < 4; ++d)
  {
    reserveLong(result.cellIds[d], result.cellOf[d].size());
    std::transform(result.cellOf[d].begin(), result.cellOf[d].end(),
      std::back_inserter(result.cellIds[d]), [&](vtkIdType cell) { return idOf[cell]; });
  }
}

} // namespace

ConvertedMesh convert(RankExchange& exchange, vtkPointSet* input, CellOrder order)
{
  ConvertedMesh result;
  NodesOfCells nodes;
  attempt(exchange, [&] { nodes = readCells(input, order, result); });
  if (exchange.sum(input->GetNumberOfPoints()) == 0)
  {
    throw Error("the mesh has no points");
  }
  if (exchange.sum(input->GetNumberOfCells()) == 0)
  {
    addLonePoints(input, result);
  }
  result.mesh.dimension = highestDimension(exchange, result);
  if (result.mesh.dimension == 1)
  {
    throw Error("the mesh is one of lines; CADRefine takes triangles and tetrahedra");
  }
  const std::vector<Point3> points = readPoints(input);
  const auto ids = pointIds(exchange, input, points);
  attempt(exchange, [&] { makeVertices(points, ids, result); });
  if (order == CellOrder::FirstOrSecond && isOfSecondOrder(exchange, result, nodes))
  {
    attempt(exchange, [&] { readMidNodes(points, ids, nodes, result); });
  }
  readCellIds(exchange, input, result);
  return result;
}

} // namespace cadrefine
