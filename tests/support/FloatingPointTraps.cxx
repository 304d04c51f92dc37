// 1. The exceptions are unmasked. The instruction that would raise one ends in the handler of
//    SIGFPE, with nothing changed.
// 2. The handler notes it, masks the exceptions and sets the trap flag: the instruction runs again,
//    and one step later the handler of SIGTRAP unmasks the exceptions.
// Handlers run with an environment of their own; they change the one that is restored after them.

#include "FloatingPointTraps.h"

#include <array>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <execinfo.h>
#include <new>
#include <stdexcept>
#include <sys/mman.h>
#include <ucontext.h>
#include <xmmintrin.h>

namespace cadtest
{

namespace
{

constexpr unsigned trapped = _MM_MASK_INVALID | _MM_MASK_DIV_ZERO | _MM_MASK_OVERFLOW;
constexpr unsigned raised = _MM_EXCEPT_INVALID | _MM_EXCEPT_DIV_ZERO | _MM_EXCEPT_OVERFLOW;
constexpr greg_t trapFlag = 0x100;
constexpr int maxFrames = 24;

struct Finding
{
  void* instruction = nullptr;
  unsigned exceptions = 0; ///< Of `raised`.
  int times = 0;
  int frameCount = 0;
  std::array<void*, maxFrames> frames{}; ///< From the instruction on.
};

/// In memory that forked processes share.
struct Findings
{
  std::atomic_flag isBusy = ATOMIC_FLAG_INIT;
  int count = 0;
  std::array<Finding, 64> all{};
};

Findings* findings = nullptr;
const char* ownPath = nullptr;
const char* ownLibraries = nullptr;
struct sigaction formerFpe;
struct sigaction formerTrap;

class Lock
{
public:
  Lock()
  {
    while (findings->isBusy.test_and_set(std::memory_order_acquire))
    {
    }
  }
  ~Lock() { findings->isBusy.clear(std::memory_order_release); }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;
};

const char* pathOf(const void* instruction)
{
  Dl_info info{};
  return dladdr(instruction, &info) != 0 && info.dli_fname != nullptr ? info.dli_fname : "";
}

bool isRuntime(const char* path)
{
  return std::strstr(path, "/libm.so") != nullptr || std::strstr(path, "/libc.so") != nullptr;
}

bool isOurs(const Finding& finding)
{
  int caller = 0;
  while (caller + 1 < finding.frameCount && isRuntime(pathOf(finding.frames[caller])))
  {
    ++caller;
  }
  const char* path = pathOf(finding.frames[caller]);
  return std::strcmp(path, ownPath) == 0 || std::strstr(path, ownLibraries) != nullptr;
}

/// From inside of the handler.
Finding findingAt(void* instruction, unsigned exceptions)
{
  std::array<void*, maxFrames + 8> frames{}; // the handler's own first
  const int count = backtrace(frames.data(), static_cast<int>(frames.size()));
  Finding finding;
  finding.instruction = instruction;
  finding.exceptions = exceptions;
  int first = 0;
  while (first < count && frames[first] != instruction)
  {
    ++first;
  }
  for (int i = first; i < count && finding.frameCount < maxFrames; ++i)
  {
    finding.frames[finding.frameCount++] = frames[i];
  }
  if (finding.frameCount == 0)
  {
    finding.frames[finding.frameCount++] = instruction;
  }
  return finding;
}

void note(const Finding& finding)
{
  const Lock lock;
  int i = 0;
  while (i < findings->count && findings->all[i].instruction != finding.instruction)
  {
    ++i;
  }
  if (i == findings->count && i < static_cast<int>(findings->all.size()))
  {
    findings->all[findings->count++] = finding;
  }
  if (i < findings->count)
  {
    ++findings->all[i].times;
  }
}

void onFloatingPoint(int number, siginfo_t* signal, void* context)
{
  auto& machine = static_cast<ucontext_t*>(context)->uc_mcontext;
  const unsigned exceptions = machine.fpregs->mxcsr & raised;
  if (exceptions == 0)
  {
    std::signal(number, SIG_DFL); // a division of integers: runs again, and ends the process
    return;
  }
  const Finding finding = findingAt(signal->si_addr, exceptions);
  if (isOurs(finding))
  {
    note(finding);
  }
  machine.fpregs->mxcsr |= trapped;
  machine.gregs[REG_EFL] |= trapFlag;
}

void afterStep(int /*number*/, siginfo_t* /*signal*/, void* context)
{
  auto& machine = static_cast<ucontext_t*>(context)->uc_mcontext;
  machine.fpregs->mxcsr &= ~(trapped | raised);
  machine.gregs[REG_EFL] &= ~trapFlag;
}

void handle(int number, void (*handler)(int, siginfo_t*, void*), struct sigaction& former)
{
  struct sigaction action = {};
  action.sa_sigaction = handler;
  action.sa_flags = SA_SIGINFO;
  sigemptyset(&action.sa_mask);
  sigaction(number, &action, &former);
}

std::string describe(const Finding& finding)
{
  std::string text = finding.exceptions == _MM_EXCEPT_INVALID    ? "invalid operation"
                     : finding.exceptions == _MM_EXCEPT_DIV_ZERO ? "division by zero"
                     : finding.exceptions == _MM_EXCEPT_OVERFLOW ? "overflow"
                                                                 : "several exceptions";
  text += ", " + std::to_string(finding.times) + " times, first at\n";
  char** lines = backtrace_symbols(finding.frames.data(), finding.frameCount);
  for (int i = 0; lines != nullptr && i < finding.frameCount; ++i)
  {
    text += std::string("  ") + lines[i] + "\n";
  }
  std::free(lines);
  return text;
}

} // namespace

FloatingPointTraps::FloatingPointTraps(const char* ours)
{
  void* memory =
    mmap(nullptr, sizeof(Findings), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED)
  {
    throw std::runtime_error("no memory to share");
  }
  findings = new (memory) Findings;
  ownPath = pathOf(reinterpret_cast<const void*>(&describe));
  ownLibraries = ours;
  std::array<void*, 1> frame{};
  backtrace(frame.data(), 1); // loads what it needs, which a handler should not
  handle(SIGFPE, onFloatingPoint, formerFpe);
  handle(SIGTRAP, afterStep, formerTrap);
  _mm_setcsr(_mm_getcsr() & ~(trapped | raised));
}

FloatingPointTraps::~FloatingPointTraps()
{
  _mm_setcsr(_mm_getcsr() | trapped);
  sigaction(SIGFPE, &formerFpe, nullptr);
  sigaction(SIGTRAP, &formerTrap, nullptr);
  munmap(findings, sizeof(Findings));
}

std::vector<std::string> FloatingPointTraps::takeFindings()
{
  const Lock lock;
  std::vector<std::string> texts;
  texts.reserve(findings->count);
  for (int i = 0; i < findings->count; ++i)
  {
    texts.push_back(describe(findings->all[i]));
  }
  findings->count = 0;
  return texts;
}

} // namespace cadtest
