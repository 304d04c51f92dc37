#include <cadrefine/mesh/CellState.h>

#include <cadrefine/mesh/CellJacobian.h>
#include <cadrefine/mesh/Orientation.h>

#include <cmath>

namespace cadrefine
{
namespace
{

CellState stateOfScaled(double scaled)
{
  return { scaled > 0, scaled };
}

} // namespace

CellState stateAt(shapes::Tetrahedron, const std::array<Point3, 4>& p, const Vector3&, double)
{
  return { orientation(p[0], p[1], p[2], p[3]) > 0, meanRatio(p[0], p[1], p[2], p[3]) };
}

CellState stateAt(shapes::Triangle, const std::array<Point3, 3>& p, const Vector3& side, double)
{
  const int turn = turnOf(p[0], p[1], p[2], side);
  return { turn > 0, std::copysign(meanRatio(p[0], p[1], p[2]), turn) };
}

CellState stateAt(shapes::Pyramid, const std::array<Point3, 5>& p, const Vector3&, double)
{
  return stateOfScaled(scaledJacobian(p));
}

CellState stateAt(shapes::Wedge, const std::array<Point3, 6>& p, const Vector3&, double)
{
  return stateOfScaled(scaledJacobian(p));
}

CellState stateAt(shapes::Hexahedron, const std::array<Point3, 8>& p, const Vector3&, double enough)
{
  return stateOfScaled(scaledJacobian(p, enough));
}

CellState stateAt(
  shapes::Quadrilateral, const std::array<Point3, 4>& p, const Vector3& side, double)
{
  return stateOfScaled(scaledJacobian(p, side));
}

} // namespace cadrefine
