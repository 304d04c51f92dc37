// The maps of cells of serendipity shape functions, in Bezier form.
#pragma once

#include <cadrefine/base/Vector3.h>
#include <cadrefine/mesh/Mesh.h>
#include <cadrefine/quadratic/BernsteinProduct.h>
#include <cadrefine/quadratic/CurvedCells.h>

#include <cstddef>

namespace cadrefine
{

template<int Degree>
using OnSegment = BernsteinSimplex<2, Degree>;
template<int Degree>
using OnTriangle = BernsteinSimplex<3, Degree>;

/// Where the Bezier points of serendipity cells are, and the degree of the determinant.
template<class Shape>
struct SerendipityMap;

template<>
struct SerendipityMap<shapes::Quadrilateral>
{
  using Basis = BernsteinProduct<OnSegment<2>, OnSegment<2>>;
  using Jacobian = BernsteinProduct<OnSegment<3>, OnSegment<3>>;
  static constexpr int quadrilaterals[1][4] = { { 0, 1, 2, 3 } };

  /// Place of the point halfway between those at two corners.
  static constexpr int placeBetween(int a, int b)
  {
    constexpr int places[4] = { 0, 6, 8, 2 };
    return (places[a] + places[b]) / 2;
  }
};

template<>
struct SerendipityMap<shapes::Hexahedron>
{
  using Basis = BernsteinProduct<OnSegment<2>, OnSegment<2>, OnSegment<2>>;
  using Jacobian = BernsteinProduct<OnSegment<5>, OnSegment<5>, OnSegment<5>>;
  static constexpr auto& quadrilaterals = shapes::Hexahedron::faces;

  static constexpr int placeBetween(int a, int b)
  {
    constexpr int places[8] = { 0, 18, 24, 6, 2, 20, 26, 8 };
    return (places[a] + places[b]) / 2;
  }
};

template<>
struct SerendipityMap<shapes::Wedge>
{
  using Basis = BernsteinProduct<OnTriangle<2>, OnSegment<2>>;
  using Jacobian = BernsteinProduct<OnTriangle<4>, OnSegment<5>>;
  static constexpr int quadrilaterals[3][4] = { { 0, 1, 4, 3 }, { 1, 2, 5, 4 }, { 2, 0, 3, 5 } };

  static constexpr int placeBetween(int a, int b)
  {
    constexpr int places[3][3] = { { 0, 1, 2 }, { 1, 3, 4 }, { 2, 4, 5 } };
    return 3 * places[a % 3][b % 3] + a / 3 + b / 3;
  }
};

template<class Shape>
using BezierPoints = BezierPolynomial<typename SerendipityMap<Shape>::Basis, Vector3>;

/// The Bezier points of a cell's map, less the first node; see jacobianOf.
template<class Shape>
BezierPoints<Shape> bezierPointsOf(Shape, const CurvedCell<Shape>& nodes)
{
  using Map = SerendipityMap<Shape>;
  BezierPoints<Shape> result;
  const auto at = [&](int a, int b) -> Vector3&
  { return result.coefficients[Map::placeBetween(a, b)]; };
  Vector3 sumOfCorners{};
  Vector3 sumOfEdges{};
  for (int c = 0; c < static_cast<int>(Shape::corners); ++c)
  {
    at(c, c) = nodes[c] - nodes[0];
    sumOfCorners = sumOfCorners + at(c, c);
  }
  std::size_t node = Shape::corners;
  for (const auto& [a, b] : Shape::edges)
  {
    at(a, b) = 2.0 * (nodes[node++] - nodes[0]) - 0.5 * (at(a, a) + at(b, b));
    sumOfEdges = sumOfEdges + at(a, b);
  }
  for (const auto& [a, b, c, d] : Map::quadrilaterals)
  {
    at(a, c) = 0.25 * (2.0 * (at(a, b) + at(b, c) + at(c, d) + at(d, a)) -
                        (at(a, a) + at(b, b) + at(c, c) + at(d, d)));
  }
  if constexpr (Shape::corners == 8)
  {
    at(0, 6) = 0.25 * (sumOfEdges - sumOfCorners);
  }
  return result;
}

} // namespace cadrefine
