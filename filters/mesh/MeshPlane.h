// The plane of a planar mesh.
#pragma once

#include "comm/RankExchange.h"

#include <cadrefine/mesh/Mesh.h>

namespace cadrefine
{

/// Unit normal of the coordinate plane in which all cells of a mesh of area lie, turned the way
/// most of them turn; zero where there is no such plane, and of other meshes. Collective; two
/// reductions of three numbers, work linear in the cells.
Vector3 planeNormal(RankExchange& exchange, const Mesh& mesh);

} // namespace cadrefine
