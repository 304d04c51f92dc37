// Where vertices go that are not at their places on the CAD yet.
#pragma once

#include <cadrefine/classification/BoundaryProjector.h>
#include <cadrefine/classification/Classification.h>
#include <cadrefine/motion/MoveGuard.h>

namespace cadrefine
{

/// The place on the CAD of a classified vertex that stopped at `point` on its way there: the
/// nearest point of its entity or, if that is on its border, where other mesh edges may be, the
/// place that it had.
ClosestPoint placeToReach(Index vertex, const Point3& point, const BoundaryProjector& projector,
  const Classification& classification);

/// The moves of all vertices that are not at their places on the CAD to these places, which are
/// found anew (see placeToReach). Work: that of nearestOn for each.
Moves movesOntoCAD(
  const Mesh& mesh, const BoundaryProjector& projector, Classification& classification);

} // namespace cadrefine
