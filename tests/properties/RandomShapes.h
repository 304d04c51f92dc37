// Random NURBS shapes, made with Open CASCADE.
#pragma once

#include "Rounds.h"

#include <cadrefine/base/Vector3.h>

#include <TopoDS_Shape.hxx>

#include <array>
#include <ostream>

namespace propertytest
{

/// Degrees, knots (up to as many times as the degree), weights and control points at random.
enum class ShapeKind
{
  Patch,    ///< One surface with its own border.
  Trimmed,  ///< One surface within a loop, and round holes, of lines, arcs or splines.
  Closed,   ///< Six surfaces, joined like the sides of the unit cube, near it.
  Revolved, ///< A curve turned about an axis: with a seam, and poles or circles at its ends.
  Curves    ///< A closed chain of curves in the plane z = 0.
};
constexpr std::array<ShapeKind, 5> shapeKinds{ ShapeKind::Patch, ShapeKind::Trimmed,
  ShapeKind::Closed, ShapeKind::Revolved, ShapeKind::Curves };
const char* nameOf(ShapeKind kind);
inline void PrintTo(ShapeKind kind, std::ostream* out)
{
  *out << nameOf(kind);
}

/// Some 1 in size.
TopoDS_Shape randomShape(Random& random, ShapeKind kind);

/// The closed shape: how far its control points lie from the unit cube's, at most.
TopoDS_Shape nearUnitCube(Random& random, double offset);
/// A closed chain of splines through points on the unit circle, near it.
TopoDS_Shape nearUnitCircle(Random& random, double offset);

/// A turn about any axis, a change of size, and a move.
struct Motion
{
  std::array<cadrefine::Vector3, 3> rows{ { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };
  double scale = 1;
  cadrefine::Vector3 shift{};

  cadrefine::Point3 operator()(const cadrefine::Point3& point) const;
};

/// Sizes from 10^lowest to 10^highest; moves of up to `sizes` times the new size. In the plane z
/// stays 0.
Motion randomMotion(Random& random, double lowest, double highest, double sizes, bool inThePlane);

/// A copy of the shape, moved.
TopoDS_Shape moved(const TopoDS_Shape& shape, const Motion& motion);

} // namespace propertytest
