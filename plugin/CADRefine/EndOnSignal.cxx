#include "EndOnSignal.h"

#include <array>
#include <atomic>
#include <csignal>
#include <cstring>

#include <fcntl.h>
#include <unistd.h>

namespace
{

/// A list that only grows at its front, so that the handler may read it at any time.
struct Path
{
  const char* name;
  const Path* next;
};

std::atomic<const Path*> paths{ nullptr };
std::atomic<const char*> lastLine{ "" };
std::atomic<int> standardError{ STDERR_FILENO }; ///< As it was: what libraries say may be silenced.

/// Calls nothing but what POSIX allows in a handler.
void endProcess(int signal)
{
  for (const Path* path = paths; path; path = path->next)
  {
    if (unlink(path->name) != 0)
    {
      rmdir(path->name);
    }
  }
  const char* line = lastLine;
  const auto written = write(standardError, line, std::strlen(line));
  _exit(written < 0 ? 1 : 128 + signal);
}

} // namespace

void cadrefineEndOnSignal(const char* line)
{
  lastLine = strdup(line);
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

void cadrefineRemoveOnSignal(const char* path)
{
  paths = new Path{ strdup(path), paths };
}

// What was in the list stays in memory: the handler may be reading it.
void cadrefineRemoveNothingOnSignal()
{
  paths = nullptr;
}
