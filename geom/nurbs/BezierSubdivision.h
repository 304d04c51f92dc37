// Restriction of rational Bezier patches and curves to a part of their parameters.
#pragma once

#include <cadrefine/nurbs/ParameterRectangle.h>
#include <cadrefine/nurbs/PatchView.h>

#include <vector>

namespace cadrefine
{

/// Control points of the part of `patch` over `part` (local parameters), by blossoming each row
/// and column (de Casteljau, stable). O(degree^3).
std::vector<ControlPoint> restrictPatch(const PatchView& patch, const ParameterRectangle& part);

} // namespace cadrefine
