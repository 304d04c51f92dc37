#include "mesh/MeshPlane.h"

#include <cadrefine/mesh/CellState.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace cadrefine
{
namespace
{

/// A planar mesh leaves its plane by less than this part of its extent.
constexpr double inPlane = 2e-7;

/// The point of all ranks that has the largest measure; of several the first in order. Collective.
template<class Measure>
Point3 farthest(RankExchange& exchange, const std::vector<Point3>& points, const Measure& measure)
{
  struct Found
  {
    double measure = -std::numeric_limits<double>::infinity();
    Point3 point{};

    void take(double other, const Point3& at)
    {
      if (other > measure || (other == measure && at < point))
      {
        *this = { other, at };
      }
    }
  };
  Found mine;
  for (const Point3& point : points)
  {
    mine.take(measure(point), point);
  }
  const auto& [x, y, z] = mine.point;
  const auto all = exchange.gather(std::vector<double>{ mine.measure, x, y, z });
  Found best;
  for (std::size_t i = 0; i < all.size(); i += 4)
  {
    best.take(all[i], { all[i + 1], all[i + 2], all[i + 3] });
  }
  return best.point;
}

} // namespace

Vector3 normalOfPoints(RankExchange& exchange, const std::vector<Point3>& points)
{
  const Point3 a = farthest(exchange, points, [](const Point3& p) { return -p[0]; });
  const Point3 b = farthest(exchange, points, [&](const Point3& p) { return distance(a, p); });
  const auto area = [&](const Point3& p) { return cross(b - a, p - a); };
  const Point3 c = farthest(exchange, points, [&](const Point3& p) { return norm(area(p)); });
  if (area(c) == Vector3{})
  {
    return {};
  }
  const Vector3 normal = normalized(area(c));
  double away = 0;
  for (const Point3& point : points)
  {
    away = std::max(away, std::abs(dot(normal, point - a)));
  }
  return exchange.max(away) <= inPlane * distance(a, b) ? normal : Vector3{};
}

Vector3 planeNormal(RankExchange& exchange, const Mesh& mesh)
{
  const Vector3 normal = mesh.dimension == 2 ? normalOfPoints(exchange, mesh.points) : Vector3{};
  if (normal == Vector3{})
  {
    return normal;
  }
  std::int64_t turns = 0;
  visitShapes(mesh, 2,
    [&](auto shape, const auto& cells)
    {
      for (const auto& cell : cells)
      {
        const double turn = dot(normal, sideOf(shape, cornersOf(cell, mesh.points), {}));
        turns += (turn > 0) - (turn < 0);
      }
    });
  return exchange.sum(turns) < 0 ? -1.0 * normal : normal;
}

Vector3 planeNormal(RankExchange& exchange, const Mesh& mesh, bool staysInPlane)
{
  return staysInPlane ? planeNormal(exchange, mesh) : Vector3{};
}

} // namespace cadrefine
