#include "EndOnSignal.h"

#include <array>
#include <atomic>
#include <csignal>
#include <cstring>

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
  const auto written = write(STDERR_FILENO, line, std::strlen(line));
  _exit(written < 0 ? 1 : 128 + signal);
}

} // namespace

void cadrefineEndOnSignal(const char* line)
{
  lastLine = strdup(line);
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
