// Index types of meshes.
#pragma once

#include <cstdint>

namespace cadrefine
{

/// Vertex, edge or cell of one rank's piece.
using Index = std::int32_t;

/// Vertex or cell of the whole mesh, the same on every rank.
using GlobalId = std::int64_t;

} // namespace cadrefine
