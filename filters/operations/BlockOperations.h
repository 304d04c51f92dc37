// Local operations on the cells of a mesh in pieces, block by block.
#pragma once

#include "classification/DistributedBoundary.h"
#include "mesh/DistributedMesh.h"
#include "operations/BlockMesh.h"
#include "operations/Blocks.h"

#include <cadrefine/base/ParallelFor.h>
#include <cadrefine/classification/Classification.h>
#include <cadrefine/operations/Operations.h>
#include <cadrefine/operations/SurfaceRule.h>
#include <cadrefine/refinement/RefinementTrace.h>

#include <cstdint>
#include <functional>
#include <vector>

namespace cadrefine
{

/// The cells that may be operated on, in blocks.
struct OperationBlocks
{
  /// The block of each cell of the mesh's own dimension; -1: the cell stays.
  std::vector<std::int64_t> ofCells;
  std::vector<std::int64_t> sizes; ///< Number of cells of each block, over all ranks.
};

/// How cells become blocks (see findBlocks).
struct BlockSettings
{
  int rings = 1; ///< Rings of cells round the vertices where something is to be done.
  int round = 0;
  std::int64_t largest = 0;             ///< Largest number of cells of a block.
  std::function<bool(Index)> mayChange; ///< Whether a cell of this number may change.
};

/// Finds the blocks of the cells round the flagged vertices. Collective; the messages of
/// findBlocks, and for each ring a byte a shared vertex.
OperationBlocks findOperationBlocks(RankExchange& exchange, const DistributedMesh& mesh,
  std::vector<unsigned char> flags, const BlockSettings& settings, const ParallelFor& parallelFor);

/// The rank that each cell, in the order of makePointSet, has to be on so that each block, with the
/// listed cells at its vertices, is on the rank that has most of it; empty on all ranks if it is
/// already. Collective; a reduction of 8 bytes a block.
std::vector<int> ranksOfBlocks(
  RankExchange& exchange, const DistributedMesh& mesh, const OperationBlocks& blocks);

/// What is done with the cells of a block: a function of these alone, called on several threads.
using BlockWork = std::function<OperationResult(BlockMesh&, const SurfaceRule&)>;

/// What operateOnBlocks is to do.
struct OperationTask
{
  const OperationBlocks& blocks;     ///< Blocks, each on one rank: see ranksOfBlocks.
  const std::vector<Point3>& wanted; ///< Where the vertices are wanted; they need not be there.
  const CellLabels& labels;
  const BlockWork& work;
  CellRowKinds rows = {};
};

/// What operations made of a mesh, as if it had been refined (though some cells have no children)
/// and had then lost the vertices that are not kept. Without operations the mesh is as it was, and
/// all but the seconds is empty.
struct OperationTrace
{
  RefinementTrace cells;
  std::vector<unsigned char> onBoundary; ///< 1 for each new vertex on the boundary.
  std::vector<Index> keptVertices;       ///< Those of the old and the new vertices that are left.
  std::int64_t operations = 0;           ///< Number of operations, over all ranks.
  double seconds = 0; ///< Time of the task's work on this rank, of all threads together.
};

/// Works on the cells of each block (see improveCells), with the vertices that it shares with
/// others, or with cells that stay, in place. New vertices on the CAD are given their distance from
/// it. New cells have ids in the order of their parents', new vertices by the order of the blocks:
/// all is the same on any number of ranks. Collective; messages: 16 bytes a shared vertex, one
/// reduction of 8 bytes a block, the numbering of cells (see denseOffsets) and, where a rank has no
/// cell at a shared vertex any more, findSharedVertices of those that were shared. Work beside that
/// of the task: that of findFieldRows.
OperationTrace operateOnBlocks(RankExchange& exchange, DistributedMesh& mesh,
  Classification& classification, const ClassifiedBoundary& boundary, const OperationTask& task,
  const ParallelFor& parallelFor);

} // namespace cadrefine
