// Values at the new places of vertices that moved inside the mesh.
#pragma once

#include "comm/RankExchange.h"
#include "fields/ArrayTransfer.h"
#include "mesh/DistributedMesh.h"

#include <cadrefine/base/WeightedRows.h>

#include <optional>
#include <vector>

namespace cadrefine
{

/// How vertices that moved inside the mesh get the values that were at their new places.
struct VertexInterpolation
{
  WeightedRows rows; ///< For the vertices that moved to where this rank had a cell.
  /// Ranks to which values of shared vertices go, and from which they come, with the vertices.
  std::vector<int> neighbours;
  std::vector<std::vector<Index>> sent;
  std::vector<std::vector<Index>> received;
};

/// Interpolates by the shape functions of the cells as they were `before` (points of all vertices).
/// For each vertex, that cell round it counts which contains its new place; of several the one with
/// the smallest id, and where there is none, the nearest, from which values are extrapolated. (VTK
/// inverts the functions of wedges and pyramids to 1e-7.) `moved`: ascending, shared ones on all
/// ranks that have them; none on any rank: there is nothing to interpolate. Collective. Work: one
/// look at each cell, and one inversion of the shape functions (VTK's) for each cell at a vertex
/// that moved. Messages: 24 bytes a shared vertex. Memory: 8 bytes a vertex that moved, and 12 for
/// each corner of its cell.
std::optional<VertexInterpolation> interpolationOf(RankExchange& exchange,
  const DistributedMesh& mesh, const std::vector<Point3>& before, const std::vector<Index>& moved);

/// The arrays with these values, where they are of floating point: within the values of the cell's
/// corners. Collective; messages: the values that are sent.
MeshArrays withInterpolation(
  RankExchange& exchange, const MeshArrays& arrays, const VertexInterpolation& interpolation);

} // namespace cadrefine
