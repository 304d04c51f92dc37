// The plane of a planar mesh.
#pragma once

#include "comm/RankExchange.h"

#include <cadrefine/mesh/Mesh.h>

namespace cadrefine
{

/// Unit normal of the coordinate plane in which all triangles and quadrilaterals lie, turned the
/// way most of them turn; zero where there is no such plane. Collective; two reductions of three
/// numbers, work linear in their number.
Vector3 planeNormal(RankExchange& exchange, const Mesh& mesh);

} // namespace cadrefine
