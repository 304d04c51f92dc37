// Axis-aligned boxes. For sources of geom/ alone.
#pragma once

#include <cadrefine/base/Vector3.h>

#include <algorithm>
#include <limits>

namespace cadrefine
{

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
  void include(const BoundingBox& box)
  {
    include(box.low);
    include(box.high);
  }
  bool isEmpty() const { return low[0] > high[0]; }
  double diagonal() const { return isEmpty() ? 0.0 : distance(low, high); }
  Point3 middle() const { return 0.5 * (low + high); }
};

} // namespace cadrefine
