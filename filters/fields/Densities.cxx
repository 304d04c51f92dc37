#include "fields/Densities.h"

#include "mesh/PointSetConversion.h"

#include <cadrefine/mesh/CellJacobian.h>
#include <cadrefine/mesh/CellState.h>
#include <cadrefine/mesh/Overlap.h>

#include <cmath>
#include <numeric>

namespace cadrefine
{
namespace
{

template<class Shape>
double sizeOf(Shape, const std::array<Point3, Shape::corners>& corners)
{
  if constexpr (isSimplex(Shape{}))
  {
    return measure(corners);
  }
  else if constexpr (Shape::dimension == 2)
  {
    return area(corners);
  }
  else
  {
    return std::abs(volume(corners));
  }
}

/// Volumes that differ by less than this part of them are the same.
constexpr double rounding = 1e-13;

/// Rows for cells of the mesh's own dimension, each of which comes from one cell (`sources`,
/// numbered without those of lower dimension) and had the size in `before`.
WeightedRows rowsOf(const Mesh& mesh, const std::vector<double>& before,
  const std::vector<Index>& sources, Index firstSource)
{
  WeightedRows rows;
  const auto first = static_cast<Index>(firstCellOfDimension(mesh, mesh.dimension));
  const std::vector<double> now = sizesOfCells(mesh, mesh.points);
  for (std::size_t c = 0; c < now.size(); ++c)
  {
    if (before[c] != now[c] && now[c] > 0)
    {
      rows.add(firstSource + sources[c], before[c] / now[c]);
      rows.endRow(first + static_cast<Index>(c));
    }
  }
  return rows;
}

template<std::size_t Count>
double meanOf(const BezierForm<Count>& form)
{
  const auto& coefficients = form.coefficients;
  return std::accumulate(coefficients.begin(), coefficients.end(), 0.0) / Count;
}

/// The volume, or area, of a cell with mid nodes off the middle; 0 for pyramids, which have none.
template<class Shape>
double sizeOfCurved(Shape, const CurvedCell<Shape>& nodes, const Vector3& plane)
{
  if constexpr (Shape::dimension == 2)
  {
    return std::abs(meanOf(jacobianOf(nodes, plane))) / (isSimplex(Shape{}) ? 2 : 1);
  }
  else if constexpr (Shape::corners == 5)
  {
    return 0;
  }
  else
  {
    constexpr int parts = Shape::corners == 4 ? 6 : Shape::corners == 6 ? 2 : 1;
    return std::abs(meanOf(jacobianOf(nodes))) / parts;
  }
}

/// Places the new vertices that are elsewhere than halfway between two others.
void placeByRows(const WeightedRows& rows, std::size_t oldCount, std::vector<Point3>& points)
{
  for (std::size_t r = 0; r < rows.size(); ++r)
  {
    const Index target = rows.targets[r];
    Point3 sum{};
    for (Index k = rows.firsts[r]; k < rows.firsts[r + 1]; ++k)
    {
      sum = sum + rows.weights[k] * points[rows.sources[k]];
    }
    if (target >= static_cast<Index>(oldCount))
    {
      points[target] = sum;
    }
  }
}

} // namespace

std::vector<double> sizesOfCells(const Mesh& mesh, const std::vector<Point3>& points)
{
  std::vector<double> sizes;
  if (mesh.dimension >= 2)
  {
    sizes.reserve(mesh.cellCount(mesh.dimension));
    visitOwnShapes(mesh,
      [&](auto shape, const auto& cells)
      {
        for (const auto& cell : cells)
        {
          sizes.push_back(sizeOf(shape, cornersOf(cell, points)));
        }
      });
  }
  return sizes;
}

WeightedRows densitiesOfCurved(const Mesh& mesh, const MidNodes& nodes, const Vector3& plane)
{
  WeightedRows rows;
  if (isSurface(mesh, plane))
  {
    return rows;
  }
  auto place = static_cast<Index>(firstCellOfDimension(mesh, mesh.dimension));
  visitOwnShapes(mesh,
    [&](auto shape, const auto& cells)
    {
      const auto& edgesOf = nodes.table.*edgesOfCells(shape);
      for (std::size_t c = 0; c < cells.size(); ++c, ++place)
      {
        const auto points =
          gatherNodes(mesh, cells[c], edgesOf[c], [&](Index edge) { return nodes.points[edge]; });
        const auto corners = cornersOf(cells[c], mesh.points);
        const double curved =
          points == straightCell(shape, corners) ? 0 : sizeOfCurved(shape, points, plane);
        if (curved > 0)
        {
          rows.add(place, sizeOf(shape, corners) / curved);
          rows.endRow(place);
        }
      }
    });
  return rows;
}

WeightedRows densitiesOfMoved(const Mesh& mesh, const std::vector<Point3>& before)
{
  std::vector<Index> sources(mesh.cellCount());
  std::iota(sources.begin(), sources.end(), 0);
  const auto first = static_cast<Index>(firstCellOfDimension(mesh, mesh.dimension));
  return rowsOf(mesh, sizesOfCells(mesh, before), sources, first);
}

WeightedRows densitiesOfRefined(const Mesh& mesh, const RefinementTrace& trace,
  std::vector<Point3> before, const std::vector<double>& parentSizes)
{
  const std::size_t oldCount = before.size();
  for (const auto& [a, b] : trace.parentEdges)
  {
    before.push_back(0.5 * (before[a] + before[b]));
  }
  placeByRows(trace.ofVertices, oldCount, before);
  std::vector<Index> parents(trace.firstChildren[mesh.dimension].back());
  trace.visitChildren(mesh.dimension, [&](Index cell, Index child) { parents[child] = cell; });
  Index firstParent = 0;
  for (int d = 0; d < mesh.dimension; ++d)
  {
    firstParent += static_cast<Index>(trace.firstChildren[d].size()) - 1;
  }
  std::vector<double> sizes = sizesOfCells(mesh, before);
  std::vector<double> ofChildren(parentSizes.size(), 0); // together
  if (!parentSizes.empty())
  {
    for (std::size_t c = 0; c < sizes.size(); ++c)
    {
      ofChildren[parents[c]] += sizes[c];
    }
    for (std::size_t c = 0; c < sizes.size(); ++c)
    {
      const double sum = ofChildren[parents[c]];
      const double size = parentSizes[parents[c]];
      const bool isSame = sum <= 0 || std::abs(sum - size) <= rounding * size;
      sizes[c] *= isSame ? 1 : size / sum;
    }
  }
  return rowsOf(mesh, sizes, parents, firstParent);
}

} // namespace cadrefine
