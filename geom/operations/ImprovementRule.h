// When the cells that an operation makes are better than those before.
#pragma once

#include <cadrefine/operations/EditableMesh.h>
#include <cadrefine/operations/SurfaceRule.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace cadrefine
{

/// The mean ratios of cells below which they are improved.
struct ImprovementLimits
{
  double floor = 0.3; ///< Cells below this, with their vertices where they are wanted, are tried.
  /// Edges of cells below this are split; below it, none gets worse where the vertices are.
  double minimum = 0.1;
  SurfaceLimits surface = {};
  /// Edges of cells below this may be collapsed, which takes refinement back.
  double collapseBelow = std::numeric_limits<double>::infinity();
};

/// The cost of cells by their mean ratios: 0 above a floor, and growing without limit below it, so
/// that of two sets of cells the one with the worse cells costs more, but an operation that mends
/// some of several bad cells gains even where the worst stays.
class QualityCost
{
public:
  explicit QualityCost(double floor) : floor_(floor) {}

  /// The cost of a cell: (floor / quality - 1)^2 below the floor; if it is inverted, far more than
  /// that of any other cell.
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

  /// Whether an operation is worth doing that lowers the cost from `before` to `after`.
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

/// Judges operations on the cells of a mesh of this dimension. Keeps references. Work: that of a
/// look at each cell, and of SurfaceRule::accepts where the boundary changes.
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
  /// Adds a cell of this quality to a group.
  void add(double quality, GroupQuality& group) const;
  /// Whether cells of quality `before` may be exchanged for others of quality `after`. The worst of
  /// triangles has to gain a hundredth of what it lacks, or, if that is less, half of what it has:
  /// a narrow face of the CAD takes many splits.
  static bool gains(const GroupQuality& before, const GroupQuality& after);
  /// Whether cells that all have this vertex may gain on `costBefore`, wherever the vertex is: the
  /// face opposite to it bounds the quality of a tetrahedron. Always true for triangles.
  bool mayGain(double costBefore, const std::vector<Corners>& cells, Index vertex) const;

  /// The smallest quality of the cells where the vertices are, or `minimum`, if that is smaller: no
  /// operation may leave a worse cell, as vertices may never come to where they are wanted.
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
