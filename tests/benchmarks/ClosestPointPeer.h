// Open CASCADE's own ways to the closest point.
#pragma once

#include "ClosestPointCase.h"

#include <memory>

namespace cadbenchmark
{

/// Prepared for the points of a case. A query returns the distance; infinity where it failed.
class OpenCascadePeer
{
public:
  explicit OpenCascadePeer(const Case& of);
  ~OpenCascadePeer();
  OpenCascadePeer(const OpenCascadePeer&) = delete;
  OpenCascadePeer& operator=(const OpenCascadePeer&) = delete;

  /// Extrema_GenLocateExtPS for point number `i`: Newton's method on the face that the point was
  /// made from, as NURBS, started within 1e-3 of the face's parameter range off the foot.
  double locate(std::size_t i) const;
  /// The same on the surface that the file has, which may be a plane, a cylinder and so on.
  double locateAsRead(std::size_t i) const;
  /// BRepExtrema_DistShapeShape between point number `i` and the whole model.
  double search(std::size_t i) const;

private:
  struct Implementation;
  std::unique_ptr<const Implementation> implementation_;
};

} // namespace cadbenchmark
