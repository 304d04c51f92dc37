#include "fields/Densities.h"

#include "mesh/PointSetConversion.h"

#include <cadrefine/mesh/Overlap.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cadrefine
{
namespace
{

template<std::size_t Corners>
double sizeOf(const std::array<Index, Corners>& cell, const std::vector<Point3>& points)
{
  SimplexPoints<Corners> corners;
  for (std::size_t k = 0; k < Corners; ++k)
  {
    corners[k] = points[cell[k]];
  }
  return measure(corners);
}

/// Rows of cells of which each comes from one: `sources`, without those of lower dimension.
template<std::size_t Corners>
WeightedRows rowsOf(const SimplexMesh& mesh, const Simplices<Corners>& cells,
  const std::vector<Point3>& before, const std::vector<Index>& sources, Index firstSource)
{
  WeightedRows rows;
  const auto first = static_cast<Index>(firstCellOfDimension(mesh, mesh.dimension));
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    const double was = sizeOf(cells[c], before);
    const double is = sizeOf(cells[c], mesh.points);
    if (was != is && is > 0)
    {
      rows.add(firstSource + sources[c], was / is);
      rows.endRow(first + static_cast<Index>(c));
    }
  }
  return rows;
}

WeightedRows rowsOf(const SimplexMesh& mesh, const std::vector<Point3>& before,
  const std::vector<Index>& sources, Index firstSource)
{
  switch (mesh.dimension)
  {
    case 3:
      return rowsOf(mesh, mesh.tetrahedra, before, sources, firstSource);
    case 2:
      return rowsOf(mesh, mesh.triangles, before, sources, firstSource);
    default:
      return {};
  }
}

template<std::size_t Count>
double meanOf(const BezierForm<Count>& form)
{
  const auto& coefficients = form.coefficients;
  return std::accumulate(coefficients.begin(), coefficients.end(), 0.0) / Count;
}

double sizeOf(const CurvedTetrahedron& nodes, const Vector3&)
{
  return std::abs(meanOf(jacobianOf(nodes))) / 6;
}

double sizeOf(const CurvedTriangle& nodes, const Vector3& plane)
{
  return std::abs(meanOf(jacobianOf(nodes, plane))) / 2;
}

template<std::size_t Corners, std::size_t Edges>
WeightedRows curvedRowsOf(const SimplexMesh& mesh, const Simplices<Corners>& cells,
  const std::vector<std::array<Index, Edges>>& edges, const MidNodes& midNodes,
  const Vector3& plane)
{
  WeightedRows rows;
  auto place = static_cast<Index>(firstCellOfDimension(mesh, mesh.dimension));
  for (std::size_t c = 0; c < cells.size(); ++c, ++place)
  {
    const auto nodes =
      gatherNodes(mesh, cells[c], edges[c], [&](Index edge) { return midNodes.points[edge]; });
    SimplexPoints<Corners> corners;
    std::copy_n(nodes.begin(), Corners, corners.begin());
    const double curved = nodes == straightCell(corners) ? 0 : sizeOf(nodes, plane);
    if (curved > 0)
    {
      rows.add(place, measure(corners) / curved);
      rows.endRow(place);
    }
  }
  return rows;
}

} // namespace

WeightedRows densitiesOfCurved(const SimplexMesh& mesh, const MidNodes& nodes, const Vector3& plane)
{
  if (mesh.dimension == 3)
  {
    return curvedRowsOf(mesh, mesh.tetrahedra, nodes.table.ofTetrahedra, nodes, plane);
  }
  return plane == Vector3{}
           ? WeightedRows{}
           : curvedRowsOf(mesh, mesh.triangles, nodes.table.ofTriangles, nodes, plane);
}

WeightedRows densitiesOfMoved(const SimplexMesh& mesh, const std::vector<Point3>& before)
{
  std::vector<Index> sources(mesh.cellCount());
  std::iota(sources.begin(), sources.end(), 0);
  const auto first = static_cast<Index>(firstCellOfDimension(mesh, mesh.dimension));
  return rowsOf(mesh, before, sources, first);
}

WeightedRows densitiesOfRefined(
  const SimplexMesh& mesh, const RefinementTrace& trace, std::vector<Point3> before)
{
  for (const auto& [a, b] : trace.parentEdges)
  {
    before.push_back(0.5 * (before[a] + before[b]));
  }
  std::vector<Index> parents;
  const std::vector<Index>& firsts = trace.firstChildren[mesh.dimension];
  for (std::size_t c = 0; c + 1 < firsts.size(); ++c)
  {
    parents.insert(parents.end(), firsts[c + 1] - firsts[c], static_cast<Index>(c));
  }
  Index firstParent = 0;
  for (int d = 0; d < mesh.dimension; ++d)
  {
    firstParent += static_cast<Index>(trace.firstChildren[d].size()) - 1;
  }
  return rowsOf(mesh, before, parents, firstParent);
}

} // namespace cadrefine
