// Spreading cells over ranks by the work that they will make.
#pragma once

#include "DistributedMesh.h"

#include <vtkSmartPointer.h>

#include <vector>

class vtkPointSet;

namespace cadrefine
{

/// Redistributes the cells of `input`, which `mesh` was made from, with their arrays: ranks get
/// consecutive parts, equal in weight, of the cells in the order of a space-filling curve (Morton)
/// through their centres. One weight, at least 1, for each cell in the order of makePointSet. The
/// result is an unstructured grid with the same arrays, and does not depend on the partition but
/// for the order of its cells.
///
/// Largest over mean of the ranks' weights: 1 and one cell. Cost: a parallel sort of the cells (32
/// bytes a cell), and every cell is sent once. vtkRedistributeDataSetFilter would give rounder
/// parts, but knows no weights, and loses cells in silence where libexpat has the corrections of
/// 2024 (Debian 12: 2.5.0-1+deb12u2): VTK 9.2 sends data sets as XML that this library refuses.
///
/// Throws Error on all ranks where a part cannot be sent. Collective.
vtkSmartPointer<vtkPointSet> redistribute(RankExchange& exchange, const DistributedMesh& mesh,
  vtkPointSet* input, const std::vector<std::int64_t>& weights);

} // namespace cadrefine
