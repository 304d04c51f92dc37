// Moving a vertex to where its worst cell is better.
#pragma once

#include <cadrefine/classification/BoundaryProjector.h>
#include <cadrefine/operations/EditableMesh.h>

namespace cadrefine
{

/// Moves a vertex that is not on the CAD by a few steps of Newton's method (see ShapeEnergy), each
/// halved until the worst of these cells, which are all that are to be at it, gets better and none
/// becomes invalid: in space, or in the plane of a planar mesh.
void relocate(EditableMesh& mesh, Index vertex, const Cells<4>& cells);
void relocate(EditableMesh& mesh, Index vertex, const Cells<3>& cells);

/// Moves a vertex on the CAD as `relocate` does, along its CAD face or edge, which it does not
/// leave. Work: some 3 projections a step.
void relocateOnCAD(
  EditableMesh& mesh, Index vertex, const Cells<4>& cells, const BoundaryProjector& projector);
void relocateOnCAD(
  EditableMesh& mesh, Index vertex, const Cells<3>& cells, const BoundaryProjector& projector);

} // namespace cadrefine
