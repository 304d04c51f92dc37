// An end to what hangs.
#pragma once

#include <csignal>
#include <sys/time.h>
#include <unistd.h>

namespace cadtest
{

/// Ends the process, and so all ranks, once it has computed for so many seconds while this lives:
/// a rank that waits for others computes, too. The time of a busy machine's clock tells nothing.
class Watchdog
{
public:
  explicit Watchdog(int seconds)
  {
    std::signal(SIGPROF, bark);
    set(seconds);
  }
  ~Watchdog() { set(0); }
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

private:
  static void set(int seconds)
  {
    const itimerval time{ { 0, 0 }, { seconds, 0 } };
    setitimer(ITIMER_PROF, &time, nullptr);
  }

  static void bark(int)
  {
    constexpr char text[] = "Watchdog: this hangs.\n";
    const auto written = write(STDERR_FILENO, text, sizeof(text) - 1);
    _exit(written < 0 ? 2 : 1);
  }
};

} // namespace cadtest
