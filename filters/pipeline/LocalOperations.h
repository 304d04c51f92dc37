// One round of local operations on a mesh and all that belongs to it.
#pragma once

#include "operations/BlockOperations.h"
#include "pipeline/MeshState.h"

#include <cstdint>
#include <vector>

namespace cadrefine
{

/// Finds which tags number the cells, if that is not known. To be called before the first cell
/// changes. See findNumberings of fields/CellTags.h. Collective.
void findNumberings(RankExchange& exchange, MeshState& state);

/// Hashes of the tags of the cells of the mesh's own dimension (see tagHashesOf); none where no
/// rank has tags. Collective.
std::vector<std::uint64_t> tagsOfCells(RankExchange& exchange, MeshState& state);

/// Does `work` with blocks of the cells round flagged vertices (1; see findOperationBlocks), which
/// are brought to one rank each, and takes arrays and classification along. Cells and listed
/// triangles are told apart by their tags (see labelsOf). The mesh must be classified. Returns the
/// number of operations over all ranks. Collective. Work and messages: those of findBlocks,
/// redistribute where a block is on several ranks, findClassifiedBoundary of the facets at the
/// blocks, and operateOnBlocks.
std::int64_t operateOnMesh(const PipelineContext& context, MeshState& state,
  const std::vector<unsigned char>& flags, const BlockSettings& settings, const BlockWork& work);

} // namespace cadrefine
