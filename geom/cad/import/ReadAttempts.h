// Reading, again and again without what Open CASCADE crashes on. Private to geom/cad.
#pragma once

#include <cadrefine/cad/import/IsolatedRun.h>
#include <cadrefine/cad/import/ReadSteps.h>

#include <string>
#include <vector>

namespace cadrefine
{

/// Returns what the job, done by runIsolated on `threads` threads, returns for the options of an
/// attempt and `input`. Where it dies in an optional step, or over one face or edge, it is done
/// again without; where it dies on several threads, again on one, which tells over what. All
/// attempts together keep to limits.cpuSeconds; after each step that is late, the next has half the
/// time. Throws RunFailure where it dies of anything else, or there is no time left.
std::vector<char> runAttempts(const std::string& job, const std::string& context, RunLimits limits,
  int threads, const std::vector<char>& input);

/// Takes the options that stand before the input of a job that runAttempts does.
ReadOptions takeOptions(ByteReader& input);

} // namespace cadrefine
