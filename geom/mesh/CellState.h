// Validity and quality of one cell of any shape.
#pragma once

#include <cadrefine/mesh/Mesh.h>
#include <cadrefine/mesh/Quality.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace cadrefine
{

/// Whether a cell is valid, and its quality: for simplices the mean ratio, negative where they are
/// inverted, for others the scaled Jacobian.
struct CellState
{
  bool valid = false;
  double quality = 0;
};

constexpr double infiniteQuality = std::numeric_limits<double>::infinity();

/// The state of a cell with these corners: validity of simplices by exact orientation, of others by
/// the sign of their Jacobian everywhere. A cell of area is valid where it turns as seen from the
/// end of `side`. The quality of a valid cell may be a lower bound of it, where that is at least
/// `enough`.
CellState stateAt(shapes::Tetrahedron, const std::array<Point3, 4>& p, const Vector3& side = {},
  double enough = infiniteQuality);
CellState stateAt(shapes::Pyramid, const std::array<Point3, 5>& p, const Vector3& side = {},
  double enough = infiniteQuality);
CellState stateAt(shapes::Wedge, const std::array<Point3, 6>& p, const Vector3& side = {},
  double enough = infiniteQuality);
CellState stateAt(shapes::Hexahedron, const std::array<Point3, 8>& p, const Vector3& side = {},
  double enough = infiniteQuality);
CellState stateAt(shapes::Triangle, const std::array<Point3, 3>& p, const Vector3& side,
  double enough = infiniteQuality);
CellState stateAt(shapes::Quadrilateral, const std::array<Point3, 4>& p, const Vector3& side,
  double enough = infiniteQuality);

/// The points of a cell's corners.
template<std::size_t Corners>
std::array<Point3, Corners> cornersOf(
  const std::array<Index, Corners>& cell, const std::vector<Point3>& points)
{
  std::array<Point3, Corners> result;
  std::transform(cell.begin(), cell.end(), result.begin(), [&](Index v) { return points[v]; });
  return result;
}

/// The side from which a cell is seen: for one of area the normal of the plane, or else its own (of
/// any length) with its corners at these points; zero for one of volume.
template<class Shape>
Vector3 sideOf(Shape, const std::array<Point3, Shape::corners>& p, const Vector3& plane)
{
  if constexpr (Shape::dimension == 3)
  {
    return {};
  }
  else if constexpr (Shape::corners == 4)
  {
    return plane != Vector3{} ? plane : twofoldAreaVector(p, 4);
  }
  else
  {
    return plane != Vector3{} ? plane : twofoldAreaVector(p[0], p[1], p[2]);
  }
}

} // namespace cadrefine
