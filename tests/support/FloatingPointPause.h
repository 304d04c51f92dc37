// Floating point exceptions that a test means to raise.
#pragma once

#include <cfenv>

namespace cadtest
{

/// While it lives, this thread may raise what it likes: for tests of numbers that are not finite or
/// of products that are too large.
class FloatingPointPause
{
public:
  FloatingPointPause() { std::feholdexcept(&before_); }
  ~FloatingPointPause() { std::fesetenv(&before_); }
  FloatingPointPause(const FloatingPointPause&) = delete;
  FloatingPointPause& operator=(const FloatingPointPause&) = delete;

private:
  std::fenv_t before_{};
};

} // namespace cadtest
