// 1. Fork. The child silences itself, limits its time and memory, works, and writes one letter
//    (+ done, - an Error, x another exception, m out of memory), the length and the bytes (or the
//    error's text) to a pipe.
// 2. The child counts its steps, and notes its place, in memory that the parent sees.
// 3. The parent reads the pipe until the answer is whole, and kills a child that stands still or
//    takes too long for a step. An answer cut short tells that the child died.
// The child leaves through _exit: it runs no handlers and flushes no buffers of the parent.

#include <cadrefine/cad/import/IsolatedRun.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <exception>
#include <fcntl.h>
#include <fstream>
#include <new>
#include <poll.h>
#include <sys/mman.h>
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
constexpr char excepted = 'x';
constexpr char outOfMemory = 'm';
constexpr std::size_t headSize = 1 + sizeof(std::uint64_t);

/// What the parent sees of its child.
struct RunState
{
  std::atomic<std::uint64_t> steps{ 0 };
  std::atomic<RunPlace> place{ RunPlace() };
};
static_assert(std::atomic<RunPlace>::is_always_lock_free, "it is shared between processes");

/// A RunState that this process and the children that it forks share.
class SharedState
{
public:
  SharedState()
    : memory_(
        mmap(nullptr, sizeof(RunState), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0))
  {
    state_ = memory_ == MAP_FAILED ? nullptr : new (memory_) RunState;
  }
  SharedState(const SharedState&) = delete;
  SharedState& operator=(const SharedState&) = delete;
  ~SharedState()
  {
    if (state_ != nullptr)
    {
      munmap(memory_, sizeof(RunState));
    }
  }

  /// Null where the system gives no such memory.
  RunState* get() const { return state_; }

private:
  void* memory_;
  RunState* state_ = nullptr;
};

/// Of the child; null in other processes.
RunState* runState = nullptr;

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

void answerText(int descriptor, char kind, const std::string& text)
{
  answer(descriptor, kind, text.data(), text.size());
}

[[noreturn]] void runChild(
  int descriptor, const RunLimits& limits, const std::function<std::vector<char>()>& work)
{
  setUpChild(limits);
  try
  {
    const std::vector<char> result = work();
    answer(descriptor, done, result.data(), result.size());
  }
  catch (const Error& error)
  {
    answerText(descriptor, failed, error.what());
  }
  catch (const std::bad_alloc&)
  {
    answer(descriptor, outOfMemory, nullptr, 0);
  }
  catch (const std::exception& error)
  {
    answerText(descriptor, excepted, error.what());
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

/// Tells whether a process still computes and comes on, by looking at it once a second.
class Watch
{
public:
  Watch(pid_t process, const RunLimits& limits, const RunState& state)
    : process_(process), limits_(limits), state_(state)
  {
  }

  /// To be called after a second without news. Why the process is to be ended; "" where it is not.
  std::string look()
  {
    constexpr double little = 1e-3;
    const double now = cpuSecondsOf(process_);
    idle_ = now > last_ + little ? 0 : idle_ + 1;
    last_ = now;
    const std::uint64_t steps = state_.steps;
    const bool sameStep = steps == lastSteps_;
    stepStart_ = sameStep ? stepStart_ : now;
    stepClock_ = sameStep ? stepClock_ + 1 : 0;
    lastSteps_ = steps;
    if (idle_ >= limits_.idleSeconds)
    {
      return "reading it stands still";
    }
    return limits_.stepSeconds > 0 && std::min(now - stepStart_, stepClock_) > limits_.stepSeconds
             ? "one step did not finish within " + std::to_string(limits_.stepSeconds) + " s"
             : "";
  }

private:
  pid_t process_;
  const RunLimits& limits_;
  const RunState& state_;
  int idle_ = 0;
  double last_ = 0;
  double stepStart_ = 0; ///< When a new count was seen first, which is late by a second at most.
  double stepClock_ = 0; ///< Seconds since then.
  std::uint64_t lastSteps_ = 0;
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
  std::string cause; ///< Why the child was killed; "" where it was not.
};

Received readAll(int descriptor, pid_t child, Watch watch)
{
  constexpr int oneSecond = 1000;
  Received received;
  std::vector<char> buffer(1 << 16);
  while (!isComplete(received.bytes))
  {
    pollfd waiting{ descriptor, POLLIN, 0 };
    const int ready = poll(&waiting, 1, oneSecond);
    if (ready < 0 && errno == EINTR)
    {
      continue;
    }
    if (ready == 0)
    {
      received.cause = received.cause.empty() ? watch.look() : received.cause;
      if (!received.cause.empty())
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

/// How a child has ended that gave no answer.
struct End
{
  int signal = 0;        ///< 0: of its own.
  double cpuSeconds = 0; ///< Of computing.
};

End awaitEnd(pid_t child)
{
  int status = 0;
  rusage usage{};
  while (wait4(child, &status, 0, &usage) < 0 && errno == EINTR)
  {
  }
  const auto seconds = static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec);
  return { WIFSIGNALED(status) ? WTERMSIG(status) : 0, seconds };
}

bool wasKilledByOthers(const End& end, const RunLimits& limits)
{
  const bool byLimit = end.signal == SIGKILL && end.cpuSeconds + 1 > limits.cpuSeconds;
  return (end.signal == SIGKILL || end.signal == SIGTERM) && !byLimit;
}

std::string causeOf(const End& end, const RunLimits& limits)
{
  if (end.signal == SIGXCPU || end.signal == SIGKILL)
  {
    return "Open CASCADE did not finish within " + std::to_string(limits.cpuSeconds) + " s";
  }
  return end.signal > 0 ? "Open CASCADE crashes on it (signal " + std::to_string(end.signal) + ")"
                        : "Open CASCADE fails on it";
}

/// Why a run gave no answer: `cause`, if its child was killed for one.
std::string causeOf(
  const std::string& cause, const End& end, const RunLimits& limits, const std::string& context)
{
  if (cause.empty() && wasKilledByOthers(end, limits))
  {
    throw Error(context + ": cannot be read: the process that reads it was killed (signal " +
                std::to_string(end.signal) + "), as systems do that run out of memory");
  }
  return cause.empty() ? causeOf(end, limits) : cause;
}

/// What a whole answer holds.
std::vector<char> openAnswer(const std::vector<char>& answer, const std::string& context,
  const RunLimits& limits, RunPlace place)
{
  const auto payload = answer.begin() + headSize;
  switch (answer.front())
  {
    case done:
      return { payload, answer.end() };
    case failed:
      throw Error(std::string(payload, answer.end()));
    case outOfMemory:
      throw RunFailure(context,
        "reading it takes more than " + std::to_string(limits.megabytes) + " MiB of memory", place);
    default:
      throw RunFailure(context, std::string(payload, answer.end()), place);
  }
}

} // namespace

void noteProgress()
{
  if (runState != nullptr)
  {
    ++runState->steps;
  }
}

void noteStep(int step, int item)
{
  if (runState != nullptr)
  {
    runState->place = { step, item };
    ++runState->steps;
  }
}

std::vector<char> runIsolated(const std::string& context, const RunLimits& limits,
  const std::function<std::vector<char>()>& work)
{
  const SharedState state;
  int ends[2];
  if (state.get() == nullptr || pipe2(ends, O_CLOEXEC) != 0)
  {
    throw Error(context + ": cannot be read: " + std::strerror(errno));
  }
  const pid_t child = fork();
  if (child == 0)
  {
    close(ends[0]);
    runState = state.get();
    runChild(ends[1], limits, work);
  }
  const int forkError = errno;
  close(ends[1]);
  const Received received =
    child < 0 ? Received() : readAll(ends[0], child, Watch(child, limits, *state.get()));
  close(ends[0]);
  if (child < 0)
  {
    throw Error(context + ": cannot be read: " + std::strerror(forkError));
  }
  const End end = awaitEnd(child);
  if (!isComplete(received.bytes))
  {
    throw RunFailure(context, causeOf(received.cause, end, limits, context), state.get()->place);
  }
  return openAnswer(received.bytes, context, limits, state.get()->place);
}

} // namespace cadrefine
