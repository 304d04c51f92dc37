// What runIsolated and the program that it starts agree on. Private to geom/cad.
#pragma once

#include <cadrefine/cad/import/IsolatedRun.h>

#include <atomic>
#include <cstdint>
#include <sys/types.h>

namespace cadrefine
{

/// Descriptors of the program: a pipe for its answer, and the memory that holds a RunState.
constexpr int answerDescriptor = 3;
constexpr int stateDescriptor = 4;

/// What an answer begins with; its length and its bytes (or the error's text) follow.
enum class AnswerKind : char
{
  Done = '+',
  Failed = '-',   ///< The job ended with an Error.
  Excepted = 'x', ///< The job ended with another exception.
  OutOfMemory = 'm'
};
constexpr std::size_t answerHeadSize = 1 + sizeof(std::uint64_t);

/// What both processes see. The bytes for the job follow it.
struct RunState
{
  static constexpr std::uint64_t currentProtocol = 2;

  /// To be raised with any change to what is passed, so that no other program is taken.
  std::uint64_t protocol = currentProtocol;
  std::uint64_t inputSize = 0;
  RunLimits limits;
  pid_t parent = 0;
  std::atomic<bool> started{ false }; ///< Set by the program.
  std::atomic<std::uint64_t> steps{ 0 };
  std::atomic<RunPlace> place{ RunPlace() };

  const char* input() const { return reinterpret_cast<const char*>(this + 1); }
};
static_assert(std::atomic<RunPlace>::is_always_lock_free, "it is shared between processes");

} // namespace cadrefine
