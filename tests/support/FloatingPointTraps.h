// Floating point exceptions of our own code.
#pragma once

#include <string>
#include <vector>

namespace cadtest
{

/// Notes invalid operations, divisions by zero and overflows while it lives, on this thread, and on
/// threads and in processes that are forked meanwhile. Work goes on as without. One lives
/// at a time.
///
/// Noted are instructions of the program and of shared libraries whose path holds `ours`, and those
/// of libc and libm that these call. All other libraries (Open CASCADE, VTK, MPI) may raise what
/// they like. x86-64 with Linux only, and not the old instructions for long double.
class FloatingPointTraps
{
public:
  explicit FloatingPointTraps(const char* ours);
  ~FloatingPointTraps();
  FloatingPointTraps(const FloatingPointTraps&) = delete;
  FloatingPointTraps& operator=(const FloatingPointTraps&) = delete;

  /// What was noted since the last call: for each instruction (64 at most) the exception, how
  /// often, and the calls that led there at first, as program(+offset): see addr2line -Cfie.
  std::vector<std::string> takeFindings();
};

} // namespace cadtest
