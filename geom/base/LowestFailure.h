// Which of its exceptions a loop on threads throws.
#pragma once

#include <cstddef>
#include <exception>
#include <mutex>

namespace cadrefine
{

/// The exception of the lowest range that threw one, which does not depend on the threads.
class LowestFailure
{
public:
  /// Keeps the exception that is being handled, of the range that begins at `begin`.
  void keep(std::size_t begin)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!exception_ || begin < begin_)
    {
      begin_ = begin;
      exception_ = std::current_exception();
    }
  }

  void rethrow() const
  {
    if (exception_)
    {
      std::rethrow_exception(exception_);
    }
  }

private:
  std::mutex mutex_;
  std::size_t begin_ = 0;
  std::exception_ptr exception_;
};

} // namespace cadrefine
