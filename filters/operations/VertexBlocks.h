// The block to which the cells at a vertex belong.
#pragma once

#include "mesh/DistributedMesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace cadrefine
{

/// In place of the block of a cell: the cell stays.
constexpr std::int64_t noBlock = -1;
/// In place of the block of a vertex: it stays, as its cells are not all of one block.
constexpr std::int64_t manyBlocks = -2;
/// In place of the block of a vertex: it stays, as it has cells that are not simplices.
constexpr std::int64_t besideOthers = -3;

/// For each vertex, the block to which all cells at it belong, on all ranks; negative if the vertex
/// stays: if some of these cells belong to no block, to another one or are not simplices, if there
/// are none, and if the vertex is listed. Collective; 8 bytes a shared vertex.
std::vector<std::int64_t> blocksOfVertices(
  RankExchange& exchange, const DistributedMesh& mesh, const std::vector<std::int64_t>& ofCells);

/// Makes vertices stay that have listed triangles or segments which are no sides of cells, such as
/// fins and beams on a solid. Each block is on one rank, with the listed cells at its vertices.
/// Collective; 8 bytes a shared vertex if there are any. Work: a look at each listed cell, and
/// where some are at blocks at each side of these, by the logarithm of their number.
void holdStrays(RankExchange& exchange, const DistributedMesh& mesh,
  const std::vector<std::int64_t>& ofCells, std::vector<std::int64_t>& ofVertices);

/// Sets vertices of cells that are not simplices to `besideOthers`, except those where a listed
/// segment of no block ends, on whatever rank. Collective; 16 bytes a shared vertex.
void markBesideOthers(
  RankExchange& exchange, const DistributedMesh& mesh, std::vector<std::int64_t>& ofVertices);

/// The block of a cell of lower dimension, that of any vertex that is within a block; else noBlock.
template<std::size_t Corners>
std::int64_t blockOf(
  const std::array<Index, Corners>& corners, const std::vector<std::int64_t>& ofVertices)
{
  for (const Index vertex : corners)
  {
    if (ofVertices[vertex] >= 0)
    {
      return ofVertices[vertex];
    }
  }
  return noBlock;
}

/// How many of a mesh's triangles are not cells of its own dimension.
std::size_t listedTriangles(const Mesh& mesh);

} // namespace cadrefine
