#include "DataSets.h"

#include "TestMeshes.h"

#include <cadrefine/mesh/CellJacobian.h>
#include <cadrefine/mesh/CellState.h>

#include <vtkAbstractArray.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTable.h>
#include <vtkUnstructuredGrid.h>
#include <vtkVariant.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <stdexcept>

namespace cadtest
{

using namespace cadrefine;

namespace
{

vtkNew<vtkPoints> pointsOf(const Mesh& mesh)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const Point3& point : mesh.points)
  {
    points->InsertNextPoint(point.data());
  }
  return points;
}

/// Whether `b` has the arrays of `a`, and no others, bit for bit.
testing::AssertionResult compareArrays(vtkFieldData* a, vtkFieldData* b)
{
  if (a->GetNumberOfArrays() != b->GetNumberOfArrays())
  {
    return testing::AssertionFailure() << "other arrays";
  }
  for (int k = 0; k < a->GetNumberOfArrays(); ++k)
  {
    vtkDataArray* first = a->GetArray(k);
    vtkDataArray* second = b->GetArray(first->GetName());
    const std::size_t bytes = first->GetNumberOfValues() * first->GetDataTypeSize();
    if (!second || second->GetDataType() != first->GetDataType() ||
        second->GetNumberOfValues() != first->GetNumberOfValues() ||
        std::memcmp(first->GetVoidPointer(0), second->GetVoidPointer(0), bytes) != 0)
    {
      return testing::AssertionFailure() << "another array " << first->GetName();
    }
  }
  return testing::AssertionSuccess();
}

template<std::size_t Corners>
void insertCells(const Cells<Corners>& cells, int type, vtkUnstructuredGrid* grid)
{
  for (const auto& cell : cells)
  {
    vtkIdType points[Corners];
    std::copy(cell.begin(), cell.end(), points);
    grid->InsertNextCell(type, static_cast<vtkIdType>(Corners), points);
  }
}

template<std::size_t Corners>
void readCell(vtkIdList* points, Cells<Corners>& cells)
{
  auto& cell = cells.emplace_back();
  for (std::size_t k = 0; k < Corners; ++k)
  {
    cell[k] = static_cast<Index>(points->GetId(static_cast<vtkIdType>(k)));
  }
}

/// Of which each last two of four corners are the other way round.
template<std::size_t Corners>
void readRows(vtkIdList* points, Cells<Corners>& cells)
{
  readCell(points, cells);
  for (std::size_t k = 2; k < Corners; k += 4)
  {
    std::swap(cells.back()[k], cells.back()[k + 1]);
  }
}

void readCell(int type, vtkIdList* points, Mesh& mesh)
{
  switch (type)
  {
    case VTK_VOXEL:
      return readRows(points, mesh.hexahedra);
    case VTK_PIXEL:
      return readRows(points, mesh.quadrilaterals);
    case VTK_HEXAHEDRON:
    case VTK_QUADRATIC_HEXAHEDRON:
    case VTK_TRIQUADRATIC_HEXAHEDRON:
      return readCell(points, mesh.hexahedra);
    case VTK_WEDGE:
    case VTK_QUADRATIC_WEDGE:
      return readCell(points, mesh.wedges);
    case VTK_PYRAMID:
    case VTK_QUADRATIC_PYRAMID:
      return readCell(points, mesh.pyramids);
    case VTK_TETRA:
    case VTK_QUADRATIC_TETRA:
      return readCell(points, mesh.tetrahedra);
    case VTK_QUAD:
    case VTK_QUADRATIC_QUAD:
      return readCell(points, mesh.quadrilaterals);
    case VTK_TRIANGLE:
    case VTK_QUADRATIC_TRIANGLE:
      return readCell(points, mesh.triangles);
    case VTK_LINE:
    case VTK_QUADRATIC_EDGE:
      return readCell(points, mesh.segments);
    case VTK_VERTEX:
      return readCell(points, mesh.vertices);
    default:
      throw std::runtime_error("a cell of type " + std::to_string(type));
  }
}

/// As a mesh has them, where most are as VTK's documentation draws them.
void turnWedges(Mesh& mesh)
{
  std::ptrdiff_t turned = 0;
  for (const auto& wedge : mesh.wedges)
  {
    const double size = volume(cornersOf(wedge, mesh.points));
    turned += (size < 0) - (size > 0);
  }
  if (turned > 0)
  {
    for (auto& w : mesh.wedges)
    {
      w = { w[3], w[4], w[5], w[0], w[1], w[2] };
    }
  }
}

template<class Array>
vtkNew<Array> named(const char* name, int components = 1)
{
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  return array;
}

/// A permutation of 0 ... count - 1, spread out.
vtkNew<vtkIdTypeArray> scatteredIds(const char* name, vtkIdType count)
{
  auto ids = named<vtkIdTypeArray>(name);
  const vtkIdType step = 7919; // a prime larger than any count of these tests' inputs
  for (vtkIdType i = 0; i < count; ++i)
  {
    ids->InsertNextValue(3 * (i * step % count) + 5);
  }
  return ids;
}

struct Values
{
  std::vector<double> numbers;
  std::vector<std::string> texts;

  bool operator==(const Values& other) const
  {
    return numbers == other.numbers && texts == other.texts;
  }
};

std::map<std::string, Values> fieldValues(vtkPointSet* mesh)
{
  std::map<std::string, Values> values;
  vtkFieldData* fields = mesh->GetFieldData();
  for (int a = 0; a < fields->GetNumberOfArrays(); ++a)
  {
    vtkAbstractArray* array = fields->GetAbstractArray(a);
    Values& here = values[array->GetName()];
    for (vtkIdType i = 0; i < array->GetNumberOfValues(); ++i)
    {
      const vtkVariant value = array->GetVariantValue(i);
      value.IsString() ? here.texts.push_back(value.ToString())
                       : here.numbers.push_back(value.ToDouble());
    }
  }
  return values;
}

} // namespace

vtkSmartPointer<vtkUnstructuredGrid> toGrid(const Mesh& mesh)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->SetPoints(pointsOf(mesh));
  grid->Allocate(static_cast<vtkIdType>(mesh.cellCount()));
  insertCells(mesh.vertices, VTK_VERTEX, grid);
  insertCells(mesh.segments, VTK_LINE, grid);
  insertCells(mesh.triangles, VTK_TRIANGLE, grid);
  insertCells(mesh.quadrilaterals, VTK_QUAD, grid);
  insertCells(mesh.tetrahedra, VTK_TETRA, grid);
  insertCells(mesh.pyramids, VTK_PYRAMID, grid);
  insertCells(mesh.wedges, VTK_WEDGE, grid);
  insertCells(mesh.hexahedra, VTK_HEXAHEDRON, grid);
  return grid;
}

vtkSmartPointer<vtkPolyData> toPolyData(const Mesh& mesh)
{
  vtkNew<vtkCellArray> polygons;
  for (const auto& [a, b, c] : mesh.triangles)
  {
    polygons->InsertNextCell({ a, b, c });
  }
  for (const auto& [a, b, c, d] : mesh.quadrilaterals)
  {
    polygons->InsertNextCell({ a, b, c, d });
  }
  auto result = vtkSmartPointer<vtkPolyData>::New();
  result->SetPoints(pointsOf(mesh));
  result->SetPolys(polygons);
  return result;
}

Mesh toMesh(vtkPointSet* dataSet)
{
  Mesh mesh;
  for (vtkIdType p = 0; p < dataSet->GetNumberOfPoints(); ++p)
  {
    dataSet->GetPoint(p, mesh.points.emplace_back().data());
    mesh.ids.push_back(p);
  }
  vtkNew<vtkIdList> points;
  for (vtkIdType c = 0; c < dataSet->GetNumberOfCells(); ++c)
  {
    dataSet->GetCellPoints(c, points);
    readCell(dataSet->GetCellType(c), points, mesh);
  }
  mesh.dimension = mesh.cellCount(3) == 0 ? 2 : 3;
  turnWedges(mesh);
  return mesh;
}

vtkSmartPointer<vtkUnstructuredGrid> readGrid(const std::string& path)
{
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  if (reader->GetErrorCode() != 0 || reader->GetOutput()->GetNumberOfCells() == 0)
  {
    throw std::runtime_error("cannot read " + path);
  }
  return reader->GetOutput();
}

std::vector<std::string> differentFields(vtkPointSet* found, vtkPointSet* expected)
{
  auto values = fieldValues(found);
  std::vector<std::string> different;
  for (const auto& [name, value] : fieldValues(expected))
  {
    if (values.count(name) == 0 || !(values[name] == value))
    {
      different.push_back(name);
    }
    values.erase(name);
  }
  for (const auto& [name, value] : values)
  {
    different.push_back(name);
  }
  return different;
}

double fieldValue(vtkPointSet* dataSet, const char* name)
{
  vtkDataArray* array = dataSet->GetFieldData()->GetArray(name);
  if (!array || array->GetNumberOfValues() != 1)
  {
    throw std::runtime_error(std::string("no field value ") + name);
  }
  return array->GetTuple1(0);
}

std::map<std::string, std::vector<double>> columnsOf(vtkDataObject* table)
{
  vtkTable* rows = vtkTable::SafeDownCast(table);
  if (!rows)
  {
    throw std::runtime_error("no table");
  }
  std::map<std::string, std::vector<double>> columns;
  for (vtkIdType c = 0; c < rows->GetNumberOfColumns(); ++c)
  {
    auto& values = columns[rows->GetColumnName(c)];
    for (vtkIdType r = 0; r < rows->GetNumberOfRows(); ++r)
    {
      values.push_back(rows->GetValue(r, c).ToDouble());
    }
  }
  return columns;
}

testing::AssertionResult areSame(vtkPointSet* a, vtkPointSet* b)
{
  const Mesh first = toMesh(a);
  const Mesh second = toMesh(b);
  if (first.points != second.points)
  {
    return testing::AssertionFailure() << "other points";
  }
  bool sameCells = true;
  visitShapes(first, [&](auto shape, const auto& cells)
    { sameCells = sameCells && cells == second.*decltype(shape)::cells; });
  if (!sameCells)
  {
    return testing::AssertionFailure() << "other cells";
  }
  const auto points = compareArrays(a->GetPointData(), b->GetPointData());
  return points ? compareArrays(a->GetCellData(), b->GetCellData()) : points;
}

double linearAt(const double point[3])
{
  return 1 + 2 * point[0] - 3 * point[1] + 0.5 * point[2];
}

void addArrays(vtkPointSet* dataSet)
{
  auto linear = named<vtkDoubleArray>("Linear");
  auto region = named<vtkIntArray>("Region");
  for (vtkIdType p = 0; p < dataSet->GetNumberOfPoints(); ++p)
  {
    linear->InsertNextValue(linearAt(dataSet->GetPoint(p)));
    region->InsertNextValue(static_cast<int>(p % 4));
  }
  auto tag = named<vtkIntArray>("Tag");
  auto colour = named<vtkFloatArray>("Colour", 3);
  for (vtkIdType c = 0; c < dataSet->GetNumberOfCells(); ++c)
  {
    tag->InsertNextValue(static_cast<int>(c));
    colour->InsertNextTuple3(0.25 * static_cast<double>(c), 1, -1);
  }
  dataSet->GetPointData()->AddArray(linear);
  dataSet->GetPointData()->AddArray(region);
  dataSet->GetCellData()->AddArray(tag);
  dataSet->GetCellData()->AddArray(colour);
}

void addLargestX(vtkPointSet* dataSet, const char* name)
{
  vtkNew<vtkDoubleArray> values;
  values->SetName(name);
  for (vtkIdType c = 0; c < dataSet->GetNumberOfCells(); ++c)
  {
    std::array<double, 6> bounds{};
    dataSet->GetCellBounds(c, bounds.data());
    values->InsertNextValue(bounds[1]);
  }
  dataSet->GetCellData()->AddArray(values);
}

void addGlobalIds(vtkPointSet* dataSet)
{
  dataSet->GetPointData()->SetGlobalIds(scatteredIds("PointIds", dataSet->GetNumberOfPoints()));
  dataSet->GetCellData()->SetGlobalIds(scatteredIds("CellIds", dataSet->GetNumberOfCells()));
}

vtkSmartPointer<vtkPointSet> taggedBall()
{
  Mesh mesh = ballMesh(2, 0.03);
  mesh.triangles = sphereMesh(2, 0.03).triangles;
  mesh.segments = { { mesh.triangles[0][0], mesh.triangles[0][1] } };
  mesh.vertices = { { 3 }, { 7 } };
  return toGrid(mesh);
}

} // namespace cadtest
