#include <cadrefine/operations/Coarsening.h>

#include <cadrefine/operations/Improvement.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace cadrefine
{
namespace
{

using Freedom = EditableMesh::Freedom;

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Cells below this are improved so that more vertices can go.
constexpr double aim = 0.3;

/// Of the boundary on the CAD.
double countFacetsOnCAD(const EditableMesh& mesh)
{
  const auto count = [](const auto& store)
  {
    double result = 0;
    for (std::size_t s = 0; s < store.size(); ++s)
    {
      result += store[static_cast<Index>(s)].label >= 0 ? 1 : 0;
    }
    return result;
  };
  return mesh.kind() == EditableMesh::Kind::Plane ? count(mesh.segments()) : count(mesh.facets());
}

template<int Dimension>
class Coarsener
{
public:
  Coarsener(EditableMesh& mesh, const SurfaceRule& rule, const std::vector<unsigned char>& goes,
    const CoarseningLimits& limits, double& errorLeft)
    : mesh_(mesh), rule_(rule), goes_(goes), limits_(limits), errorLeft_(errorLeft), waits_(goes)
  {
  }

  /// Returns the number of collapses.
  std::int64_t run()
  {
    const std::vector<Index> vertices = candidates();
    bool changes = true;
    while (changes)
    {
      changes = false;
      for (const Index vertex : vertices)
      {
        if (waits_[vertex])
        {
          waits_[vertex] = 0;
          changes = collapse(vertex) || changes;
        }
      }
    }
    return collapses_;
  }

private:
  /// Those that may go at all, the freest first.
  std::vector<Index> candidates() const
  {
    std::vector<std::pair<Freedom, Index>> sorted;
    for (std::size_t v = 0; v < goes_.size(); ++v)
    {
      const auto vertex = static_cast<Index>(v);
      const Freedom freedom = goes_[v] ? mesh_.freedomOf(vertex) : Freedom::None;
      if (freedom != Freedom::None)
      {
        sorted.emplace_back(freedom, vertex);
      }
    }
    std::stable_sort(
      sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<Index> vertices(sorted.size());
    std::transform(sorted.begin(), sorted.end(), vertices.begin(),
      [](const auto& candidate) { return candidate.second; });
    return vertices;
  }

  using Corners = std::array<Index, Dimension + 1>;

  const SimplexStore<Dimension + 1>& cells() const { return mesh_.template cellsOf<Dimension>(); }

  std::vector<Index> remainingNeighbours(Index vertex) const
  {
    std::vector<Index> neighbours;
    for (const Index cell : cells().at(vertex))
    {
      for (const Index corner : cells()[cell].corners)
      {
        if (!goes_[corner])
        {
          neighbours.push_back(corner);
        }
      }
    }
    std::sort(neighbours.begin(), neighbours.end());
    neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
    return neighbours;
  }

  /// The worst of the cells at a vertex, so far as it is below the minimum.
  double worstAt(Index vertex) const
  {
    double worst = limits_.minimumQuality;
    for (const Index cell : cells().at(vertex))
    {
      worst = std::min(worst, mesh_.quality(cells()[cell].corners));
    }
    return worst;
  }

  /// The worst cell once the vertex has gone to another; -1 where that is below `least`.
  double worstAfter(Index vertex, Index to, double least) const
  {
    double worst = infinity;
    for (const Index cell : cells().at(vertex))
    {
      Corners corners = cells()[cell].corners;
      if (!hasCorner(corners, to))
      {
        std::replace(corners.begin(), corners.end(), vertex, to);
        worst = std::min(worst, mesh_.quality(corners));
        if (worst < least)
        {
          return -1;
        }
      }
    }
    return worst;
  }

  /// Where vertices are, which may not be where they are wanted.
  bool keepsPresentQuality() const
  {
    double before = limits_.minimumQuality;
    for (const Index cell : cavity_.cellsOf<Dimension>())
    {
      before = std::min(before, mesh_.presentQuality(cells()[cell].corners));
    }
    const auto& newCells = cavity_.newCellsOf<Dimension>();
    return std::all_of(newCells.begin(), newCells.end(),
      [&](const auto& cell) { return mesh_.presentQuality(cell.corners) >= before; });
  }

  bool collapse(Index vertex)
  {
    const double least = worstAt(vertex);
    std::vector<std::pair<double, Index>> targets;
    for (const Index to : remainingNeighbours(vertex))
    {
      const double worst = worstAfter(vertex, to, least);
      if (worst >= 0)
      {
        targets.emplace_back(worst, to);
      }
    }
    // What costs most comes last.
    std::stable_sort(targets.begin(), targets.end(),
      [](const auto& a, const auto& b) { return a.first > b.first; });
    return std::any_of(targets.begin(), targets.end(),
      [&](const auto& target)
      {
        return proposeCollapse(mesh_, vertex, target.second, cavity_) && mesh_.isValid(cavity_) &&
               keepsPresentQuality() && keepsSurface() && carryOut();
      });
  }

  /// Takes what the collapse adds to the error off what is left.
  bool keepsSurface()
  {
    if (!mesh_.touchesBoundary(cavity_))
    {
      return true;
    }
    if (!rule_.accepts(
          mesh_, cavity_, { limits_.distance, false, SurfaceLimits::Walls::LoseVertices }))
    {
      return false;
    }
    const double gain = errorLeft_ < infinity ? rule_.errorGain(mesh_, cavity_) : 0;
    if (gain > errorLeft_)
    {
      return false;
    }
    errorLeft_ -= gain;
    return true;
  }

  bool carryOut()
  {
    mesh_.replace(cavity_);
    ++collapses_;
    for (const auto& cell : cavity_.newCellsOf<Dimension>())
    {
      for (const Index corner : cell.corners)
      {
        waits_[corner] = goes_[corner];
      }
    }
    return true;
  }

  EditableMesh& mesh_;
  const SurfaceRule& rule_;
  const std::vector<unsigned char>& goes_;
  const CoarseningLimits limits_;
  double& errorLeft_;
  std::vector<unsigned char> waits_; ///< 1: to be tried.
  Cavity cavity_;
  std::int64_t collapses_ = 0;
};

template<int Dimension>
OperationResult coarsen(EditableMesh& mesh, const SurfaceRule& rule,
  std::vector<unsigned char> goes, const CoarseningLimits& limits)
{
  double errorLeft =
    limits.errorPerFacet < infinity ? limits.errorPerFacet * countFacetsOnCAD(mesh) : infinity;
  std::int64_t collapses = Coarsener<Dimension>(mesh, rule, goes, limits, errorLeft).run();
  const SurfaceLimits surface{ 0, true, SurfaceLimits::Walls::LoseVertices };
  OperationResult result = improveCells(
    mesh, &rule, { std::max(limits.minimumQuality, aim), limits.minimumQuality, surface });
  goes.resize(mesh.vertexCount(), 0);
  collapses += Coarsener<Dimension>(mesh, rule, goes, limits, errorLeft).run();
  result.counts.collapses += collapses;
  return result;
}

} // namespace

OperationResult coarsenCells(EditableMesh& mesh, const SurfaceRule& rule,
  const std::vector<unsigned char>& goes, const CoarseningLimits& limits)
{
  return mesh.dimension() == 3 ? coarsen<3>(mesh, rule, goes, limits)
                               : coarsen<2>(mesh, rule, goes, limits);
}

} // namespace cadrefine
