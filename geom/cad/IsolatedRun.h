// Work that may crash or never end, in a process of its own. Private to geom/cad.
#pragma once

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
  int stepSeconds = 0;         ///< Of computing, from one noteProgress() to the next; 0: no limit.
};

/// What `work` returns, done in a child process that shares nothing with this one and prints
/// nothing. An Error of the child is thrown here; a crash, another exception, or more time or
/// memory than the limits allow is an Error that begins with `context`. The child does not outlive
/// the thread that calls.
std::vector<char> runIsolated(const std::string& context, const RunLimits& limits,
  const std::function<std::vector<char>()>& work);

/// To be called by `work` where a part of it is done, about once for each entity: what follows may
/// take RunLimits::stepSeconds. Does nothing outside of runIsolated. Cost: one addition.
void noteProgress();

} // namespace cadrefine
