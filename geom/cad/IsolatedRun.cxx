// 1. Fork. The child silences itself, limits its time and memory, works, and writes one letter
//    (+ done, - an error, m out of memory), the length and the bytes (or the error's text) to a
//    pipe.
// 2. The parent reads the pipe until the answer is whole, and kills a child that stands still. An
// answer cut short
//    tells that the child died.
// The child leaves through _exit: it runs no handlers and flushes no buffers of the parent.

#include "IsolatedRun.h"

#include "Error.h"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <exception>
#include <fcntl.h>
#include <fstream>
#include <new>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace cadrefine
{
namespace
{

constexpr char done = '+';
constexpr char failed = '-';
constexpr char outOfMemory = 'm';
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

/// Address space of this process, in bytes; 0 where the system does not tell.
std::uint64_t addressSpace()
{
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

void limitMemory(std::uint64_t megabytes)
{
  rlimit memory{};
  const std::uint64_t now = addressSpace();
  if (megabytes > 0 && now > 0 && getrlimit(RLIMIT_AS, &memory) == 0)
  {
    const rlim_t most = now + (megabytes << 20U);
    memory.rlim_cur = memory.rlim_max == RLIM_INFINITY ? most : std::min(most, memory.rlim_max);
    setrlimit(RLIMIT_AS, &memory);
  }
}

void setUpChild(const RunLimits& limits)
{
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int signal : { SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGTERM })
  {
    std::signal(signal, SIG_DFL);
  }
  const rlimit noCore{ 0, 0 };
  setrlimit(RLIMIT_CORE, &noCore);
  const auto seconds = static_cast<rlim_t>(limits.cpuSeconds);
  const rlimit time{ seconds, seconds + 1 };
  setrlimit(RLIMIT_CPU, &time);
  limitMemory(limits.megabytes);
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
}

void answerError(int descriptor, const std::string& text)
{
  answer(descriptor, failed, text.data(), text.size());
}

[[noreturn]] void runChild(int descriptor, const std::string& context, const RunLimits& limits,
  const std::function<std::vector<char>()>& work)
{
  setUpChild(limits);
  try
  {
    const std::vector<char> result = work();
    answer(descriptor, done, result.data(), result.size());
  }
  catch (const Error& error)
  {
    answerError(descriptor, error.what());
  }
  catch (const std::bad_alloc&)
  {
    answer(descriptor, outOfMemory, nullptr, 0);
  }
  catch (const std::exception& error)
  {
    answerError(descriptor, context + ": the file is damaged: " + error.what());
  }
  catch (...)
  {
    _exit(1);
  }
  _exit(0);
}

/// Seconds of computing of a process that has not been waited for.
double cpuSecondsOf(pid_t process)
{
  clockid_t clock{};
  timespec time{};
  const bool known = clock_getcpuclockid(process, &clock) == 0 && clock_gettime(clock, &time) == 0;
  return known ? static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec) : 0;
}

/// Tells whether a process still computes, by looking at it once a second.
class IdleWatch
{
public:
  IdleWatch(pid_t process, int idleSeconds) : process_(process), most_(idleSeconds) {}

  /// To be called after a second without news; true where that makes too many of them.
  bool isIdle()
  {
    constexpr double little = 1e-3;
    const double now = cpuSecondsOf(process_);
    idle_ = now > last_ + little ? 0 : idle_ + 1;
    last_ = now;
    return idle_ >= most_;
  }

private:
  pid_t process_;
  int most_;
  int idle_ = 0;
  double last_ = 0;
};

bool isComplete(const std::vector<char>& bytes)
{
  std::uint64_t length = 0;
  if (bytes.size() >= headSize)
  {
    std::memcpy(&length, bytes.data() + 1, sizeof(length));
  }
  return bytes.size() >= headSize && bytes.size() - headSize == length;
}

struct Received
{
  std::vector<char> bytes;
  bool idle = false; ///< The child stood still, and was killed.
};

Received readAll(int descriptor, pid_t child, int idleSeconds)
{
  constexpr int oneSecond = 1000;
  IdleWatch watch(child, idleSeconds);
  Received received;
  std::vector<char> buffer(1 << 16);
  while (!isComplete(received.bytes))
  {
    pollfd waiting{ descriptor, POLLIN, 0 };
    if (poll(&waiting, 1, oneSecond) == 0)
    {
      received.idle = received.idle || watch.isIdle();
      if (received.idle)
      {
        kill(child, SIGKILL);
      }
      continue;
    }
    const ssize_t count = read(descriptor, buffer.data(), buffer.size());
    if (count == 0 || (count < 0 && errno != EINTR))
    {
      break;
    }
    received.bytes.insert(
      received.bytes.end(), buffer.begin(), buffer.begin() + (count > 0 ? count : 0));
  }
  return received;
}

std::string causeOf(int status, const RunLimits& limits, bool idle)
{
  if (idle)
  {
    return "reading it stands still";
  }
  if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL))
  {
    return "Open CASCADE came to no end within " + std::to_string(limits.cpuSeconds) + " s";
  }
  return WIFSIGNALED(status)
           ? "Open CASCADE crashes on it (signal " + std::to_string(WTERMSIG(status)) + ")"
           : "Open CASCADE fails on it";
}

} // namespace

std::vector<char> runIsolated(const std::string& context, const RunLimits& limits,
  const std::function<std::vector<char>()>& work)
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
    runChild(ends[1], context, limits, work);
  }
  const int forkError = errno;
  close(ends[1]);
  const Received received = child < 0 ? Received() : readAll(ends[0], child, limits.idleSeconds);
  close(ends[0]);
  if (child < 0)
  {
    throw Error(context + ": cannot be read: " + std::strerror(forkError));
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR)
  {
  }
  const std::vector<char>& bytes = received.bytes;
  if (!isComplete(bytes))
  {
    throw Error(context + ": the file is damaged: " + causeOf(status, limits, received.idle));
  }
  if (bytes.front() == outOfMemory)
  {
    throw Error(context + ": the file is damaged: reading it takes more than " +
                std::to_string(limits.megabytes) + " MiB of memory");
  }
  const auto payload = bytes.begin() + headSize;
  if (bytes.front() != done)
  {
    throw Error(std::string(payload, bytes.end()));
  }
  return { payload, bytes.end() };
}

} // namespace cadrefine
