#include <cadrefine/operations/ImprovementRule.h>

#include <cadrefine/mesh/Quality.h>

namespace cadrefine
{

template<int Dimension>
GroupQuality ImprovementRule<Dimension>::qualityOf(const std::vector<Index>& cells) const
{
  GroupQuality group;
  for (const Index cell : cells)
  {
    add(mesh_.qualityOf(cell), group);
  }
  return group;
}

template<int Dimension>
void ImprovementRule<Dimension>::add(double quality, GroupQuality& group) const
{
  group.worst = std::min(group.worst, quality);
  group.cost += cost_.of(quality);
}

template<int Dimension>
bool ImprovementRule<Dimension>::gains(const GroupQuality& before, const GroupQuality& after)
{
  if constexpr (Dimension == 3)
  {
    return after.worst >= before.worst && QualityCost::isGain(before.cost, after.cost);
  }
  const double least = 0.01 * (1 - before.worst);
  return after.worst >
         before.worst + (before.worst > 0 ? std::min(least, 0.5 * before.worst) : least);
}

template<int Dimension>
bool ImprovementRule<Dimension>::mayGain(
  double costBefore, const std::vector<Corners>& cells, Index vertex) const
{
  double least = 0;
  for (const Corners& cell : cells)
  {
    if constexpr (Dimension == 3)
    {
      const auto& face = faceOppositeTo(vertex, cell);
      const auto at = [&](int k) -> const Point3& { return mesh_.vertex(cell[face[k]]).wanted; };
      least += cost_.of(largestMeanRatioOver(at(0), at(1), at(2)));
    }
  }
  return QualityCost::isGain(costBefore, least);
}

template<int Dimension>
double ImprovementRule<Dimension>::worstCurrent(const std::vector<Index>& cells) const
{
  double worst = limits_.minimum;
  for (const Index cell : cells)
  {
    const Corners& corners = mesh_.cellsOf<Dimension>()[cell].corners;
    worst = std::min(worst, mesh_.currentQuality(corners));
  }
  return worst;
}

template<int Dimension>
bool ImprovementRule<Dimension>::keepsCurrentQuality(const Cavity& cavity) const
{
  const double least = worstCurrent(cavity.cellsOf<Dimension>());
  const auto& cells = cavity.newCellsOf<Dimension>();
  return std::all_of(cells.begin(), cells.end(),
    [&](const auto& cell) { return mesh_.currentQuality(cell.corners) >= least; });
}

template<int Dimension>
bool ImprovementRule<Dimension>::keepsSurface(const Cavity& cavity) const
{
  return !mesh_.touchesBoundary(cavity) ||
         (surface_ && surface_->accepts(mesh_, cavity, limits_.surface));
}

template class ImprovementRule<2>;
template class ImprovementRule<3>;

} // namespace cadrefine
