// Whether the numbers of a model can be computed with.
#pragma once

#include <cadrefine/nurbs/NurbsModel.h>

#include <string>

namespace cadrefine
{

/// Coordinates beyond this, in any unit, are damage: products of six of them, as they occur in the
/// derivatives of squared distances, must not overflow.
constexpr double largestCoordinate = 1e50;

/// Why a face or edge cannot be computed with, for example "has a control point that is not
/// finite": a degree is above maximumDegree; control points do not fit it, are not finite, or of a
/// weight that is not positive; or a coordinate, a weight or its inverse is above
/// largestCoordinate. Empty: it can. Work: one look at each number.
std::string faultOf(const NurbsFace& face);
std::string faultOf(const NurbsEdge& edge);

/// Throws Error, which names the entity, where there is a fault.
void checkModel(const NurbsModel& model);

} // namespace cadrefine
