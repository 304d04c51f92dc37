// Axis-aligned boxes.
#pragma once

#include <cadrefine/base/Vector3.h>

#include <algorithm>
#include <limits>

namespace cadrefine
{

/// Lowest and highest coordinates; low above high where nothing was included.
struct BoundingBox
{
  Point3 low{ std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
    std::numeric_limits<double>::infinity() };
  Point3 high{ -std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
    -std::numeric_limits<double>::infinity() };

  void include(const Point3& p)
  {
    for (int k = 0; k < 3; ++k)
    {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
  /// An empty box, which is inside out, makes this one infinite.
  void include(const BoundingBox& box)
  {
    include(box.low);
    include(box.high);
  }
  bool isEmpty() const { return low[0] > high[0]; }
  double diagonal() const { return isEmpty() ? 0.0 : distance(low, high); }
  Point3 middle() const { return 0.5 * (low + high); }
  bool meets(const BoundingBox& box) const
  {
    return low[0] <= box.high[0] && box.low[0] <= high[0] && low[1] <= box.high[1] &&
           box.low[1] <= high[1] && low[2] <= box.high[2] && box.low[2] <= high[2];
  }
  bool contains(const Point3& p, double margin = 0) const
  {
    bool inside = true;
    for (int k = 0; k < 3; ++k)
    {
      inside = inside && p[k] >= low[k] - margin && p[k] <= high[k] + margin;
    }
    return inside;
  }
};

template<class Points>
BoundingBox boxOf(const Points& points)
{
  BoundingBox box;
  for (const Point3& point : points)
  {
    box.include(point);
  }
  return box;
}

} // namespace cadrefine
