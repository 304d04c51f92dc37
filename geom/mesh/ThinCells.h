// Cells that are thin in one direction, as those of a boundary layer are across it, or long in one.
#pragma once

#include <cadrefine/mesh/CellState.h>
#include <cadrefine/mesh/Mesh.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>

namespace cadrefine
{

/// The direction in which a cell is less than half as long as in each other one, given for each the
/// mean of the squared lengths of its edges; -1: none.
template<std::size_t Directions>
int thinDirection(const std::array<double, Directions>& meanSquares)
{
  constexpr double thin = 4; // squares
  const auto least = std::min_element(meanSquares.begin(), meanSquares.end());
  for (auto other = meanSquares.begin(); other != meanSquares.end(); ++other)
  {
    if (other != least && thin * *least >= *other)
    {
      return -1;
    }
  }
  return static_cast<int>(least - meanSquares.begin());
}

/// The direction in which a cell is more than twice as long as in each other one; -1: none.
template<std::size_t Directions>
int longDirection(std::array<double, Directions> meanSquares)
{
  std::transform(meanSquares.begin(), meanSquares.end(), meanSquares.begin(),
    [](double square) { return 1 / square; });
  return thinDirection(meanSquares);
}

/// The mean of the squared lengths of some of a cell's edges.
template<class Shape, std::size_t Count>
double meanSquare(Shape, const std::array<Point3, Shape::corners>& p, const int (&edges)[Count])
{
  double sum = 0;
  for (const int edge : edges)
  {
    const auto& [a, b] = Shape::edges[edge];
    sum += squaredNorm(p[b] - p[a]);
  }
  return sum / static_cast<double>(Count);
}

/// Whether a cell is thin in one direction: a hexahedron or quadrilateral in any, a wedge from
/// triangle to triangle. No cell of another shape is.
template<class Shape>
bool isThin(Shape shape, const std::array<Point3, Shape::corners>& p)
{
  if constexpr (Shape::corners == shapes::Wedge::corners)
  {
    return thinDirection(std::array{
             meanSquare(shape, p, { 0, 1, 2, 3, 4, 5 }), meanSquare(shape, p, { 6, 7, 8 }) }) == 1;
  }
  else if constexpr (Shape::corners == shapes::Hexahedron::corners ||
                     (Shape::dimension == 2 && Shape::corners == 4))
  {
    std::array<double, std::size(Shape::directions)> meanSquares;
    std::transform(std::begin(Shape::directions), std::end(Shape::directions), meanSquares.begin(),
      [&](const auto& edges) { return meanSquare(shape, p, edges); });
    return thinDirection(meanSquares) >= 0;
  }
  return false;
}

} // namespace cadrefine
