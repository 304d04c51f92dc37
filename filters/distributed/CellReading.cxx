#include "CellReading.h"

#include "Error.h"
#include "LargeMemory.h"

#include <vtkCellArray.h>
#include <vtkCellType.h>
#include <vtkDataSetAttributes.h>
#include <vtkGenericCell.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointSet.h>
#include <vtkSmartPointer.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <string>

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
  const auto cell = vtkSmartPointer<vtkCell>::Take(vtkGenericCell::InstantiateCell(cellType));
  if (!cell)
  {
    return "cell of type " + std::to_string(cellType);
  }
  std::string name = cell->GetClassName();
  name = name.rfind("vtk", 0) == 0 ? name.substr(3) : name;
  std::transform(name.begin(), name.end(), name.begin(), ::tolower);
  return name;
}

/// Whether a cell is marked to be left out: as another rank's, blanked, or replaced by finer ones.
bool isGhost(vtkUnsignedCharArray* ghosts, vtkIdType cell)
{
  constexpr unsigned char marks = vtkDataSetAttributes::DUPLICATECELL |
                                  vtkDataSetAttributes::HIDDENCELL |
                                  vtkDataSetAttributes::REFINEDCELL;
  return ghosts && (ghosts->GetValue(cell) & marks);
}

/// Corners and mid nodes.
vtkIdType pointsOf(const CellKind& kind)
{
  constexpr vtkIdType firstOrder[4] = { 1, 2, 3, 4 };
  constexpr vtkIdType secondOrder[4] = { 0, 3, 6, 10 };
  return kind.secondOrder ? secondOrder[kind.dimension] : firstOrder[kind.dimension];
}

/// Whether the cell names as many points as it must, and such as there are.
template<class Point>
void checkPoints(
  const Point* points, vtkIdType count, vtkIdType expected, vtkIdType cell, vtkIdType pointCount)
{
  if (count != expected)
  {
    throw Error("cell " + std::to_string(cell) + " of the mesh names " + std::to_string(count) +
                " points instead of " + std::to_string(expected));
  }
  for (vtkIdType k = 0; k < count; ++k)
  {
    if (points[k] < 0 || points[k] >= pointCount)
    {
      throw Error("cell " + std::to_string(cell) + " of the mesh names the point " +
                  std::to_string(points[k]) + ", but there are " + std::to_string(pointCount) +
                  " points");
    }
  }
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

} // namespace

NodesOfCells readCells(vtkPointSet* input, CellOrder order, ConvertedMesh& result)
{
  vtkUnsignedCharArray* ghosts = input->GetCellGhostArray();
  const vtkIdType total = input->GetNumberOfCells();
  const vtkIdType pointCount = input->GetNumberOfPoints();
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
      checkPoints(points, count, isPolyVertex ? count : pointsOf(kind), cell, pointCount);
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

} // namespace cadrefine
