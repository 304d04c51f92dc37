#include "EndOnSignal.h"

#include <array>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <string>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace
{

struct Plan
{
  std::string line;
  std::string failure;
  std::vector<std::string> actions; ///< Pairs.
  std::vector<std::string> unfinished;
};

std::atomic<const Plan*> current{ nullptr };
std::atomic<bool> ending{ false };
std::atomic<int> standardError{ STDERR_FILENO }; ///< As it was: what libraries say may be silenced.

std::vector<std::string> listOf(const char* const* strings)
{
  std::vector<std::string> list;
  for (; *strings; ++strings)
  {
    list.emplace_back(*strings);
  }
  return list;
}

// From here on up to endProcess: nothing but what POSIX allows in a handler.

void removePath(const std::string& path)
{
  if (unlink(path.c_str()) != 0)
  {
    rmdir(path.c_str());
  }
}

bool carryOut(const std::string& from, const std::string& to)
{
  if (to.empty())
  {
    removePath(from);
    return true;
  }
  if (from.empty())
  {
    mkdir(to.c_str(), 0777);
    return true;
  }
  return std::rename(from.c_str(), to.c_str()) == 0;
}

/// How many of them were carried out.
std::size_t carryOut(const std::vector<std::string>& actions)
{
  std::size_t done = 0;
  while (2 * done < actions.size() && carryOut(actions[2 * done], actions[2 * done + 1]))
  {
    ++done;
  }
  return done;
}

void tell(const std::string& line)
{
  if (write(standardError, line.data(), line.size()) < 0)
  {
    _exit(1);
  }
}

void endProcess(int signal)
{
  while (ending.exchange(true)) // A second signal, on another thread.
  {
    pause();
  }
  const Plan& plan = *current;
  const std::size_t done = carryOut(plan.actions);
  const bool all = 2 * done == plan.actions.size();
  if (all || done == 0)
  {
    for (const std::string& path : plan.unfinished)
    {
      removePath(path);
    }
  }
  if (all || done > 0)
  {
    tell(all ? plan.line : plan.failure);
  }
  _exit(128 + signal);
}

// A handler that runs on another thread keeps its plan.
void replacePlan(const Plan* plan)
{
  const Plan* before = current.exchange(plan);
  if (!ending)
  {
    delete before;
  }
}

} // namespace

void cadrefineEndOnSignal(
  const char* line, const char* failure, const char* const* actions, const char* const* unfinished)
{
  replacePlan(new Plan{ line, failure, listOf(actions), listOf(unfinished) });
  if (standardError == STDERR_FILENO)
  {
    const int copy = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 0);
    standardError = copy < 0 ? STDERR_FILENO : copy;
  }
  struct sigaction action = {};
  action.sa_handler = endProcess;
  sigfillset(&action.sa_mask);
  for (const int signal : std::array{ SIGINT, SIGTERM, SIGHUP })
  {
    struct sigaction before = {};
    if (sigaction(signal, nullptr, &before) == 0 && before.sa_handler != SIG_IGN)
    {
      sigaction(signal, &action, nullptr);
    }
  }
}
