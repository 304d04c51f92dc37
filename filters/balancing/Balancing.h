// Spreading cells over ranks by the work that they will make.
#pragma once

#include "fields/ArrayDelivery.h"
#include "mesh/DistributedMesh.h"

#include <vtkSmartPointer.h>

#include <vector>

class vtkPointSet;

namespace cadrefine
{

/// Whether the cells lie well as they are: the ranks' sums of weights differ from the mean by no
/// more than redistribute would let them, and at most a quarter of the vertices are shared.
/// Collective; two reductions.
bool isBalanced(
  RankExchange& exchange, const DistributedMesh& mesh, const std::vector<std::int64_t>& weights);

struct Redistribution
{
  vtkSmartPointer<vtkPointSet> mesh;
  Delivery delivery; ///< What went where; it takes other arrays there in the same order.
};

/// A rank for each cell, in the order of makePointSet, given its weight, at least 1: ranks get
/// boxes of cells, about equal in weight (see partitionByWeight). Collective.
std::vector<int> ranksByWeight(
  RankExchange& exchange, const DistributedMesh& mesh, const std::vector<std::int64_t>& weights);

/// Sends the cells of `input`, which `mesh` was made from, with their arrays to these ranks, given
/// in the order of makePointSet. The result is an unstructured grid with the same arrays.
///
/// Every cell is sent once. vtkRedistributeDataSetFilter knows no weights, and loses cells in
/// silence where libexpat has the corrections of 2024 (Debian 12: 2.5.0-1+deb12u2): VTK 9.2 sends
/// data sets as XML that this library refuses (that of ParaView 5.13 does not).
///
/// Throws Error on all ranks where a part cannot be sent. Collective.
Redistribution redistribute(RankExchange& exchange, const DistributedMesh& mesh, vtkPointSet* input,
  const std::vector<int>& ranks);

} // namespace cadrefine
