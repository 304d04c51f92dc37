#include "PointSetConversion.h"

#include "Agreement.h"
#include "Error.h"
#include "GlobalNumbering.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkCellTypes.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <unordered_map>

namespace cadrefine
{
namespace
{

/// Dimension of a cell type that CADRefine takes, or -1.
int dimensionOf(int cellType)
{
  switch (cellType)
  {
    case VTK_VERTEX:
      return 0;
    case VTK_LINE:
      return 1;
    case VTK_TRIANGLE:
      return 2;
    case VTK_TETRA:
      return 3;
    default:
      return -1;
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

/// Cells in terms of the data set's points.
struct RawCells
{
  std::array<std::vector<vtkIdType>, 4> cells;
  std::array<std::vector<vtkIdType>, 4> points; ///< dimension + 1 for each cell.
};

void checkCell(int type, int dimension, vtkIdType cell)
{
  if (dimension < 0)
  {
    throw Error(
      "the mesh holds a " + nameOf(type) + " (cell " + std::to_string(cell) +
      "); CADRefine takes triangles and tetrahedra (the filters Tetrahedralize and Triangulate "
      "make them)");
  }
}

RawCells readCells(vtkPointSet* input)
{
  RawCells raw;
  vtkUnsignedCharArray* ghosts = input->GetCellGhostArray();
  vtkNew<vtkIdList> points;
  for (vtkIdType c = 0; c < input->GetNumberOfCells(); ++c)
  {
    const int type = input->GetCellType(c);
    if (isGhost(ghosts, c) || type == VTK_EMPTY_CELL)
    {
      continue;
    }
    input->GetCellPoints(c, points);
    const bool isPolyVertex = type == VTK_POLY_VERTEX;
    const bool isSegment = type == VTK_POLY_LINE && points->GetNumberOfIds() == 2;
    const int dimension = isPolyVertex ? 0 : isSegment ? 1 : dimensionOf(type);
    checkCell(type, dimension, c);
    raw.points[dimension].insert(raw.points[dimension].end(), points->begin(), points->end());
    raw.cells[dimension].insert(
      raw.cells[dimension].end(), isPolyVertex ? points->GetNumberOfIds() : 1, c);
  }
  return raw;
}

/// Points alone: a cell of dimension 0 each, without a cell in the data set.
void addLonePoints(vtkPointSet* input, RawCells& raw)
{
  for (vtkIdType p = 0; p < input->GetNumberOfPoints(); ++p)
  {
    raw.points[0].push_back(p);
    raw.cells[0].push_back(-1);
  }
}

int highestDimension(RankExchange& exchange, const RawCells& raw)
{
  int dimension = -1;
  for (int d = 0; d < 4; ++d)
  {
    dimension = raw.cells[d].empty() ? dimension : d;
  }
  return static_cast<int>(exchange.max(dimension));
}

/// The data set's point ids where every rank with points has them, otherwise from coordinates.
std::vector<GlobalId> pointIds(RankExchange& exchange, vtkPointSet* input)
{
  vtkDataArray* given = input->GetPointData()->GetGlobalIds();
  const vtkIdType count = input->GetNumberOfPoints();
  if (exchange.any(!given && count > 0))
  {
    std::vector<Key<3>> keys(count);
    for (vtkIdType p = 0; p < count; ++p)
    {
      Point3 point;
      input->GetPoint(p, point.data());
      keys[p] = coordinateKey(point);
    }
    return numberDistinct(exchange, keys).numbers;
  }
  std::vector<GlobalId> ids;
  for (vtkIdType p = 0; given && p < count; ++p)
  {
    ids.push_back(static_cast<GlobalId>(given->GetTuple1(p)));
  }
  return ids;
}

/// Gives each used point its vertex, one for each id.
class VertexMaker
{
public:
  VertexMaker(vtkPointSet* input, const std::vector<GlobalId>& ids, ConvertedMesh& result)
    : input_(input), ids_(ids), result_(result), vertexOf_(ids.size(), -1)
  {
  }

  Index vertex(vtkIdType point)
  {
    Index& vertex = vertexOf_[point];
    if (vertex < 0)
    {
      const auto next = static_cast<Index>(result_.pointOf.size());
      const auto [entry, isNew] = vertexOfId_.emplace(ids_[point], next);
      vertex = entry->second;
      if (isNew)
      {
        add(point);
      }
    }
    return vertex;
  }

private:
  void add(vtkIdType point)
  {
    Point3 coordinates;
    input_->GetPoint(point, coordinates.data());
    for (const double x : coordinates)
    {
      if (!std::isfinite(x))
      {
        throw Error(
          "the mesh has a coordinate that is not finite (point " + std::to_string(point) + ")");
      }
    }
    result_.pointOf.push_back(point);
    result_.mesh.points.push_back(coordinates);
    result_.mesh.ids.push_back(ids_[point]);
  }

  vtkPointSet* input_;
  const std::vector<GlobalId>& ids_;
  ConvertedMesh& result_;
  std::vector<Index> vertexOf_;
  std::unordered_map<GlobalId, Index> vertexOfId_;
};

template<std::size_t Corners>
void makeCells(
  const RawCells& raw, VertexMaker& maker, std::vector<std::array<Index, Corners>>& cells)
{
  const auto& points = raw.points[Corners - 1];
  for (std::size_t c = 0; c * Corners < points.size(); ++c)
  {
    auto& cell = cells.emplace_back();
    for (std::size_t k = 0; k < Corners; ++k)
    {
      cell[k] = maker.vertex(points[c * Corners + k]);
    }
    auto sorted = cell;
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
    {
      throw Error("cell " + std::to_string(raw.cells[Corners - 1][c]) +
                  " of the mesh names a point twice, or two points at the same place");
    }
  }
}

/// Vertices for the points that cells use, in the order of the points.
void makeVertices(const RawCells& raw, std::size_t pointCount, VertexMaker& maker)
{
  std::vector<unsigned char> used(pointCount, 0);
  for (const auto& points : raw.points)
  {
    for (const vtkIdType point : points)
    {
      used[point] = 1;
    }
  }
  for (std::size_t p = 0; p < pointCount; ++p)
  {
    if (used[p])
    {
      maker.vertex(static_cast<vtkIdType>(p));
    }
  }
}

void makeMesh(
  vtkPointSet* input, const RawCells& raw, const std::vector<GlobalId>& ids, ConvertedMesh& result)
{
  VertexMaker maker(input, ids, result);
  makeVertices(raw, ids.size(), maker);
  makeCells(raw, maker, result.mesh.vertices);
  makeCells(raw, maker, result.mesh.segments);
  makeCells(raw, maker, result.mesh.triangles);
  makeCells(raw, maker, result.mesh.tetrahedra);
  result.cellOf = raw.cells;
}

/// Appends the sorted vertex ids of each cell, filled up with -1.
template<std::size_t Corners>
void appendKeys(const SimplexMesh& mesh, const std::vector<std::array<Index, Corners>>& cells,
  std::vector<Key<4>>& keys)
{
  for (const auto& cell : cells)
  {
    Key<4> key{ -1, -1, -1, -1 };
    std::transform(
      cell.begin(), cell.end(), key.begin(), [&](Index vertex) { return mesh.ids[vertex]; });
    std::sort(key.begin(), key.begin() + Corners);
    keys.push_back(key);
  }
}

std::vector<GlobalId> numberCells(RankExchange& exchange, const SimplexMesh& mesh)
{
  std::vector<Key<4>> keys;
  appendKeys(mesh, mesh.vertices, keys);
  appendKeys(mesh, mesh.segments, keys);
  appendKeys(mesh, mesh.triangles, keys);
  appendKeys(mesh, mesh.tetrahedra, keys);
  return numberDistinct(exchange, keys).numbers;
}

void setCellIds(RankExchange& exchange, vtkPointSet* input, ConvertedMesh& result)
{
  vtkDataArray* given = input->GetCellData()->GetGlobalIds();
  const bool usable = !exchange.any(!given && result.mesh.cellCount() > 0);
  const auto numbers = usable ? std::vector<GlobalId>{} : numberCells(exchange, result.mesh);
  std::size_t next = 0;
  for (int d = 0; d < 4; ++d)
  {
    for (const vtkIdType cell : result.cellOf[d])
    {
      result.cellIds[d].push_back(
        usable && given ? static_cast<GlobalId>(given->GetTuple1(cell)) : numbers[next]);
      ++next;
    }
  }
}

template<std::size_t Corners>
void insertCells(const std::vector<std::array<Index, Corners>>& cells, vtkCellArray* output)
{
  for (const auto& cell : cells)
  {
    output->InsertNextCell(static_cast<vtkIdType>(Corners));
    for (const Index vertex : cell)
    {
      output->InsertCellPoint(vertex);
    }
  }
}

vtkSmartPointer<vtkPointSet> makePolyData(const SimplexMesh& mesh)
{
  vtkNew<vtkCellArray> vertices;
  vtkNew<vtkCellArray> lines;
  vtkNew<vtkCellArray> triangles;
  insertCells(mesh.vertices, vertices);
  insertCells(mesh.segments, lines);
  insertCells(mesh.triangles, triangles);
  auto output = vtkSmartPointer<vtkPolyData>::New();
  output->SetVerts(vertices);
  output->SetLines(lines);
  output->SetPolys(triangles);
  return output;
}

vtkSmartPointer<vtkPointSet> makeUnstructuredGrid(const SimplexMesh& mesh)
{
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkUnsignedCharArray> types;
  const auto count = static_cast<vtkIdType>(mesh.cellCount());
  cells->AllocateExact(count, 4 * count);
  insertCells(mesh.vertices, cells);
  insertCells(mesh.segments, cells);
  insertCells(mesh.triangles, cells);
  insertCells(mesh.tetrahedra, cells);
  types->SetNumberOfValues(count);
  constexpr unsigned char typeOf[4] = { VTK_VERTEX, VTK_LINE, VTK_TRIANGLE, VTK_TETRA };
  for (int d = 0; d < 4; ++d)
  {
    const vtkIdType end = d < 3 ? firstCellOfDimension(mesh, d + 1) : count;
    std::fill(types->GetPointer(firstCellOfDimension(mesh, d)), types->GetPointer(end), typeOf[d]);
  }
  auto output = vtkSmartPointer<vtkUnstructuredGrid>::New();
  output->SetCells(types, cells);
  return output;
}

} // namespace

ConvertedMesh convert(RankExchange& exchange, vtkPointSet* input)
{
  ConvertedMesh result;
  RawCells raw;
  attempt(exchange, [&] { raw = readCells(input); });
  if (exchange.sum(input->GetNumberOfPoints()) == 0)
  {
    throw Error("the mesh has no points");
  }
  if (exchange.sum(input->GetNumberOfCells()) == 0)
  {
    addLonePoints(input, raw);
  }
  result.mesh.dimension = highestDimension(exchange, raw);
  if (result.mesh.dimension == 1)
  {
    throw Error("the mesh is one of lines; CADRefine takes triangles and tetrahedra");
  }
  const auto ids = pointIds(exchange, input);
  attempt(exchange, [&] { makeMesh(input, raw, ids, result); });
  setCellIds(exchange, input, result);
  return result;
}

vtkIdType firstCellOfDimension(const SimplexMesh& mesh, int dimension)
{
  const std::size_t counts[3] = { mesh.vertices.size(), mesh.segments.size(),
    mesh.triangles.size() };
  vtkIdType first = 0;
  for (int d = 0; d < dimension; ++d)
  {
    first += static_cast<vtkIdType>(counts[d]);
  }
  return first;
}

vtkSmartPointer<vtkPointSet> makePointSet(vtkPointSet* input, const SimplexMesh& mesh)
{
  auto output = vtkPolyData::SafeDownCast(input) ? makePolyData(mesh) : makeUnstructuredGrid(mesh);
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(mesh.points.size()));
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
  {
    points->SetPoint(static_cast<vtkIdType>(v), mesh.points[v].data());
  }
  output->SetPoints(points);
  return output;
}

} // namespace cadrefine
