// Spreading cells over ranks by the work that they will make.
#pragma once

#include "RankExchange.h"

#include <vtkSmartPointer.h>

#include <vector>

class vtkMultiProcessController;
class vtkPointSet;

namespace cadrefine
{

/// Redistributes the cells by a kd-tree over their centres, each counted as often as its weight
/// says (one weight a cell, at least 1): vtkRedistributeDataSetFilter makes the tree and moves the
/// cells with their arrays. Global ids must be set. Collective. Work and memory: 24 bytes for each
/// unit of weight while the tree is made; every cell that changes rank is sent once.
vtkSmartPointer<vtkPointSet> redistribute(
  vtkMultiProcessController* controller, vtkPointSet* input, const std::vector<int>& weights);

} // namespace cadrefine
