// Cells of serendipity shape functions, written out, and their Jacobians sampled.
#pragma once

#include <cadrefine/quadratic/CurvedCells.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace cadtest
{

using namespace cadrefine;

using Parameters = std::array<double, 3>;

/// Of the cube from -1 to 1, at the corner with these signs; a mid node has a 0 in its direction.
inline double serendipity(const Parameters& signs, const Parameters& at, int dimension)
{
  double product = 1;
  double sum = 0;
  int directions = 0;
  bool isMidNode = false;
  for (int k = 0; k < dimension; ++k)
  {
    isMidNode = isMidNode || signs[k] == 0;
    product *= signs[k] == 0 ? 1 - at[k] * at[k] : (1 + signs[k] * at[k]) / 2;
    sum += signs[k] * at[k];
    ++directions;
  }
  return isMidNode ? product : product * (sum - (directions - 1));
}

constexpr double signsOfHexahedron[8][3] = { { -1, -1, -1 }, { 1, -1, -1 }, { 1, 1, -1 },
  { -1, 1, -1 }, { -1, -1, 1 }, { 1, -1, 1 }, { 1, 1, 1 }, { -1, 1, 1 } };

template<class Shape>
Point3 inBox(Shape, const CurvedCell<Shape>& nodes, const Parameters& where)
{
  Parameters at;
  std::transform(where.begin(), where.end(), at.begin(), [](double u) { return 2 * u - 1; });
  Point3 result{};
  for (std::size_t n = 0; n < nodes.size(); ++n)
  {
    const bool isCorner = n < Shape::corners;
    const std::array<int, 2> ends =
      isCorner ? std::array<int, 2>{ static_cast<int>(n), static_cast<int>(n) }
               : std::array<int, 2>{ Shape::edges[n - Shape::corners][0],
                   Shape::edges[n - Shape::corners][1] };
    Parameters signs;
    for (int k = 0; k < 3; ++k)
    {
      signs[k] = (signsOfHexahedron[ends[0]][k] + signsOfHexahedron[ends[1]][k]) / 2;
    }
    result = result + serendipity(signs, at, Shape::dimension) * nodes[n];
  }
  return result;
}

inline Point3 mapAt(const CurvedHexahedron& nodes, const Parameters& where)
{
  return inBox(shapes::Hexahedron{}, nodes, where);
}

inline Point3 mapAt(const CurvedQuadrilateral& nodes, const Parameters& where)
{
  return inBox(shapes::Quadrilateral{}, nodes, where);
}

/// With t from -1 to 1: L_i (1 +- t) (2 L_i - 2 +- t) / 2, 2 L_i L_j (1 +- t), L_i (1 - t t).
inline Point3 mapAt(const CurvedWedge& nodes, const Parameters& where)
{
  const double l[3] = { 1 - where[0] - where[1], where[0], where[1] };
  const double t = 2 * where[2] - 1;
  Point3 result{};
  for (int k = 0; k < 3; ++k)
  {
    const int next = (k + 1) % 3;
    for (const int sign : { -1, 1 })
    {
      const int triangle = sign < 0 ? 0 : 3;
      const double along = 1 + sign * t;
      result = result + l[k] * along * (2 * l[k] - 2 + sign * t) / 2 * nodes[triangle + k] +
               2 * l[k] * l[next] * along * nodes[6 + triangle + k];
    }
    result = result + l[k] * (1 - t * t) * nodes[12 + k];
  }
  return result;
}

/// The differences are exact: the maps are of degree 2 in each parameter.
template<class Nodes>
std::array<Vector3, 3> derivativesAt(const Nodes& nodes, const Parameters& where)
{
  std::array<Vector3, 3> result;
  for (int k = 0; k < 3; ++k)
  {
    Parameters before = where;
    Parameters after = where;
    before[k] -= 0.5;
    after[k] += 0.5;
    result[k] = mapAt(nodes, after) - mapAt(nodes, before);
  }
  return result;
}

template<class Nodes>
double jacobianAt(const Nodes& nodes, const Parameters& where)
{
  const auto d = derivativesAt(nodes, where);
  return dot(d[0], cross(d[1], d[2]));
}

inline double jacobianAt(const CurvedQuadrilateral& nodes, const Parameters& where)
{
  const auto d = derivativesAt(nodes, where);
  return cross(d[0], d[1])[2];
}

constexpr bool isTriangular(shapes::Wedge)
{
  return true;
}

template<class Shape>
constexpr bool isTriangular(Shape)
{
  return false;
}

/// Calls use(parameters) at the points of a lattice on the cell.
template<class Shape, class Use>
void forEachPlace(Shape shape, int n, const Use& use)
{
  for (int i = 0; i <= n; ++i)
  {
    for (int j = 0; (isTriangular(shape) ? i + j : j) <= n; ++j)
    {
      for (int k = 0; k <= (Shape::dimension == 3 ? n : 0); ++k)
      {
        use({ static_cast<double>(i) / n, static_cast<double>(j) / n, static_cast<double>(k) / n });
      }
    }
  }
}

template<class Shape>
double smallestSample(Shape shape, const CurvedCell<Shape>& nodes, int n)
{
  double smallest = std::numeric_limits<double>::infinity();
  forEachPlace(shape, n,
    [&](const Parameters& where) { smallest = std::min(smallest, jacobianAt(nodes, where)); });
  return smallest;
}

} // namespace cadtest
