// 1. Fork. The child silences itself, limits its time, works, and writes one letter (+ done, - an
//    error), the length and the bytes (or the error's text) to a pipe.
// 2. The parent reads the pipe to its end. An answer cut short tells that the child died.
// The child leaves through _exit: it runs no handlers and flushes no buffers of the parent.

#include "IsolatedRun.h"

#include "Error.h"

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <exception>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace cadrefine
{
namespace
{

constexpr char done = '+';
constexpr char failed = '-';
constexpr std::size_t headSize = 1 + sizeof(std::uint64_t);

void writeAll(int descriptor, const char* data, std::size_t size)
{
  while (size > 0)
  {
    const ssize_t written = write(descriptor, data, size);
    if (written < 0 && errno != EINTR)
    {
      _exit(1);
    }
    data += written > 0 ? written : 0;
    size -= written > 0 ? static_cast<std::size_t>(written) : 0;
  }
}

void answer(int descriptor, char kind, const char* data, std::size_t size)
{
  char head[headSize] = { kind };
  const std::uint64_t length = size;
  std::memcpy(head + 1, &length, sizeof(length));
  writeAll(descriptor, head, headSize);
  writeAll(descriptor, data, size);
}

void setUpChild(int cpuSeconds)
{
  for (const int signal : { SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGTERM })
  {
    std::signal(signal, SIG_DFL);
  }
  const rlimit noCore{ 0, 0 };
  setrlimit(RLIMIT_CORE, &noCore);
  const auto seconds = static_cast<rlim_t>(cpuSeconds);
  const rlimit time{ seconds, seconds + 1 };
  setrlimit(RLIMIT_CPU, &time);
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
}

[[noreturn]] void runChild(
  int descriptor, int cpuSeconds, const std::function<std::vector<char>()>& work)
{
  setUpChild(cpuSeconds);
  try
  {
    const std::vector<char> result = work();
    answer(descriptor, done, result.data(), result.size());
  }
  catch (const std::exception& error)
  {
    answer(descriptor, failed, error.what(), std::strlen(error.what()));
  }
  catch (...)
  {
    _exit(1);
  }
  _exit(0);
}

std::vector<char> readAll(int descriptor)
{
  std::vector<char> bytes;
  std::vector<char> buffer(1 << 16);
  for (;;)
  {
    const ssize_t count = read(descriptor, buffer.data(), buffer.size());
    if (count == 0 || (count < 0 && errno != EINTR))
    {
      return bytes;
    }
    bytes.insert(bytes.end(), buffer.begin(), buffer.begin() + (count > 0 ? count : 0));
  }
}

std::string causeOf(int status, int cpuSeconds)
{
  if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL))
  {
    return "Open CASCADE came to no end within " + std::to_string(cpuSeconds) + " s";
  }
  return WIFSIGNALED(status)
           ? "Open CASCADE crashes on it (signal " + std::to_string(WTERMSIG(status)) + ")"
           : "Open CASCADE fails on it";
}

} // namespace

std::vector<char> runIsolated(
  const std::string& context, int cpuSeconds, const std::function<std::vector<char>()>& work)
{
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
  {
    throw Error(context + ": cannot be read: " + std::strerror(errno));
  }
  const pid_t child = fork();
  if (child == 0)
  {
    close(ends[0]);
    runChild(ends[1], cpuSeconds, work);
  }
  const int forkError = errno;
  close(ends[1]);
  const std::vector<char> bytes = child < 0 ? std::vector<char>() : readAll(ends[0]);
  close(ends[0]);
  if (child < 0)
  {
    throw Error(context + ": cannot be read: " + std::strerror(forkError));
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR)
  {
  }
  std::uint64_t length = 0;
  if (bytes.size() >= headSize)
  {
    std::memcpy(&length, bytes.data() + 1, sizeof(length));
  }
  if (bytes.size() < headSize || bytes.size() - headSize != length)
  {
    throw Error(context + ": the file is damaged: " + causeOf(status, cpuSeconds));
  }
  const auto payload = bytes.begin() + headSize;
  if (bytes.front() != done)
  {
    throw Error(std::string(payload, bytes.end()));
  }
  return { payload, bytes.end() };
}

} // namespace cadrefine
