#include "mesh/PointSetConversion.h"

#include <cadrefine/base/Error.h>
#include <cadrefine/base/LargeMemory.h>

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

/// Makes a data set's cells of lists of simplices, one after the other, on threads.
class CellWriter
{
public:
  explicit CellWriter(ParallelFor parallelFor) : parallelFor_(std::move(parallelFor)) {}

  template<std::size_t... Corners>
  vtkSmartPointer<vtkCellArray> write(const Simplices<Corners>&... cells)
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
  void append(const Simplices<Corners>& cells)
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
  vtkTypeInt64* nextOffset_ = nullptr; ///< The end of a cell, each.
  vtkTypeInt64* nextCorner_ = nullptr;
};

vtkSmartPointer<vtkPointSet> makePolyData(const SimplexMesh& mesh, const ParallelFor& parallelFor)
{
  auto output = vtkSmartPointer<vtkPolyData>::New();
  CellWriter writer(parallelFor);
  output->SetVerts(writer.write(mesh.vertices));
  output->SetLines(writer.write(mesh.segments));
  output->SetPolys(writer.write(mesh.triangles));
  return output;
}

/// Each cell with the points of its mid nodes after its corners, in VTK's order: `order` gives the
/// edge of each.
template<std::size_t Corners, std::size_t Edges>
Simplices<Corners + Edges> withNodes(const Simplices<Corners>& cells,
  const std::vector<std::array<Index, Edges>>& edgesOf, const int (&order)[Edges], Index firstNode)
{
  Simplices<Corners + Edges> result(cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    const auto node = std::copy(cells[c].begin(), cells[c].end(), result[c].begin());
    std::transform(std::begin(order), std::end(order), node,
      [&](int edge) { return firstNode + edgesOf[c][edge]; });
  }
  return result;
}

vtkSmartPointer<vtkCellArray> makeCells(
  const SimplexMesh& mesh, const MidNodes& midNodes, const ParallelFor& parallelFor)
{
  const auto firstNode = static_cast<Index>(mesh.points.size());
  Simplices<3> segments(mesh.segments.size());
  std::transform(mesh.segments.begin(), mesh.segments.end(), midNodes.table.ofSegments.begin(),
    segments.begin(),
    [&](const std::array<Index, 2>& ends, Index edge) {
      return std::array<Index, 3>{ ends[0], ends[1], firstNode + edge };
    });
  return CellWriter(parallelFor)
    .write(mesh.vertices, segments,
      withNodes(mesh.triangles, midNodes.table.ofTriangles, { 0, 1, 2 }, firstNode),
      withNodes(mesh.tetrahedra, midNodes.table.ofTetrahedra, { 0, 3, 1, 2, 4, 5 }, firstNode));
}

vtkSmartPointer<vtkPointSet> makeUnstructuredGrid(
  const SimplexMesh& mesh, const std::optional<MidNodes>& midNodes, const ParallelFor& parallelFor)
{
  vtkNew<vtkUnsignedCharArray> types;
  const auto count = static_cast<vtkIdType>(mesh.cellCount());
  setLength(types.Get(), mesh.cellCount());
  constexpr unsigned char firstOrder[4] = { VTK_VERTEX, VTK_LINE, VTK_TRIANGLE, VTK_TETRA };
  constexpr unsigned char secondOrder[4] = { VTK_VERTEX, VTK_QUADRATIC_EDGE, VTK_QUADRATIC_TRIANGLE,
    VTK_QUADRATIC_TETRA };
  for (int d = 0; d < 4; ++d)
  {
    const vtkIdType end = d < 3 ? firstCellOfDimension(mesh, d + 1) : count;
    std::fill(types->GetPointer(firstCellOfDimension(mesh, d)), types->GetPointer(end),
      midNodes ? secondOrder[d] : firstOrder[d]);
  }
  auto output = vtkSmartPointer<vtkUnstructuredGrid>::New();
  output->SetCells(
    types, midNodes ? makeCells(mesh, *midNodes, parallelFor)
                    : CellWriter(parallelFor)
                        .write(mesh.vertices, mesh.segments, mesh.triangles, mesh.tetrahedra));
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

vtkSmartPointer<vtkPointSet> makePointSet(vtkPointSet* input, const SimplexMesh& mesh,
  const std::optional<MidNodes>& midNodes, const ParallelFor& parallelFor)
{
  const bool isPolyData = vtkPolyData::SafeDownCast(input) != nullptr;
  if (isPolyData && midNodes)
  {
    throw Error("poly data cannot hold quadratic cells; make the mesh an unstructured grid first "
                "(the filter Append Datasets does)");
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
