// Moves of points, of which each goes a part of its way.
#pragma once

#include <cadrefine/base/MeshTypes.h>
#include <cadrefine/base/Vector3.h>

#include <vector>

namespace cadrefine
{

/// Straight moves of some points, vertices of a mesh or mid nodes of its edges, each done up to a
/// part of its way.
struct Moves
{
  std::vector<Point3> targets; ///< Where each point is to go; its own place if it does not move.
  /// Part of its way that each point goes, in [0, 1]; 0 if it does not move.
  std::vector<double> fractions;
  std::vector<unsigned char> whole; ///< 1: the point moves all of its way or not at all.

  /// Moves of these points, of which none moves yet.
  explicit Moves(const std::vector<Point3>& points)
    : targets(points), fractions(points.size(), 0.0), whole(points.size(), 0)
  {
  }

  void add(Index point, const Point3& target)
  {
    targets[point] = target;
    fractions[point] = 1;
  }

  /// Where a point stands, given where all start: at its target exactly at fraction 1, at its start
  /// exactly at 0.
  Point3 position(const std::vector<Point3>& starts, Index point) const
  {
    const double fraction = fractions[point];
    if (fraction == 1)
    {
      return targets[point];
    }
    const Point3& start = starts[point];
    return fraction == 0 ? start : start + fraction * (targets[point] - start);
  }
};

} // namespace cadrefine
