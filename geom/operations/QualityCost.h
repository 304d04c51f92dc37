// How bad cells are, as a number that operations are to make smaller.
#pragma once

#include <cadrefine/base/Vector3.h>

namespace cadrefine
{

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

/// The largest mean ratio of any tetrahedron that has this triangle as a face: that with its apex
/// over the centroid, at a height whose square is 2/9 of the sum of the squared edges.
double largestMeanRatioOver(const Point3& a, const Point3& b, const Point3& c);

} // namespace cadrefine
