// Gaps between faces that were not sewn. Private to geom/cad.
#pragma once

#include <cadrefine/cad/extraction/ShapeIndex.h>
#include <cadrefine/cad/model/CADReport.h>

#include <vector>

namespace cadrefine
{

/// Finds the gaps between open edges (see CADReport::gaps). Compares each two open edges whose
/// boxes are near each other, at five points of the shorter one.
std::vector<Gap> findGaps(const ShapeIndex& index, double modelSize);

} // namespace cadrefine
