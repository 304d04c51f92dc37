// How much one rank's piece of a mesh can hold.
#pragma once

#include <cadrefine/base/Error.h>
#include <cadrefine/base/MeshTypes.h>

#include <cstddef>
#include <limits>
#include <string>

namespace cadrefine
{

/// Vertices, edges or cells are counted by Index.
constexpr std::size_t mostOnOneRank = std::numeric_limits<Index>::max();

/// Throws Error where there are more of them (`what`, in the plural) than one rank can hold.
inline void requireAtMost(std::size_t count, const char* what, std::size_t most = mostOnOneRank)
{
  if (count > most)
  {
    throw Error("too many " + std::string(what) + " for one rank: " + std::to_string(count) +
                "; the limit is " + std::to_string(most) + ", use more ranks");
  }
}

} // namespace cadrefine
