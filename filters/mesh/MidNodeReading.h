// Reading cells of second order.
#pragma once

#include "mesh/PointSetConversion.h"

#include <vtkType.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <vector>

namespace cadrefine
{

/// Number of shapes of cells, in the order in which visitShapes visits them.
constexpr int shapeCount = 8;

/// The points that the data set's cells of second order name for their mid nodes, by shape, in the
/// order of its edges.
using NodesOfCells = std::array<std::vector<vtkIdType>, shapeCount>;

/// Number of mid nodes of a cell of second order.
template<class Shape>
constexpr std::size_t nodesOf(Shape)
{
  if constexpr (Shape::dimension == 0)
  {
    return 0;
  }
  else
  {
    return std::size(Shape::edges);
  }
}

/// Writes the mid nodes of a cell of second order, given its points; VTK has those of a
/// tetrahedron in another order.
template<class Shape, class Point>
void writeNodes(Shape, const Point* points, vtkIdType* nodes)
{
  const Point* first = points + Shape::corners;
  if constexpr (Shape::dimension == 3 && isSimplex(Shape{}))
  {
    constexpr int places[6] = { 0, 2, 3, 1, 4, 5 };
    std::transform(
      std::begin(places), std::end(places), nodes, [&](int place) { return first[place]; });
  }
  else
  {
    std::copy_n(first, nodesOf(Shape{}), nodes);
  }
}

/// Whether the cells that were read are of second order; throws Error on all ranks where some are
/// and others not. Collective; two reductions.
bool isOfSecondOrder(
  RankExchange& exchange, const ConvertedMesh& converted, const NodesOfCells& nodes);

/// Gives the mesh the mid nodes of its edges, and appends their points to pointOf, given the points
/// and ids of the data set. Throws Error where cells of this rank do not agree on a node's place.
void readMidNodes(const std::vector<Point3>& points, const std::vector<GlobalId>& ids,
  const NodesOfCells& nodes, ConvertedMesh& mesh);

} // namespace cadrefine
