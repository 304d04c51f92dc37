#include "Partition.h"

#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <random>
#include <set>
#include <stdexcept>

namespace cadtest
{
namespace
{

template<class T>
void append(std::string& bytes, const T& value)
{
  const std::size_t size = bytes.size();
  bytes.resize(size + sizeof(T));
  std::memcpy(&bytes[size], &value, sizeof(T));
}

/// Name, type and values of the arrays at one point or cell, in the order of the names.
void appendArrays(std::string& bytes, vtkDataSetAttributes* attributes, vtkIdType index)
{
  std::map<std::string, vtkDataArray*> byName;
  for (int a = 0; a < attributes->GetNumberOfArrays(); ++a)
  {
    vtkDataArray* array = attributes->GetArray(a);
    if (array && array != attributes->GetGlobalIds())
    {
      byName[array->GetName()] = array;
    }
  }
  for (const auto& [name, array] : byName)
  {
    bytes += name;
    append(bytes, array->GetDataType());
    for (int k = 0; k < array->GetNumberOfComponents(); ++k)
    {
      const double value = array->GetComponent(index, k);
      append(bytes, std::isnan(value) ? std::numeric_limits<double>::quiet_NaN() : value);
    }
  }
}

std::int64_t globalId(vtkDataSetAttributes* attributes, vtkIdType index)
{
  vtkDataArray* ids = attributes->GetGlobalIds();
  if (!ids)
  {
    throw std::runtime_error("there are no global ids");
  }
  return static_cast<std::int64_t>(ids->GetTuple1(index));
}

/// Bytes of a point or cell under its global id, as they travel to rank 0.
void appendRecord(std::vector<char>& message, char kind, std::int64_t id, const std::string& bytes)
{
  std::string header(1, kind);
  append(header, id);
  append(header, static_cast<std::int64_t>(bytes.size()));
  message.insert(message.end(), header.begin(), header.end());
  message.insert(message.end(), bytes.begin(), bytes.end());
}

std::string pointBytes(vtkPointSet* piece, vtkIdType point)
{
  std::string bytes;
  for (int k = 0; k < 3; ++k)
  {
    append(bytes, piece->GetPoint(point)[k]);
  }
  appendArrays(bytes, piece->GetPointData(), point);
  return bytes;
}

std::string cellBytes(vtkPointSet* piece, vtkIdType cell)
{
  vtkNew<vtkIdList> points;
  piece->GetCellPoints(cell, points);
  std::string bytes;
  append(bytes, static_cast<std::int64_t>(piece->GetCellType(cell)));
  append(bytes, static_cast<std::int64_t>(points->GetNumberOfIds()));
  for (const vtkIdType point : *points)
  {
    append(bytes, globalId(piece->GetPointData(), point));
  }
  appendArrays(bytes, piece->GetCellData(), cell);
  return bytes;
}

std::vector<char> packed(vtkPointSet* piece)
{
  std::vector<char> message;
  for (vtkIdType p = 0; p < piece->GetNumberOfPoints(); ++p)
  {
    appendRecord(message, 'p', globalId(piece->GetPointData(), p), pointBytes(piece, p));
  }
  for (vtkIdType c = 0; c < piece->GetNumberOfCells(); ++c)
  {
    appendRecord(message, 'c', globalId(piece->GetCellData(), c), cellBytes(piece, c));
  }
  return message;
}

void unpack(const std::vector<char>& message, CanonicalMesh& mesh)
{
  for (std::size_t at = 0; at < message.size();)
  {
    std::int64_t header[2];
    std::memcpy(header, &message[at + 1], sizeof(header));
    const char kind = message[at];
    at += 1 + sizeof(header);
    const std::string bytes(message.data() + at, static_cast<std::size_t>(header[1]));
    at += bytes.size();
    auto& entries = kind == 'p' ? mesh.points : mesh.cells;
    const auto [entry, isNew] = entries.emplace(header[0], bytes);
    mesh.contradictions += !isNew && (kind == 'c' || entry->second != bytes);
  }
}

/// Which cells a piece takes, and which of them are ghosts.
std::vector<unsigned char> ghostLevels(
  vtkPointSet* whole, const std::vector<int>& rankOfCell, int rank, bool ghosts)
{
  constexpr unsigned char absent = 255;
  std::set<vtkIdType> ownPoints;
  vtkNew<vtkIdList> points;
  std::vector<unsigned char> levels(rankOfCell.size(), absent);
  for (std::size_t c = 0; c < levels.size(); ++c)
  {
    if (rankOfCell[c] == rank)
    {
      levels[c] = 0;
      whole->GetCellPoints(static_cast<vtkIdType>(c), points);
      ownPoints.insert(points->begin(), points->end());
    }
  }
  for (std::size_t c = 0; ghosts && c < levels.size(); ++c)
  {
    whole->GetCellPoints(static_cast<vtkIdType>(c), points);
    const bool touches = std::any_of(
      points->begin(), points->end(), [&](vtkIdType p) { return ownPoints.count(p) > 0; });
    levels[c] = levels[c] == absent && touches ? 1 : levels[c];
  }
  return levels;
}

/// Copies points and cells of a data set, with their arrays, as they are asked for.
class PieceMaker
{
public:
  explicit PieceMaker(vtkPointSet* whole)
    : whole_(whole), piece_(vtkSmartPointer<vtkPointSet>::Take(whole->NewInstance()))
  {
    points_->SetDataTypeToDouble();
    piece_->GetPointData()->CopyAllOn();
    piece_->GetCellData()->CopyAllOn();
    piece_->GetPointData()->CopyAllocate(whole->GetPointData());
    piece_->GetCellData()->CopyAllocate(whole->GetCellData());
    ghosts_->SetName(vtkDataSetAttributes::GhostArrayName());
    if (auto* grid = vtkUnstructuredGrid::SafeDownCast(piece_))
    {
      grid->Allocate(1);
    }
    else
    {
      vtkPolyData::SafeDownCast(piece_)->AllocateEstimate(1, 3);
    }
  }

  void addCell(vtkIdType cell, unsigned char ghostLevel)
  {
    vtkNew<vtkIdList> points;
    whole_->GetCellPoints(cell, points);
    for (vtkIdType k = 0; k < points->GetNumberOfIds(); ++k)
    {
      points->SetId(k, point(points->GetId(k)));
    }
    const int type = whole_->GetCellType(cell);
    auto* grid = vtkUnstructuredGrid::SafeDownCast(piece_);
    const vtkIdType added = grid ? grid->InsertNextCell(type, points)
                                 : vtkPolyData::SafeDownCast(piece_)->InsertNextCell(type, points);
    piece_->GetCellData()->CopyData(whole_->GetCellData(), cell, added);
    ghosts_->InsertNextValue(ghostLevel > 0 ? vtkDataSetAttributes::DUPLICATECELL : 0);
  }

  vtkSmartPointer<vtkPointSet> finish(bool withGhosts)
  {
    piece_->SetPoints(points_);
    if (withGhosts)
    {
      piece_->GetCellData()->AddArray(ghosts_);
    }
    return piece_;
  }

private:
  vtkIdType point(vtkIdType ofWhole)
  {
    const auto [entry, isNew] = pointOf_.emplace(ofWhole, points_->GetNumberOfPoints());
    if (isNew)
    {
      points_->InsertNextPoint(whole_->GetPoint(ofWhole));
      piece_->GetPointData()->CopyData(whole_->GetPointData(), ofWhole, entry->second);
    }
    return entry->second;
  }

  vtkPointSet* whole_;
  vtkSmartPointer<vtkPointSet> piece_;
  vtkNew<vtkPoints> points_;
  vtkNew<vtkUnsignedCharArray> ghosts_;
  std::map<vtkIdType, vtkIdType> pointOf_;
};

std::vector<vtkIdType> allCells(vtkPointSet* whole)
{
  std::vector<vtkIdType> cells(static_cast<std::size_t>(whole->GetNumberOfCells()));
  std::iota(cells.begin(), cells.end(), 0);
  return cells;
}

/// Twice the middle of a cell's box along an axis.
double middle(vtkPointSet* whole, vtkIdType cell, int axis)
{
  const double* bounds = whole->GetCell(cell)->GetBounds();
  return bounds[2 * axis] + bounds[2 * axis + 1];
}

/// Deals cells out to `ranks` ranks from `first` on.
void halve(vtkPointSet* whole, std::vector<vtkIdType> cells, int first, int ranks,
  std::vector<int>& rankOfCell)
{
  if (ranks == 1)
  {
    for (const vtkIdType cell : cells)
    {
      rankOfCell[cell] = first;
    }
    return;
  }
  std::array<double, 3> extents{};
  for (int axis = 0; axis < 3; ++axis)
  {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const vtkIdType cell : cells)
    {
      low = std::min(low, middle(whole, cell, axis));
      high = std::max(high, middle(whole, cell, axis));
    }
    extents[axis] = high - low;
  }
  const auto axis =
    static_cast<int>(std::max_element(extents.begin(), extents.end()) - extents.begin());
  std::sort(cells.begin(), cells.end(),
    [&](vtkIdType a, vtkIdType b)
    { return std::pair(middle(whole, a, axis), a) < std::pair(middle(whole, b, axis), b); });
  const auto half = cells.begin() + static_cast<std::ptrdiff_t>(cells.size()) * (ranks / 2) / ranks;
  halve(whole, { cells.begin(), half }, first, ranks / 2, rankOfCell);
  halve(whole, { half, cells.end() }, first + ranks / 2, ranks - ranks / 2, rankOfCell);
}

} // namespace

std::vector<int> deal(Dealing dealing, vtkPointSet* whole, int ranks)
{
  std::vector<int> rankOfCell(static_cast<std::size_t>(whole->GetNumberOfCells()));
  if (dealing == Dealing::KdTree)
  {
    halve(whole, allCells(whole), 0, ranks, rankOfCell);
    return rankOfCell;
  }
  std::mt19937_64 random(99);
  const int first = dealing == Dealing::EmptyRank && ranks > 1 ? 1 : 0;
  std::uniform_int_distribution<int> anyRank(first, ranks - 1);
  for (std::size_t c = 0; c < rankOfCell.size(); ++c)
  {
    rankOfCell[c] = dealing == Dealing::Blocks
                      ? static_cast<int>(c * static_cast<std::size_t>(ranks) / rankOfCell.size())
                      : anyRank(random);
  }
  return rankOfCell;
}

vtkSmartPointer<vtkPointSet> pieceOf(
  vtkPointSet* whole, const std::vector<int>& rankOfCell, int rank, bool ghosts)
{
  const auto levels = ghostLevels(whole, rankOfCell, rank, ghosts);
  std::vector<vtkIdType> cells = allCells(whole);
  std::shuffle(cells.begin(), cells.end(), std::mt19937_64(rank));
  PieceMaker maker(whole);
  for (const vtkIdType c : cells)
  {
    if (levels[c] <= 1)
    {
      maker.addCell(c, levels[c]);
    }
  }
  return maker.finish(ghosts);
}

CanonicalMesh gather(cadrefine::RankExchange& exchange, vtkPointSet* piece)
{
  std::vector<std::vector<char>> toRank(static_cast<std::size_t>(exchange.size()));
  toRank[0] = packed(piece);
  CanonicalMesh mesh;
  for (const std::vector<char>& message : exchange.allToAll(toRank))
  {
    unpack(message, mesh);
  }
  return mesh;
}

cadrefine::Mesh toMesh(const CanonicalMesh& canonical)
{
  cadrefine::Mesh mesh;
  std::map<std::int64_t, cadrefine::Index> vertexOf;
  for (const auto& [id, bytes] : canonical.points)
  {
    vertexOf.emplace(id, static_cast<cadrefine::Index>(mesh.points.size()));
    std::memcpy(mesh.points.emplace_back().data(), bytes.data(), 3 * sizeof(double));
    mesh.ids.push_back(id);
  }
  for (const auto& [id, bytes] : canonical.cells)
  {
    std::int64_t numbers[10];
    std::memcpy(numbers, bytes.data(), sizeof(std::int64_t) * 2);
    const auto count = std::min<std::int64_t>(numbers[1], 8);
    std::memcpy(numbers, bytes.data(), sizeof(std::int64_t) * (2 + count));
    const auto add = [&](auto& cells)
    {
      auto& cell = cells.emplace_back();
      for (std::size_t k = 0; k < cell.size(); ++k)
      {
        cell[k] = vertexOf.at(numbers[2 + k]);
      }
    };
    switch (numbers[0])
    {
      case VTK_HEXAHEDRON:
      case VTK_QUADRATIC_HEXAHEDRON:
        add(mesh.hexahedra);
        break;
      case VTK_WEDGE:
      case VTK_QUADRATIC_WEDGE:
        add(mesh.wedges);
        break;
      case VTK_PYRAMID:
      case VTK_QUADRATIC_PYRAMID:
        add(mesh.pyramids);
        break;
      case VTK_TETRA:
      case VTK_QUADRATIC_TETRA:
        add(mesh.tetrahedra);
        break;
      case VTK_QUAD:
      case VTK_QUADRATIC_QUAD:
        add(mesh.quadrilaterals);
        break;
      case VTK_TRIANGLE:
      case VTK_QUADRATIC_TRIANGLE:
        add(mesh.triangles);
        break;
      case VTK_LINE:
      case VTK_QUADRATIC_EDGE:
        add(mesh.segments);
        break;
      default: // vertices
        break;
    }
  }
  mesh.dimension = mesh.cellCount(3) == 0 ? 2 : 3;
  return mesh;
}

} // namespace cadtest
