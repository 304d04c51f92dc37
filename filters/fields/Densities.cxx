#include "fields/Densities.h"

#include "mesh/PointSetConversion.h"

#include <cadrefine/mesh/Overlap.h>

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

} // namespace

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
