// 1. Start the program, with a pipe for its answer and memory that both see: the limits, the input
//    of its job, and the steps and the place that it notes.
// 2. Read the pipe until the answer is whole, and kill a process that stands still or takes too
//    long for a step. An answer cut short tells that it died.
// posix_spawn, since this process may have threads, MPI and a window, whose state a fork would copy
// and not keep whole.

#include <cadrefine/cad/import/IsolatedRun.h>

#include <cadrefine/cad/import/ReaderPath.h>
#include <cadrefine/cad/import/RunProtocol.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <fcntl.h>
#include <new>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace cadrefine
{
namespace
{

/// Closed at the end.
class Descriptor
{
public:
  /// Takes what a system call has returned, out of the way of the program's descriptors.
  explicit Descriptor(int given)
    : number_(given < 0 ? given : fcntl(given, F_DUPFD_CLOEXEC, stateDescriptor + 1))
  {
    closeOne(given);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { this->close(); }

  void close()
  {
    closeOne(number_);
    number_ = -1;
  }

  /// Negative where the system gave none.
  int get() const { return number_; }

private:
  static void closeOne(int number)
  {
    if (number >= 0)
    {
      ::close(number);
    }
  }

  int number_;
};

/// A RunState with its input, in memory that a process can be given.
class SharedState
{
public:
  SharedState(const RunLimits& limits, const std::vector<char>& input)
    : file_(memfd_create("cadrefine", MFD_CLOEXEC)), size_(sizeof(RunState) + input.size())
  {
    if (file_.get() < 0 || ftruncate(file_.get(), static_cast<off_t>(size_)) != 0)
    {
      return;
    }
    void* const memory = mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_SHARED, file_.get(), 0);
    if (memory == MAP_FAILED)
    {
      return;
    }
    state_ = new (memory) RunState;
    state_->limits = limits;
    state_->parent = getpid();
    state_->inputSize = input.size();
    std::copy(input.begin(), input.end(), static_cast<char*>(memory) + sizeof(RunState));
  }
  SharedState(const SharedState&) = delete;
  SharedState& operator=(const SharedState&) = delete;
  ~SharedState()
  {
    if (state_ != nullptr)
    {
      munmap(state_, size_);
    }
  }

  /// Null where the system gives no such memory.
  const RunState* get() const { return state_; }
  int descriptor() const { return file_.get(); }

private:
  Descriptor file_;
  std::size_t size_;
  RunState* state_ = nullptr;
};

/// Starts the program with these descriptors as its own, silent, and with signals as a new program
/// has them. Returns the error, 0 for none.
int startProgram(pid_t& process, const std::array<std::string, 3>& command, int answer, int state)
{
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, answer, answerDescriptor);
  posix_spawn_file_actions_adddup2(&files, state, stateDescriptor);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
  sigset_t none;
  sigset_t all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  std::array<char*, 4> arguments{};
  std::transform(command.begin(), command.end(), arguments.begin(),
    [](const std::string& word) { return const_cast<char*>(word.c_str()); });
  const int error =
    posix_spawn(&process, command[0].c_str(), &files, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  return error;
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

  /// Why the process is to be ended; "" where it is not. To be called after a second without news.
  std::string look(bool& lateStep)
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
      return "reading it makes no progress";
    }
    lateStep =
      limits_.stepSeconds > 0 && std::min(now - stepStart_, stepClock_) > limits_.stepSeconds;
    return lateStep ? "one step did not finish within " + std::to_string(limits_.stepSeconds) + " s"
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
  if (bytes.size() >= answerHeadSize)
  {
    std::memcpy(&length, bytes.data() + 1, sizeof(length));
  }
  return bytes.size() >= answerHeadSize && bytes.size() - answerHeadSize == length;
}

struct Received
{
  std::vector<char> bytes;
  std::string cause; ///< Why the process was killed; "" where it was not.
  bool lateStep = false;
};

Received readAll(int descriptor, pid_t process, Watch watch)
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
      received.cause = received.cause.empty() ? watch.look(received.lateStep) : received.cause;
      if (!received.cause.empty())
      {
        kill(process, SIGKILL);
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

/// How a process has ended that gave no answer.
struct End
{
  int signal = 0;        ///< 0: of its own.
  double cpuSeconds = 0; ///< Seconds of computing.
};

/// A process that was started, and is killed where nobody awaits its end.
class Child
{
public:
  explicit Child(pid_t process) : process_(process) {}
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child()
  {
    if (process_ > 0)
    {
      kill(process_, SIGKILL);
      awaitEnd();
    }
  }

  End awaitEnd()
  {
    int status = 0;
    rusage usage{};
    while (wait4(process_, &status, 0, &usage) < 0 && errno == EINTR)
    {
    }
    process_ = 0;
    const auto seconds =
      static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
      1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
    return { WIFSIGNALED(status) ? WTERMSIG(status) : 0, seconds };
  }

private:
  pid_t process_;
};

bool wasKilledByOthers(const End& end, const RunLimits& limits)
{
  const bool byLimit =
    end.signal == SIGKILL && limits.spentSeconds + end.cpuSeconds + 1 > limits.cpuSeconds;
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

[[noreturn]] void throwCannotBeRead(const std::string& context, const std::string& reason)
{
  throw Error(context + ": cannot be read: " + reason);
}

/// Why a run gave no answer: `cause`, if its process was killed for one.
std::string causeOf(
  const std::string& cause, const End& end, const RunLimits& limits, const std::string& context)
{
  if (cause.empty() && wasKilledByOthers(end, limits))
  {
    throwCannotBeRead(context, "the process that reads it was killed (signal " +
                                 std::to_string(end.signal) +
                                 "), probably because the system ran out of memory");
  }
  return cause.empty() ? causeOf(end, limits) : cause;
}

/// What a whole answer holds.
std::vector<char> openAnswer(const std::vector<char>& answer, const std::string& context,
  const RunLimits& limits, const RunEnd& end)
{
  const auto payload = answer.begin() + answerHeadSize;
  switch (static_cast<AnswerKind>(answer.front()))
  {
    case AnswerKind::Done:
      return { payload, answer.end() };
    case AnswerKind::Failed:
      throw Error(std::string(payload, answer.end()));
    case AnswerKind::OutOfMemory:
      throw RunFailure(context,
        "reading it takes more than " + std::to_string(limits.megabytes) + " MiB of memory", end);
    default:
      throw RunFailure(context, std::string(payload, answer.end()), end);
  }
}

} // namespace

std::vector<char> runIsolated(const std::string& job, const std::string& context,
  const RunLimits& limits, const std::vector<char>& input)
{
  const SharedState state(limits, input);
  int ends[2] = { -1, -1 };
  if (state.get() == nullptr || pipe2(ends, O_CLOEXEC) != 0)
  {
    throwCannotBeRead(context, std::strerror(errno));
  }
  const Descriptor from(ends[0]);
  Descriptor to(ends[1]);
  const std::string program = readerPath();
  pid_t process = 0;
  const int error = startProgram(process, { program, job, context }, to.get(), state.descriptor());
  if (error != 0)
  {
    throwCannotBeRead(context, "the program " + program + ": " + std::strerror(error) +
                                 " (set CADREFINE_READER to its path)");
  }
  Child child(process);
  to.close();
  const Received received = readAll(from.get(), process, Watch(process, limits, *state.get()));
  const End end = child.awaitEnd();
  if (!state.get()->started)
  {
    throwCannotBeRead(context,
      "the program " + program + " does not start, or belongs to another version of CADRefine");
  }
  const RunEnd reached{ state.get()->place, end.cpuSeconds, received.lateStep };
  if (!isComplete(received.bytes))
  {
    throw RunFailure(context, causeOf(received.cause, end, limits, context), reached);
  }
  return openAnswer(received.bytes, context, limits, reached);
}

} // namespace cadrefine
