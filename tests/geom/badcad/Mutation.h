// Damages the text of CAD files as disks, transfers and careless writers do, and worse.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace badcad
{

/// `text` with one to four random damages; a pure function of the text and the seed:
/// a number replaced by an odd one (nan, 1e300, 0, -1, 2147483648, ...), scaled or swapped with
/// another; a byte changed, lost or added; the end cut off; a line lost, doubled or swapped with
/// another; a block copied over another; garbage.
std::string mutate(const std::string& text, std::uint64_t seed);

/// So many random bytes.
std::string garbage(std::size_t size, std::uint64_t seed);

} // namespace badcad
