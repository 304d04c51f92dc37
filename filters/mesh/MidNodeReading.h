// Reading cells of second order.
#pragma once

#include "mesh/PointSetConversion.h"

#include <vtkType.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace cadrefine
{

/// The points that the data set's cells of second order name for their mid nodes, by dimension, in
/// the order of triangleEdges and tetrahedronEdges.
using NodesOfCells = std::array<std::vector<vtkIdType>, 4>;

/// Mid nodes of a cell of second order.
constexpr std::size_t nodesOf(int dimension)
{
  return dimension * (dimension + 1) / 2;
}

/// Writes the mid nodes of a cell of second order, given its points; VTK has those of a
/// tetrahedron in another order.
template<class Point>
void writeNodes(int dimension, const Point* points, vtkIdType* nodes)
{
  constexpr int places[4][6] = { {}, { 2 }, { 3, 4, 5 }, { 4, 6, 7, 5, 8, 9 } };
  std::transform(places[dimension], places[dimension] + nodesOf(dimension), nodes,
    [&](int place) { return points[place]; });
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
