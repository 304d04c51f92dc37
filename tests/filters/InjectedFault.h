// A fault, wherever one candidates. A program that links this has an operator new of its own:
// nothing in what is tested has to know.
#pragma once

#include <cstdint>

namespace cadtest
{

enum class FaultKind
{
  Memory,     ///< std::bad_alloc
  Exception,  ///< std::runtime_error
  OpenCascade ///< An exception of Open CASCADE, which is no std::exception.
};

/// What the reason of such a fault has in it.
const char* traceOf(FaultKind kind);

/// Counts the allocations by operator new that one library makes while this lives, on all threads
/// and in programs that are started and call join(), and makes one of them throw. Those of other
/// libraries are left alone: VTK does not mend its objects after one. One at a time.
class InjectedFault
{
public:
  static constexpr std::int64_t none = INT64_MAX;

  /// @param inside any address in the library.
  /// @param number of the allocation, 0 is the next one; `none` only counts.
  InjectedFault(const void* inside, FaultKind kind, std::int64_t number);
  ~InjectedFault();
  InjectedFault(const InjectedFault&) = delete;
  InjectedFault& operator=(const InjectedFault&) = delete;

  /// In a program that is started: counts those that the library around `inside` makes here, too.
  static void join(const void* inside);

  /// Since construction of the last one.
  static std::int64_t allocations();

  /// Where the last one struck: not at all, on the thread that made it, on another thread, or in
  /// another process.
  enum class Place
  {
    Nowhere,
    OwnThread,
    OtherThread,
    OtherProcess
  };
  static Place place();
};

} // namespace cadtest
