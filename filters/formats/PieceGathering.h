// The pieces of a mesh, joined on one rank.
#pragma once

#include <vtkSmartPointer.h>

class vtkMultiProcessController;
class vtkPointSet;
class vtkUnstructuredGrid;

namespace cadrefine
{

/// The whole mesh on rank 0, null on the others: the pieces one after the other, without ghost
/// cells. Points that pieces share come once where they have no global ids, by their coordinates;
/// where they have, they are left to who knows these. Collective; throws Error where the ranks
/// could not exchange their pieces.
vtkSmartPointer<vtkUnstructuredGrid> gatherPieces(
  vtkMultiProcessController* controller, vtkPointSet* piece);

} // namespace cadrefine
