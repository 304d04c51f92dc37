// Points to ask for the closest point of a model.
#pragma once

#include <cadrefine/base/Vector3.h>

#include <TopoDS_Shape.hxx>

#include <limits>
#include <vector>

namespace exacttest
{

/// Where a point comes from.
enum class PointKind
{
  surface, ///< On a face, or off it along its normal, by 0, 1e-6, 1e-3, 1e-2, 0.3 or 3 sizes.
  loop,    ///< On a face's surface just inside or outside of a trim loop, or over such a point.
  border,  ///< On a trim curve on its surface, or off it in any direction.
  edge,    ///< On an edge, or off it in any direction.
  vertex,  ///< At a vertex, or off it in any direction.
  seam,    ///< On a seam, to both of its sides, and over it.
  pole,    ///< At a degenerate edge, beside it, and over it.
  axis,    ///< On the axis or at the centre of a face, and a little off it.
  bend,    ///< At a centre of curvature of a face.
  box      ///< Anywhere in the bounding box, or in one a little larger.
};

const char* nameOf(PointKind kind);

struct SamplePoint
{
  cadrefine::Point3 point{};
  /// The distance to a point known to be on the model: an upper bound of the answer's.
  double bound = std::numeric_limits<double>::infinity();
  PointKind kind = PointKind::box;
};

/// At least 2000 points, the same for the same shape; `size` is its diagonal.
std::vector<SamplePoint> samplePoints(const TopoDS_Shape& shape, double size);

} // namespace exacttest
