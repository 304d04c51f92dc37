// Ideal hexahedra, wedges and pyramids, changed in ways of which more is known, and their maps by
// shape functions written out.
#pragma once

#include <cadrefine/mesh/CellJacobian.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace cadtest
{

using namespace cadrefine;

inline const double pi = std::acos(-1.0);
inline const Hexahedron cube{ { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 },
  { 1, 0, 1 }, { 1, 1, 1 }, { 0, 1, 1 } } };
inline const Wedge prism{ { { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, std::sqrt(0.75), 0 }, { 0, 0, 1 },
  { 1, 0, 1 }, { 0.5, std::sqrt(0.75), 1 } } };
inline const Pyramid pyramid{ { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 },
  { 0.5, 0.5, std::sqrt(0.5) } } };

/// Shape functions, written out.
inline Point3 pointAt(const Hexahedron& c, const Vector3& at)
{
  const auto [r, s, t] = at;
  return (1 - r) * (1 - s) * (1 - t) * c[0] + r * (1 - s) * (1 - t) * c[1] +
         r * s * (1 - t) * c[2] + (1 - r) * s * (1 - t) * c[3] + (1 - r) * (1 - s) * t * c[4] +
         r * (1 - s) * t * c[5] + r * s * t * c[6] + (1 - r) * s * t * c[7];
}

/// The triangle from a square, folded down at one side: its corner 0 is at s = 1.
inline Point3 pointAt(const Wedge& c, const Vector3& at)
{
  const auto [r, s, t] = at;
  const double weight[3] = { s, (1 - r) * (1 - s), r * (1 - s) };
  Point3 result{};
  for (int k = 0; k < 3; ++k)
  {
    result = result + weight[k] * ((1 - t) * c[k] + t * c[3 + k]);
  }
  return result;
}

inline Point3 pointAt(const Pyramid& c, const Vector3& at)
{
  const auto [r, s, t] = at;
  const Point3 base =
    (1 - r) * (1 - s) * c[0] + r * (1 - s) * c[1] + r * s * c[2] + (1 - r) * s * c[3];
  return (1 - t) * base + t * c[4];
}

/// By differences across the whole cell, in each direction of which the maps are linear.
template<class Cell>
double jacobianAt(const Cell& cell, const Vector3& at)
{
  std::array<Vector3, 3> along;
  for (int d = 0; d < 3; ++d)
  {
    Vector3 end = at;
    end[d] = 1;
    Vector3 start = at;
    start[d] = 0;
    along[d] = pointAt(cell, end) - pointAt(cell, start);
  }
  return dot(along[0], cross(along[1], along[2]));
}

/// Where the square that a triangle or a pyramid is made of shrinks, the determinant vanishes by
/// that alone.
inline double shrinkingAt(const Hexahedron&, const Vector3&)
{
  return 1;
}

inline double shrinkingAt(const Wedge&, const Vector3& at)
{
  return 1 - at[1];
}

inline double shrinkingAt(const Pyramid&, const Vector3& at)
{
  return (1 - at[2]) * (1 - at[2]);
}

template<class Cell>
double smallestSample(const Cell& cell, int n)
{
  // Up to next to the end, where it may be 0 / 0.
  const auto parameter = [n](int i) { return std::min(1.0 * i / n, 1023 / 1024.0); };
  double smallest = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= n; ++i)
  {
    for (int j = 0; j <= n; ++j)
    {
      for (int k = 0; k <= n; ++k)
      {
        const Vector3 at{ parameter(i), parameter(j), parameter(k) };
        smallest = std::min(smallest, jacobianAt(cell, at) / shrinkingAt(cell, at));
      }
    }
  }
  return smallest;
}

/// By Gauss points, exact for these degrees.
template<class Cell>
double integral(const Cell& cell)
{
  const double points[3] = { 0.5 - std::sqrt(0.15), 0.5, 0.5 + std::sqrt(0.15) };
  const double weights[3] = { 5 / 18.0, 8 / 18.0, 5 / 18.0 };
  double sum = 0;
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      for (int k = 0; k < 3; ++k)
      {
        sum += weights[i] * weights[j] * weights[k] *
               jacobianAt(cell, { points[i], points[j], points[k] });
      }
    }
  }
  return sum;
}

template<class Cell>
Cell mapped(Cell cell, const std::function<Point3(const Point3&)>& map)
{
  std::transform(cell.begin(), cell.end(), cell.begin(), map);
  return cell;
}

template<class Cell>
Cell scaled(const Cell& cell, const Vector3& factors)
{
  return mapped(cell,
    [&](const Point3& p) {
      return Point3{ factors[0] * p[0], factors[1] * p[1], factors[2] * p[2] };
    });
}

template<class Cell>
Cell mirrored(const Cell& cell)
{
  return scaled(cell, { -1, 1, 1 });
}

/// With the corners at z = 1 mapped in the plane by (x, y) -> (a x + b y, c x + d y). On the axis
/// the determinant is that of (1 - z) I + z (a b; c d), and so over all of the cell.
template<class Cell>
Cell withTop(Cell cell, const std::array<double, 4>& map)
{
  for (Point3& p : cell)
  {
    if (p[2] == 1)
    {
      p = { map[0] * p[0] + map[1] * p[1], map[2] * p[0] + map[3] * p[1], 1 };
    }
  }
  return cell;
}

inline std::array<double, 4> rotation(double degrees)
{
  const double angle = degrees * pi / 180;
  return { std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle) };
}

template<class Cell>
Cell withRandomCorners(Cell cell, double size, std::mt19937& random)
{
  std::uniform_real_distribution<double> offset(-size, size);
  for (Point3& corner : cell)
  {
    corner = corner + Vector3{ offset(random), offset(random), offset(random) };
  }
  return cell;
}

} // namespace cadtest
