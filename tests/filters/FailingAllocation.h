// An allocation that fails, wherever one wishes. A program that links this has an operator new of
// its own: nothing in what is tested has to know. It must not export its symbols (NoExports.map),
// or shared libraries would use them, too: VTK's objects are broken after an allocation that
// failed.
#pragma once

#include <cstdint>

namespace cadtest
{

/// Counts the allocations by operator new that the program's own code makes while it lives, and
/// makes one of them throw std::bad_alloc. Allocations within shared libraries are left alone: VTK
/// does not mend its objects after one. One at a time.
class FailingAllocation
{
public:
  static constexpr std::int64_t none = INT64_MAX;

  /// @param number 0 is the next one; `none` only counts.
  explicit FailingAllocation(std::int64_t number);
  ~FailingAllocation();
  FailingAllocation(const FailingAllocation&) = delete;
  FailingAllocation& operator=(const FailingAllocation&) = delete;

  /// Since construction.
  static std::int64_t count();
};

} // namespace cadtest
