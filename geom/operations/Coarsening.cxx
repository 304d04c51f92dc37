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

double facetsOnCAD(const EditableMesh& mesh)
{
  double count = 0;
  for (std::size_t f = 0; f < mesh.facets().size(); ++f)
  {
    count += mesh.facets()[static_cast<Index>(f)].label >= 0 ? 1 : 0;
  }
  return count;
}

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

  std::vector<Index> remainingNeighbours(Index vertex) const
  {
    std::vector<Index> neighbours;
    for (const Index cell : mesh_.cells().at(vertex))
    {
      for (const Index corner : mesh_.cells()[cell].corners)
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

  /// The worst cell of the collapse in the cavity; negative where it must not be.
  double worstAfter() const
  {
    double before = limits_.minimumQuality;
    double presentBefore = limits_.minimumQuality;
    for (const Index cell : cavity_.cells)
    {
      before = std::min(before, mesh_.quality(mesh_.cells()[cell].corners));
      presentBefore = std::min(presentBefore, mesh_.presentQuality(mesh_.cells()[cell].corners));
    }
    double worst = infinity;
    for (const auto& cell : cavity_.newCells)
    {
      worst = std::min(worst, mesh_.quality(cell.corners));
      if (worst < before || mesh_.presentQuality(cell.corners) < presentBefore ||
          !mesh_.isValid(cell.corners))
      {
        return -1;
      }
    }
    return worst;
  }

  bool collapse(Index vertex)
  {
    std::vector<std::pair<double, Index>> targets;
    for (const Index to : remainingNeighbours(vertex))
    {
      if (proposeCollapse(mesh_, vertex, to, cavity_))
      {
        targets.emplace_back(worstAfter(), to);
      }
    }
    // The projections of the rule cost most, so that it is asked last.
    std::stable_sort(targets.begin(), targets.end(),
      [](const auto& a, const auto& b) { return a.first > b.first; });
    return std::any_of(targets.begin(), targets.end(),
      [&](const auto& target)
      {
        return target.first >= 0 && proposeCollapse(mesh_, vertex, target.second, cavity_) &&
               keepsSurface() && carryOut();
      });
  }

  /// Takes what the collapse adds to the error off what is left.
  bool keepsSurface()
  {
    if (cavity_.facets.empty())
    {
      return true;
    }
    if (!rule_.accepts(mesh_, cavity_, limits_.distance))
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
    for (const auto& cell : cavity_.newCells)
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

} // namespace

OperationResult coarsenCells(EditableMesh& mesh, const SurfaceRule& rule,
  std::vector<unsigned char> goes, const CoarseningLimits& limits)
{
  double errorLeft =
    limits.errorPerFacet < infinity ? limits.errorPerFacet * facetsOnCAD(mesh) : infinity;
  std::int64_t collapses = Coarsener(mesh, rule, goes, limits, errorLeft).run();
  OperationResult result =
    improveCells(mesh, &rule, { std::max(limits.minimumQuality, aim), limits.minimumQuality });
  goes.resize(mesh.vertexCount(), 0);
  collapses += Coarsener(mesh, rule, goes, limits, errorLeft).run();
  result.counts.collapses += collapses;
  return result;
}

} // namespace cadrefine
