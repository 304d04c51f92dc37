// Where a face or an edge meets itself, so that one point has many parameters. Private to
// geom/nurbs.
#pragma once

#include <cadrefine/nurbs/PatchView.h>

#include <array>
#include <vector>

namespace cadrefine
{

struct SearchPatch;

/// Seams and poles of the grid of patches of a face, or of the segments of an edge. A point on a
/// seam is given the lower parameter, a point on a collapsed side (a pole) the lowest one along it,
/// from whichever side it was reached.
class Seams
{
public:
  Seams() = default;
  /// `patches` are those of the grid: patch (i, j), i along u, at i * columns + j. Two points count
  /// as one where they are within `tolerance`.
  Seams(const SearchPatch* patches, int rows, int columns, double tolerance);

  bool any() const { return closedU_ || closedV_ || collapsed_ != none; }
  /// The parameters to give for the point at `parameters`, in place of these.
  std::array<double, 2> canonical(
    const SearchPatch* patches, const Point3& point, std::array<double, 2> parameters) const;

private:
  static constexpr std::array<bool, 4> none{ false, false, false, false };

  int rows_ = 0;
  int columns_ = 0;
  double tolerance_ = 0;
  bool closedU_ = false;
  bool closedV_ = false;
  std::array<bool, 4> collapsed_ = none; ///< The sides of lowest and highest u, then v.
};

} // namespace cadrefine
