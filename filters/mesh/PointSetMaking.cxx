#include "mesh/PointSetConversion.h"

#include <cadrefine/base/Error.h>
#include <cadrefine/base/LargeMemory.h>
#include <cadrefine/mesh/EdgeTable.h>

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
#include <iterator>
#include <numeric>
#include <utility>

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

/// Makes a data set's cells of lists of cells, one after the other, on threads.
class CellWriter
{
public:
  explicit CellWriter(ParallelFor parallelFor) : parallelFor_(std::move(parallelFor)) {}

  template<std::size_t... Corners>
  vtkSmartPointer<vtkCellArray> write(const Cells<Corners>&... cells)
  {
    vtkNew<vtkTypeInt64Array> offsets;
    vtkNew<vtkTypeInt64Array> connectivity;
    setLength(offsets.Get(), (cells.size() + ... + 1));
    setLength(connectivity.Get(), ((Corners * cells.size()) + ...));
    nextOffset_ = offsets->GetPointer(0);
    nextCorner_ = connectivity->GetPointer(0);
    *nextOffset_++ = 0;
    (append(cells), ...);
    auto result = vtkSmartPointer<vtkCellArray>::New();
    result->SetData(offsets, connectivity);
    return result;
  }

private:
  template<std::size_t Corners>
  void append(const Cells<Corners>& cells)
  {
    const vtkTypeInt64 first = nextOffset_[-1];
    const auto writeCell = [&](std::size_t c)
    {
      std::copy(cells[c].begin(), cells[c].end(), nextCorner_ + Corners * c);
      nextOffset_[c] = first + static_cast<vtkTypeInt64>(Corners * (c + 1));
    };
    forEachIndex(parallelFor_, cells.size(), fineGrain, writeCell);
    nextOffset_ += cells.size();
    nextCorner_ += Corners * cells.size();
  }

  ParallelFor parallelFor_;
  vtkTypeInt64* nextOffset_ = nullptr; ///< Where the end of the next cell is to be written.
  vtkTypeInt64* nextCorner_ = nullptr;
};

vtkSmartPointer<vtkPointSet> makePolyData(const Mesh& mesh, const ParallelFor& parallelFor)
{
  auto output = vtkSmartPointer<vtkPolyData>::New();
  CellWriter writer(parallelFor);
  output->SetVerts(writer.write(mesh.vertices));
  output->SetLines(writer.write(mesh.segments));
  output->SetPolys(writer.write(mesh.triangles, mesh.quadrilaterals));
  return output;
}

/// The edges of a shape in the order in which VTK has their mid nodes.
template<class Shape>
std::vector<int> orderOfNodes(Shape, const Mesh&)
{
  std::vector<int> order(std::size(Shape::edges));
  std::iota(order.begin(), order.end(), 0);
  return order;
}

std::vector<int> orderOfNodes(shapes::Tetrahedron, const Mesh&)
{
  return { 0, 3, 1, 2, 4, 5 };
}

std::vector<int> orderOfNodes(shapes::Wedge, const Mesh& mesh)
{
  return mesh.wedgesAsDocumented
           ? std::vector<int>(std::begin(edgesOfTurned), std::end(edgesOfTurned))
           : std::vector<int>{ 0, 1, 2, 3, 4, 5, 6, 7, 8 };
}

/// The cells of a shape, with their corners as data sets have them.
template<class Shape>
const auto& asWritten(Shape, const Mesh& mesh)
{
  return mesh.*Shape::cells;
}

Cells<6> asWritten(shapes::Wedge, const Mesh& mesh)
{
  Cells<6> wedges = mesh.wedges;
  if (mesh.wedgesAsDocumented)
  {
    std::transform(wedges.begin(), wedges.end(), wedges.begin(), turned);
  }
  return wedges;
}

/// The cells of a shape, each with the points of its mid nodes after its corners.
template<class Shape>
auto withNodes(Shape shape, const Mesh& mesh, const EdgeTable& table)
{
  const auto firstNode = static_cast<Index>(mesh.points.size());
  const auto& cells = asWritten(shape, mesh);
  const auto& edgesOf = table.*edgesOfCells(shape);
  const std::vector<int> order = orderOfNodes(shape, mesh);
  Cells<Shape::corners + std::size(Shape::edges)> result(cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    const auto node = std::copy(cells[c].begin(), cells[c].end(), result[c].begin());
    std::transform(
      order.begin(), order.end(), node, [&](int edge) { return firstNode + edgesOf[c][edge]; });
  }
  return result;
}

vtkSmartPointer<vtkCellArray> makeCells(
  const Mesh& mesh, const MidNodes& midNodes, const ParallelFor& parallelFor)
{
  const auto quadratic = [&](auto shape) { return withNodes(shape, mesh, midNodes.table); };
  return CellWriter(parallelFor)
    .write(mesh.vertices, quadratic(shapes::Segment{}), quadratic(shapes::Triangle{}),
      quadratic(shapes::Quadrilateral{}), quadratic(shapes::Tetrahedron{}),
      quadratic(shapes::Pyramid{}), quadratic(shapes::Wedge{}), quadratic(shapes::Hexahedron{}));
}

vtkSmartPointer<vtkCellArray> makeCells(const Mesh& mesh, const ParallelFor& parallelFor)
{
  return CellWriter(parallelFor)
    .write(mesh.vertices, mesh.segments, mesh.triangles, mesh.quadrilaterals, mesh.tetrahedra,
      mesh.pyramids, asWritten(shapes::Wedge{}, mesh), mesh.hexahedra);
}

/// VTK's types of the shapes, in the order in which visitShapes visits them.
constexpr unsigned char firstOrder[] = { VTK_VERTEX, VTK_LINE, VTK_TRIANGLE, VTK_QUAD, VTK_TETRA,
  VTK_PYRAMID, VTK_WEDGE, VTK_HEXAHEDRON };
constexpr unsigned char secondOrder[] = { VTK_VERTEX, VTK_QUADRATIC_EDGE, VTK_QUADRATIC_TRIANGLE,
  VTK_QUADRATIC_QUAD, VTK_QUADRATIC_TETRA, VTK_QUADRATIC_PYRAMID, VTK_QUADRATIC_WEDGE,
  VTK_QUADRATIC_HEXAHEDRON };

vtkSmartPointer<vtkPointSet> makeUnstructuredGrid(
  const Mesh& mesh, const std::optional<MidNodes>& midNodes, const ParallelFor& parallelFor)
{
  vtkNew<vtkUnsignedCharArray> types;
  setLength(types.Get(), mesh.cellCount());
  unsigned char* next = types->GetPointer(0);
  const unsigned char* type = midNodes ? secondOrder : firstOrder;
  visitShapes(
    mesh, [&](auto, const auto& cells) { next = std::fill_n(next, cells.size(), *type++); });
  auto output = vtkSmartPointer<vtkUnstructuredGrid>::New();
  output->SetCells(
    types, midNodes ? makeCells(mesh, *midNodes, parallelFor) : makeCells(mesh, parallelFor));
  return output;
}

} // namespace

vtkIdType firstCellOfDimension(const Mesh& mesh, int dimension)
{
  vtkIdType first = 0;
  for (int d = 0; d < dimension; ++d)
  {
    first += static_cast<vtkIdType>(mesh.cellCount(d));
  }
  return first;
}

vtkSmartPointer<vtkPointSet> makePointSet(vtkPointSet* input, const Mesh& mesh,
  const std::optional<MidNodes>& midNodes, const ParallelFor& parallelFor)
{
  const bool isPolyData = vtkPolyData::SafeDownCast(input) != nullptr;
  if (isPolyData && midNodes)
  {
    throw Error("poly data cannot hold quadratic cells; convert the mesh to an unstructured grid "
                "first (filter Append Datasets)");
  }
  auto output = isPolyData ? makePolyData(mesh, parallelFor)
                           : makeUnstructuredGrid(mesh, midNodes, parallelFor);
  const std::size_t nodeCount = midNodes ? midNodes->points.size() : 0;
  vtkNew<vtkDoubleArray> coordinates;
  coordinates->SetNumberOfComponents(3);
  setLength(coordinates.Get(), 3 * (mesh.points.size() + nodeCount));
  double* next = coordinates->GetPointer(0);
  if (!mesh.points.empty())
  {
    next = std::copy_n(mesh.points.front().data(), 3 * mesh.points.size(), next);
  }
  if (nodeCount > 0)
  {
    std::copy_n(midNodes->points.front().data(), 3 * nodeCount, next);
  }
  vtkNew<vtkPoints> points;
  points->SetData(coordinates);
  output->SetPoints(points);
  return output;
}

} // namespace cadrefine
