#include "mesh/CellReading.h"

#include <cadrefine/base/Error.h>
#include <cadrefine/base/LargeMemory.h>

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
#include <utility>

namespace cadrefine
{
namespace
{

/// A cell type that CADRefine takes, or with a shape of -1 one that it does not.
struct CellKind
{
  int shape = -1; ///< Place in the order in which visitShapes visits them.
  int dimension = -1;
  vtkIdType corners = 0;
  vtkIdType nodes = 0; ///< Number of mid nodes; 0 for cells of first order.
  bool inRows = false; ///< The last two of each four corners are the other way round.
};

template<class Shape>
constexpr CellKind kind(int shape, bool secondOrder = false)
{
  return { shape, Shape::dimension, static_cast<vtkIdType>(Shape::corners),
    secondOrder ? static_cast<vtkIdType>(nodesOf(Shape{})) : 0 };
}

CellKind kindOf(int cellType)
{
  switch (cellType)
  {
    case VTK_VERTEX:
      return kind<shapes::Vertex>(0);
    case VTK_LINE:
      return kind<shapes::Segment>(1);
    case VTK_TRIANGLE:
      return kind<shapes::Triangle>(2);
    case VTK_QUAD:
      return kind<shapes::Quadrilateral>(3);
    case VTK_TETRA:
      return kind<shapes::Tetrahedron>(4);
    case VTK_PYRAMID:
      return kind<shapes::Pyramid>(5);
    case VTK_WEDGE:
      return kind<shapes::Wedge>(6);
    case VTK_HEXAHEDRON:
      return kind<shapes::Hexahedron>(7);
    case VTK_PIXEL:
      return { 3, 2, 4, 0, true };
    case VTK_VOXEL:
      return { 7, 3, 8, 0, true };
    case VTK_QUADRATIC_EDGE:
      return kind<shapes::Segment>(1, true);
    case VTK_QUADRATIC_TRIANGLE:
      return kind<shapes::Triangle>(2, true);
    case VTK_QUADRATIC_QUAD:
      return kind<shapes::Quadrilateral>(3, true);
    case VTK_QUADRATIC_TETRA:
      return kind<shapes::Tetrahedron>(4, true);
    case VTK_QUADRATIC_PYRAMID:
      return kind<shapes::Pyramid>(5, true);
    case VTK_QUADRATIC_WEDGE:
      return kind<shapes::Wedge>(6, true);
    case VTK_QUADRATIC_HEXAHEDRON:
      return kind<shapes::Hexahedron>(7, true);
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

/// Throws Error unless a cell names as many points as it must, and only such as there are.
template<class Point>
void checkPoints(
  const Point* points, vtkIdType count, vtkIdType expected, vtkIdType cell, vtkIdType pointCount)
{
  if (count != expected)
  {
    throw Error("cell " + std::to_string(cell) + " of the mesh has " + std::to_string(count) +
                " points instead of " + std::to_string(expected));
  }
  for (vtkIdType k = 0; k < count; ++k)
  {
    if (points[k] < 0 || points[k] >= pointCount)
    {
      throw Error("cell " + std::to_string(cell) + " of the mesh refers to point " +
                  std::to_string(points[k]) + ", but there are " + std::to_string(pointCount) +
                  " points");
    }
  }
}

void checkCell(int type, const CellKind& kind, CellOrder order, vtkIdType cell)
{
  const auto holds = [&]
  { return "the mesh holds a " + nameOf(type) + " (cell " + std::to_string(cell) + "); "; };
  if (kind.shape < 0)
  {
    throw Error(holds() +
                "CADRefine takes linear tetrahedra, pyramids, wedges, hexahedra, triangles and "
                "quadrilaterals (the filters Tetrahedralize and Triangulate convert other cells "
                "to simplices)");
  }
  if (kind.nodes > 0 && order == CellOrder::First)
  {
    throw Error(holds() +
                "this filter takes linear cells: refine the linear mesh, and choose Quadratic "
                "Cells in the last step");
  }
}

/// The cells of a data set whose cells can be read without a copy, and on threads; else nullptr.
vtkCellArray* longCells(vtkPointSet* input)
{
  auto* grid = vtkUnstructuredGrid::SafeDownCast(input);
  const bool isLong = grid && grid->GetNumberOfCells() > 0 && grid->GetCells()->IsStorage64Bit();
  return isLong ? grid->GetCells() : nullptr;
}

/// Calls use(cell, type, points, count) for the cells in [begin, end), `points` being a pointer to
/// the cell's first point.
template<class Use>
void forEachCell(vtkPointSet* input, vtkIdType begin, vtkIdType end, const Use& use)
{
  if (vtkCellArray* cells = longCells(input))
  {
    const auto* offsets = cells->GetOffsetsArray64()->GetPointer(0);
    const auto* corners = cells->GetConnectivityArray64()->GetPointer(0);
    const unsigned char* types =
      vtkUnstructuredGrid::SafeDownCast(input)->GetCellTypesArray()->GetPointer(0);
    for (vtkIdType c = begin; c < end; ++c)
    {
      use(c, types[c], corners + offsets[c], offsets[c + 1] - offsets[c]);
    }
    return;
  }
  vtkNew<vtkIdList> buffer;
  const vtkIdType* points = nullptr;
  vtkIdType pointCount = 0;
  for (vtkIdType c = begin; c < end; ++c)
  {
    input->GetCellPoints(c, pointCount, points, buffer);
    use(c, input->GetCellType(c), points, pointCount);
  }
}

/// Numbers of cells by shape, and of those of second order among them.
struct CellCounts
{
  std::array<std::size_t, shapeCount> all{};
  std::array<std::size_t, shapeCount> secondOrder{};
};

/// Reads the cells in parts, twice: first counts what there is, then writes all of it to its place.
class CellReader
{
public:
  CellReader(vtkPointSet* input, CellOrder order, ConvertedMesh& result, const ParallelFor& threads)
    : input_(input), order_(order), mesh_(result.mesh), cellOf_(result.cellOf),
      parallelFor_(longCells(input) ? threads : serialFor)
  {
  }

  NodesOfCells read()
  {
    constexpr std::size_t mostParts = 16;
    const auto total = static_cast<std::size_t>(input_->GetNumberOfCells());
    const std::size_t parts = std::clamp(total / fineGrain, std::size_t{ 1 }, mostParts);
    std::array<CellCounts, mostParts> counts;
    const auto forPart = [&](std::size_t part, const auto& use)
    { forEachTaken(part * total / parts, (part + 1) * total / parts, use); };
    forEachIndex(parallelFor_, parts, 1,
      [&](std::size_t part)
      {
        CellCounts& mine = counts[part];
        forPart(part,
          [&](vtkIdType, const CellKind& kind, const auto*)
          {
            ++mine.all[kind.shape];
            mine.secondOrder[kind.shape] += kind.nodes > 0;
          });
      });
    makeRoom(startsOf(counts.begin(), counts.end()));
    forEachIndex(parallelFor_, parts, 1,
      [&](std::size_t part)
      {
        CellCounts& next = counts[part];
        forPart(part, [&](vtkIdType cell, const CellKind& kind, const auto* points)
          { write(cell, kind, points, next); });
      });
    return std::move(nodes_);
  }

private:
  /// Calls use(cell, kind, points) for the cells that are taken; for a poly vertex once for each
  /// point.
  template<class Use>
  void forEachTaken(std::size_t begin, std::size_t end, const Use& use) const
  {
    vtkUnsignedCharArray* ghosts = input_->GetCellGhostArray();
    const vtkIdType pointCount = input_->GetNumberOfPoints();
    forEachCell(input_, static_cast<vtkIdType>(begin), static_cast<vtkIdType>(end),
      [&](vtkIdType cell, int type, const auto* points, vtkIdType count)
      {
        if (isGhost(ghosts, cell) || type == VTK_EMPTY_CELL)
        {
          return;
        }
        const bool isPolyVertex = type == VTK_POLY_VERTEX;
        const bool isSegment = type == VTK_POLY_LINE && count == 2;
        const CellKind kind = kindOf(isPolyVertex ? VTK_VERTEX : isSegment ? VTK_LINE : type);
        checkCell(type, kind, order_, cell);
        checkPoints(
          points, count, isPolyVertex ? count : kind.corners + kind.nodes, cell, pointCount);
        for (vtkIdType part = 0; part < (isPolyVertex ? count : 1); ++part)
        {
          use(cell, kind, points + part);
        }
      });
  }

  /// Replaces the counts of each part by those of all parts before it. Returns those of all parts.
  template<class Iterator>
  static CellCounts startsOf(Iterator part, Iterator end)
  {
    CellCounts sum;
    for (; part != end; ++part)
    {
      for (int shape = 0; shape < shapeCount; ++shape)
      {
        sum.all[shape] += std::exchange(part->all[shape], sum.all[shape]);
        sum.secondOrder[shape] += std::exchange(part->secondOrder[shape], sum.secondOrder[shape]);
      }
    }
    return sum;
  }

  void makeRoom(const CellCounts& counts)
  {
    std::size_t shape = 0;
    for (int d = 0; d < 4; ++d)
    {
      std::size_t ofDimension = 0;
      visitShapes(mesh_, d,
        [&](auto ofCells, auto& cells)
        {
          resizeLong(cells, counts.all[shape], parallelFor_);
          resizeLong(nodes_[shape], nodesOf(ofCells) * counts.secondOrder[shape], parallelFor_);
          firstOfShape_[shape] = ofDimension;
          ofDimension += counts.all[shape++];
        });
      resizeLong(cellOf_[d], ofDimension, parallelFor_);
    }
  }

  template<class Point, std::size_t Corners>
  static void writeCorners(const Point* points, std::array<Index, Corners>& cell)
  {
    std::transform(points, points + Corners, cell.begin(),
      [](Point point) { return static_cast<Index>(point); });
  }

  template<class Point>
  void write(vtkIdType number, const CellKind& kind, const Point* points, CellCounts& next)
  {
    const int d = kind.dimension;
    const std::size_t place = next.all[kind.shape]++;
    cellOf_[d][firstOfShape_[kind.shape] + place] = number;
    int shape = 0;
    visitShapes(mesh_,
      [&](auto ofCell, auto& cells)
      {
        if (shape++ == kind.shape)
        {
          if (kind.nodes > 0)
          {
            const std::size_t first = nodesOf(ofCell) * next.secondOrder[kind.shape]++;
            writeNodes(ofCell, points, nodes_[kind.shape].data() + first);
          }
          auto& cell = cells[place];
          writeCorners(points, cell);
          for (std::size_t k = 2; kind.inRows && k < cell.size(); k += 4)
          {
            std::swap(cell[k], cell[k + 1]);
          }
        }
      });
  }

  vtkPointSet* input_;
  CellOrder order_;
  Mesh& mesh_;
  std::array<std::vector<vtkIdType>, 4>& cellOf_;
  NodesOfCells nodes_;
  /// Place of the first cell of each shape in cellOf_.
  std::array<std::size_t, shapeCount> firstOfShape_{};
  ParallelFor parallelFor_;
};

} // namespace

NodesOfCells readCells(
  vtkPointSet* input, CellOrder order, ConvertedMesh& result, const ParallelFor& parallelFor)
{
  return CellReader(input, order, result, parallelFor).read();
}

} // namespace cadrefine
