// Whether the numbers of a model can be computed with.
#pragma once

#include "NurbsModel.h"

namespace cadrefine
{

/// Coordinates beyond this, in any unit, are damage: products of six of them, as they occur in the
/// derivatives of squared distances, must not overflow.
constexpr double largestCoordinate = 1e50;

/// Throws Error, which names the entity, where a degree is above maximumDegree; control points do
/// not fit it, are not finite, or of a weight that is not positive; or a coordinate, a weight or
/// its inverse is above largestCoordinate. Work: one look at each number.
void checkModel(const NurbsModel& model);

} // namespace cadrefine
