// Blocks of cells that lie together, the same however the mesh is split over ranks.
#pragma once

#include "comm/RankExchange.h"
#include "mesh/DistributedMesh.h"

#include <cstdint>
#include <vector>

namespace cadrefine
{

/// Blocks of points, numbered from 0 in the order of a Morton curve.
struct Blocks
{
  std::vector<std::int64_t> ofPoints; ///< The block of each of this rank's points.
  std::vector<std::int64_t> sizes;    ///< Number of points in each block, over all ranks.
};

/// Finds blocks as the leaves of an octree over the points of all ranks, in which octants with more
/// than `largest` points are divided. Where octants lie in `box`, which holds all points, depends
/// on `round`, so that the borders of one are inside those of the next. Collective; a reduction of
/// 8 bytes an octant for each level of the tree, of which there are at most 20.
Blocks findBlocks(RankExchange& exchange, const std::vector<Point3>& points, const BoundingBox& box,
  int round, std::int64_t largest);

} // namespace cadrefine
