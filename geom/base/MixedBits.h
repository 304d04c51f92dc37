// A hash that spreads whole numbers evenly, whatever their pattern.
#pragma once

#include <cstdint>

namespace cadrefine
{

/// A hash of a number: the finaliser of SplitMix64 (S. Vigna), which is one to one.
inline std::uint64_t mixedBits(std::uint64_t bits)
{
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9ULL;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebULL;
  return bits ^ (bits >> 31);
}

} // namespace cadrefine
