// What of the cells that an operation makes is better than those before.
#pragma once

#include <cadrefine/operations/EditableMesh.h>
#include <cadrefine/operations/SurfaceRule.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace cadrefine
{

/// Mean ratios of cells.
struct ImprovementLimits
{
  double floor = 0.3;   ///< Cells below this, with their vertices where they are wanted, are tried.
  double minimum = 0.1; ///< Edges of cells below this are split; below it none gets worse in place.
  SurfaceLimits surface = {};
};

/// The cost of cells by their mean ratios: none above a floor, then growing without limit, so that
/// of two sets of cells that with the worse ones costs more, but an operation that mends some of
/// several bad cells gains even where the worst stays.
class QualityCost
{
public:
  explicit QualityCost(double floor) : floor_(floor) {}

  /// (floor / quality - 1)^2; far more than that of any other cell where it is inverted.
  double of(double quality) const
  {
    if (quality >= floor_)
    {
      return 0;
    }
    if (quality < least)
    {
      const double worst = floor_ / least - 1;
      return worst * worst + (least - quality) * costOfInversion;
    }
    const double lacks = floor_ / quality - 1;
    return lacks * lacks;
  }

  /// Whether so much less is worth an operation.
  static bool isGain(double before, double after) { return after <= (1 - leastGain) * before; }

private:
  static constexpr double least = 1e-4;
  static constexpr double costOfInversion = 1e12;
  static constexpr double leastGain = 0.01;

  double floor_;
};

/// The worst quality of some cells, and what they cost together (see QualityCost).
struct GroupQuality
{
  double worst = std::numeric_limits<double>::infinity();
  double cost = 0;
};

/// Of the cells of a mesh of this dimension. Keeps references. Work: that of a look at each cell,
/// and of SurfaceRule::accepts where the boundary changes.
template<int Dimension>
class ImprovementRule
{
public:
  using Corners = std::array<Index, Dimension + 1>;

  /// `surface`: null where the boundary is to stay.
  ImprovementRule(
    const EditableMesh& mesh, const SurfaceRule* surface, const ImprovementLimits& limits)
    : mesh_(mesh), surface_(surface), limits_(limits), cost_(limits.floor)
  {
  }

  GroupQuality qualityOf(const std::vector<Index>& cells) const;
  /// With another cell.
  void add(double quality, GroupQuality& group) const;
  /// Whether cells may be exchanged for others. Of triangles the worst one has to gain a hundredth
  /// of what it lacks, or, if that is less, half of what it has: a narrow face of the CAD takes
  /// many splits.
  static bool gains(const GroupQuality& before, const GroupQuality& after);
  /// Whether cells may gain if each has this vertex, wherever that is: of tetrahedra, as the face
  /// opposite to it bounds their quality.
  bool mayGain(double costBefore, const std::vector<Corners>& cells, Index vertex) const;

  /// The worst of the cells where the vertices are, so far as that is bad: no operation may leave a
  /// worse one, as vertices may never come to where they are wanted.
  double worstCurrent(const std::vector<Index>& cells) const;
  bool keepsCurrentQuality(const Cavity& cavity) const;
  bool keepsSurface(const Cavity& cavity) const;

private:
  const EditableMesh& mesh_;
  const SurfaceRule* surface_;
  const ImprovementLimits limits_;
  const QualityCost cost_;
};

} // namespace cadrefine
