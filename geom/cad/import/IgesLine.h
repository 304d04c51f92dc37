// The columns of a line of an IGES file (fixed 80 column form). Private to geom/cad.
#pragma once

#include <cstddef>

namespace cadrefine
{

constexpr std::size_t igesLineColumns = 80;
constexpr std::size_t igesDataColumns = 64;   ///< Data columns of a parameter line.
constexpr std::size_t igesSectionColumn = 72; ///< Column in which the section's letter stands.

} // namespace cadrefine
