// The program's side of runIsolated.
// 1. It ends with its parent, limits its time and memory, and does its job.
// 2. It counts its steps, and notes its place, in memory that the parent sees.
// 3. It writes one letter, the length and the bytes (or the error's text) to a pipe, and leaves
//    through _exit, without the time that Open CASCADE takes to clean up.

#include <cadrefine/cad/import/OccGuard.h>
#include <cadrefine/cad/import/RunProtocol.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>
#include <new>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

namespace cadrefine
{
namespace
{

/// Null where no job is done.
RunState* runState = nullptr;

/// Null where this program was not started by runIsolated.
RunState* openState()
{
  struct stat file = {};
  if (fstat(stateDescriptor, &file) != 0 || file.st_size < static_cast<off_t>(sizeof(RunState)))
  {
    return nullptr;
  }
  void* const memory = mmap(nullptr, static_cast<std::size_t>(file.st_size), PROT_READ | PROT_WRITE,
    MAP_SHARED, stateDescriptor, 0);
  auto* const state = memory == MAP_FAILED ? nullptr : static_cast<RunState*>(memory);
  return state && state->protocol == RunState::currentProtocol ? state : nullptr;
}

void writeAll(const char* data, std::size_t size)
{
  while (size > 0)
  {
    const ssize_t written = write(answerDescriptor, data, size);
    if (written < 0 && errno != EINTR)
    {
      _exit(1);
    }
    data += written > 0 ? written : 0;
    size -= written > 0 ? static_cast<std::size_t>(written) : 0;
  }
}

void answer(AnswerKind kind, const char* data, std::size_t size)
{
  char head[answerHeadSize] = { static_cast<char>(kind) };
  const std::uint64_t length = size;
  std::memcpy(head + 1, &length, sizeof(length));
  writeAll(head, answerHeadSize);
  writeAll(data, size);
}

void answerText(AnswerKind kind, const char* text)
{
  answer(kind, text, std::strlen(text));
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

void endWithParent(pid_t parent)
{
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) // it ended before
  {
    _exit(1);
  }
}

void setUpSignals()
{
  // Sanitizers have handlers of their own.
  for (const int signal : { SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT })
  {
    std::signal(signal, SIG_DFL);
  }
  // A terminal sends these to the parent too, which may have something to finish.
  for (const int signal : { SIGINT, SIGHUP })
  {
    std::signal(signal, SIG_IGN);
  }
}

void setLimits(const RunLimits& limits)
{
  const rlimit noCore{ 0, 0 };
  setrlimit(RLIMIT_CORE, &noCore);
  const auto seconds =
    static_cast<rlim_t>(std::max(1., std::ceil(limits.cpuSeconds - limits.spentSeconds)));
  const rlimit time{ seconds, seconds + 1 };
  setrlimit(RLIMIT_CPU, &time);
  limitMemory(limits.megabytes);
}

[[noreturn]] void serve(RunJobs::mapped_type job, const char* context)
{
  try
  {
    ByteReader input(runState->input(), runState->input() + runState->inputSize);
    const std::vector<char> result = guardOcc(context, [&] { return job(context, input); });
    answer(AnswerKind::Done, result.data(), result.size());
  }
  catch (const Error& error)
  {
    answerText(AnswerKind::Failed, error.what());
  }
  catch (const std::bad_alloc&)
  {
    answer(AnswerKind::OutOfMemory, nullptr, 0);
  }
  catch (const std::exception& error)
  {
    answerText(AnswerKind::Excepted, error.what());
  }
  catch (...)
  {
    _exit(1);
  }
  _exit(0);
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

int serveRun(int argc, char** argv, const RunJobs& jobs)
{
  runState = openState();
  const auto job = argc == 3 ? jobs.find(argv[1]) : jobs.end();
  if (runState == nullptr || job == jobs.end())
  {
    std::fprintf(stderr, "%s: CADRefine starts this program to read CAD files\n", argv[0]);
    return 2;
  }
  endWithParent(runState->parent);
  setUpSignals();
  setLimits(runState->limits);
  runState->started = true;
  serve(job->second, argv[2]);
}

} // namespace cadrefine
