// Which ranks cells are to be on, by the work that they will make.
#pragma once

#include "mesh/DistributedMesh.h"

#include <vector>

namespace cadrefine
{

/// Whether the cells lie well as they are: the ranks' sums of weights differ from the mean by no
/// more than redistribute would let them, and at most a quarter of the vertices are shared.
/// Collective; two reductions.
bool isBalanced(
  RankExchange& exchange, const DistributedMesh& mesh, const std::vector<std::int64_t>& weights);

/// A rank for each cell, in the order of makePointSet, given its weight, at least 1: ranks get
/// boxes of cells, about equal in weight (see partitionByWeight). Collective.
std::vector<int> ranksByWeight(
  RankExchange& exchange, const DistributedMesh& mesh, const std::vector<std::int64_t>& weights);

} // namespace cadrefine
