// Work that may crash or never end, in a process of its own. Private to geom/cad.
#pragma once

#include <cadrefine/base/Error.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace cadrefine
{

struct RunLimits
{
  int cpuSeconds = 0;          ///< Of computing, in all.
  std::uint64_t megabytes = 0; ///< Of address space, beside what this process has; 0: no limit.
  int idleSeconds = 20;        ///< On the clock, without computing anything.
  /// From one noteProgress() to the next, of computing and on the clock (on several threads the
  /// former runs faster); 0: no limit.
  int stepSeconds = 0;
};

/// Which part of the work a run was at, in numbers of its own (see noteStep).
struct RunPlace
{
  int step = 0;
  int item = -1;
};

/// Thrown where a run ended without an answer: by a crash, an exception that is no Error, or beyond
/// its limits.
class RunFailure : public Error
{
public:
  RunFailure(const std::string& context, const std::string& cause, RunPlace place)
    : Error(context + ": " + cause), cause_(cause), place_(place)
  {
  }
  /// The text without its context.
  const std::string& cause() const { return cause_; }
  RunPlace place() const { return place_; }

private:
  std::string cause_;
  RunPlace place_;
};

/// What `work` returns, done in a child process that shares nothing with this one and prints
/// nothing. An Error of the child is thrown here. Where it crashes, throws anything else or takes
/// more time or memory than the limits allow, throws RunFailure, whose text begins with `context`;
/// where the system makes no child, or kills it, Error. The child does not outlive the thread that
/// calls.
std::vector<char> runIsolated(const std::string& context, const RunLimits& limits,
  const std::function<std::vector<char>()>& work);

/// To be called by `work` where a part of it is done, about once for each entity: what follows may
/// take RunLimits::stepSeconds. Does nothing outside of runIsolated. Cost: one addition.
void noteProgress();

/// The same where another part of the work begins, so that a failure tells its place.
void noteStep(int step, int item = -1);

} // namespace cadrefine
