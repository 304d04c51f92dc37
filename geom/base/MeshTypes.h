// Index types of meshes.
#pragma once

#include <cstdint>

namespace cadrefine
{

/// Number of a vertex, edge or cell of one rank's piece.
using Index = std::int32_t;

/// Global id of a vertex or cell of the whole mesh, the same on every rank.
using GlobalId = std::int64_t;

} // namespace cadrefine
