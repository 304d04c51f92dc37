#include "PointSetConversion.h"

#include "LargeMemory.h"

#include <vtkCellArray.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>

namespace cadrefine
{
namespace
{

template<class Array>
void setLength(Array* array, std::size_t values)
{
  array->SetNumberOfValues(static_cast<vtkIdType>(values));
  preferHugePages(array->GetVoidPointer(0), values * array->GetDataTypeSize());
}

/// Appends the cells at these places of an array's offsets and connectivity.
template<std::size_t Corners>
void writeCells(const Simplices<Corners>& cells, vtkTypeInt64*& offset, vtkTypeInt64*& connectivity)
{
  for (const auto& cell : cells)
  {
    connectivity = std::copy(cell.begin(), cell.end(), connectivity);
    offset[1] = offset[0] + static_cast<vtkTypeInt64>(Corners);
    ++offset;
  }
}

template<std::size_t... Corners>
vtkSmartPointer<vtkCellArray> makeCellArray(const Simplices<Corners>&... cells)
{
  vtkNew<vtkTypeInt64Array> offsets;
  vtkNew<vtkTypeInt64Array> connectivity;
  setLength(offsets.Get(), (cells.size() + ... + 1));
  setLength(connectivity.Get(), ((Corners * cells.size()) + ...));
  vtkTypeInt64* offset = offsets->GetPointer(0);
  vtkTypeInt64* corner = connectivity->GetPointer(0);
  *offset = 0;
  (writeCells(cells, offset, corner), ...);
  auto result = vtkSmartPointer<vtkCellArray>::New();
  result->SetData(offsets, connectivity);
  return result;
}

vtkSmartPointer<vtkPointSet> makePolyData(const SimplexMesh& mesh)
{
  auto output = vtkSmartPointer<vtkPolyData>::New();
  output->SetVerts(makeCellArray(mesh.vertices));
  output->SetLines(makeCellArray(mesh.segments));
  output->SetPolys(makeCellArray(mesh.triangles));
  return output;
}

vtkSmartPointer<vtkPointSet> makeUnstructuredGrid(const SimplexMesh& mesh)
{
  vtkNew<vtkUnsignedCharArray> types;
  const auto count = static_cast<vtkIdType>(mesh.cellCount());
  setLength(types.Get(), mesh.cellCount());
  constexpr unsigned char typeOf[4] = { VTK_VERTEX, VTK_LINE, VTK_TRIANGLE, VTK_TETRA };
  for (int d = 0; d < 4; ++d)
  {
    const vtkIdType end = d < 3 ? firstCellOfDimension(mesh, d + 1) : count;
    std::fill(types->GetPointer(firstCellOfDimension(mesh, d)), types->GetPointer(end), typeOf[d]);
  }
  auto output = vtkSmartPointer<vtkUnstructuredGrid>::New();
  output->SetCells(
    types, makeCellArray(mesh.vertices, mesh.segments, mesh.triangles, mesh.tetrahedra));
  return output;
}

} // namespace

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
  vtkNew<vtkDoubleArray> coordinates;
  coordinates->SetNumberOfComponents(3);
  setLength(coordinates.Get(), 3 * mesh.points.size());
  if (!mesh.points.empty())
  {
    std::copy_n(mesh.points.front().data(), 3 * mesh.points.size(), coordinates->GetPointer(0));
  }
  vtkNew<vtkPoints> points;
  points->SetData(coordinates);
  output->SetPoints(points);
  return output;
}

} // namespace cadrefine
