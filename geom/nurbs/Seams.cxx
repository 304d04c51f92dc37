#include <cadrefine/nurbs/Seams.h>

#include <cadrefine/nurbs/SearchStructure.h>

#include <algorithm>
#include <cmath>

namespace cadrefine
{
namespace
{

/// The four sides of a grid, in the order of Seams::collapsed_.
constexpr int lowU = 0;
constexpr int highU = 1;
constexpr int lowV = 2;
constexpr int highV = 3;

/// A grid of patches seen along its sides.
class Grid
{
public:
  Grid(const SearchPatch* patches, int rows, int columns)
    : patches_(patches), rows_(rows), columns_(columns)
  {
  }

  /// Number of patches along a side.
  int lengthOf(int side) const { return side < lowV ? columns_ : rows_; }
  const SearchPatch& patchAt(int side, int place) const
  {
    const int row = side == lowU ? 0 : side == highU ? rows_ - 1 : place;
    const int column = side == lowV ? 0 : side == highV ? columns_ - 1 : place;
    return patches_[row * columns_ + column];
  }
  /// Point of patch number `place` along a side, at local parameter x along it.
  Point3 pointOn(int side, int place, double x) const
  {
    const double across = side % 2;
    const PatchView& view = patchAt(side, place).view;
    return side < lowV ? evaluateLocal(view, across, x) : evaluateLocal(view, x, across);
  }

  /// Point of a side at the entity's parameter along it.
  Point3 pointAt(int side, double parameter) const
  {
    const auto rangeOf = [&](int place) -> std::array<double, 2>
    {
      const ParameterRectangle& r = patchAt(side, place).range;
      return side < lowV ? std::array{ r.t0, r.t1 } : std::array{ r.s0, r.s1 };
    };
    int place = 0;
    while (place + 1 < lengthOf(side) && parameter > rangeOf(place)[1])
    {
      ++place;
    }
    const auto [from, to] = rangeOf(place);
    return pointOn(side, place, to > from ? (parameter - from) / (to - from) : 0.0);
  }

private:
  const SearchPatch* patches_;
  int rows_;
  int columns_;
};

/// Calls `test(place, x)` for as many points along a side as determine its curves. Returns whether
/// all hold.
template<typename Test>
bool holdsAlong(const Grid& grid, int side, const Test& test)
{
  for (int place = 0; place < grid.lengthOf(side); ++place)
  {
    const PatchView& view = grid.patchAt(side, place).view;
    const int steps = 2 * std::max(side < lowV ? view.degreeV : view.degreeU, 1);
    for (int k = 0; k <= steps; ++k)
    {
      if (!test(place, static_cast<double>(k) / steps))
      {
        return false;
      }
    }
  }
  return true;
}

} // namespace

Seams::Seams(const SearchPatch* patches, int rows, int columns, double tolerance)
  : rows_(rows), columns_(columns), tolerance_(tolerance)
{
  const Grid grid(patches, rows, columns);
  const bool isCurve = patches[0].view.isCurve();
  const auto isClosed = [&](int side)
  {
    return holdsAlong(grid, side,
      [&](int place, double x) {
        return distance(grid.pointOn(side, place, x), grid.pointOn(side + 1, place, x)) <=
               tolerance;
      });
  };
  closedU_ = isClosed(lowU);
  closedV_ = !isCurve && isClosed(lowV);
  for (int side = 0; side < 4 && !isCurve; ++side)
  {
    const Point3 pole = grid.pointOn(side, 0, 0.0);
    collapsed_[side] = holdsAlong(grid, side,
      [&](int place, double x)
      { return distance(grid.pointOn(side, place, x), pole) <= tolerance; });
  }
}

std::array<double, 2> Seams::canonical(
  const SearchPatch* patches, const Point3& point, std::array<double, 2> parameters) const
{
  constexpr double nearby = 1e-6; // of the parameter range: farther ones need not be looked at
  const ParameterRectangle& first = patches[0].range;
  const ParameterRectangle& last = patches[rows_ * columns_ - 1].range;
  const std::array<double, 2> low = { first.s0, first.t0 };
  const std::array<double, 2> high = { last.s1, last.t1 };
  const Grid grid(patches, rows_, columns_);
  for (int side = 0; side < 4; ++side)
  {
    const int across = side / 2;
    const int along = 1 - across;
    const double end = side % 2 == 0 ? low[across] : high[across];
    if (!(std::abs(parameters[across] - end) <= nearby * (high[across] - low[across])))
    {
      continue;
    }
    if (collapsed_[side] && distance(point, grid.pointOn(side, 0, 0.0)) <= tolerance_)
    {
      parameters[across] = end;
      parameters[along] = low[along];
    }
    else if ((across == 0 ? closedU_ : closedV_) &&
             distance(point, grid.pointAt(side, parameters[along])) <= tolerance_)
    {
      parameters[across] = low[across];
    }
  }
  return parameters;
}

} // namespace cadrefine
