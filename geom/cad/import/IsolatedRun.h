// Work that may crash or never end, done by a program of its own. Private to geom/cad.
#pragma once

#include <cadrefine/base/Error.h>
#include <cadrefine/cad/model/ByteRecords.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace cadrefine
{

struct RunLimits
{
  int cpuSeconds = 0; ///< Seconds of computing, in all.
  /// Megabytes of address space, beside what the program starts with; 0: no limit.
  std::uint64_t megabytes = 0;
  int idleSeconds = 20; ///< Seconds on the clock without computing anything.
  /// Seconds from one noteProgress() to the next, of computing and on the clock (on several threads
  /// the former runs faster); 0: no limit.
  int stepSeconds = 0;
  double spentSeconds = 0; ///< Part of cpuSeconds that other runs for the same have spent.
};

/// Which part of the work a run was at, in numbers of its own (see noteStep).
struct RunPlace
{
  int step = 0;
  int item = -1;
};

/// How far a run came that gave no answer.
struct RunEnd
{
  RunPlace place;
  double cpuSeconds = 0; ///< Seconds of computing.
  bool lateStep = false; ///< Whether the run was ended for RunLimits::stepSeconds.
};

/// Thrown where a run ended without an answer: by a crash, an exception that is no Error, or beyond
/// its limits.
class RunFailure : public Error
{
public:
  RunFailure(const std::string& context, const std::string& cause, const RunEnd& end)
    : Error(context + ": " + cause), cause_(cause), end_(end)
  {
  }
  /// The text without its context.
  const std::string& cause() const { return cause_; }
  RunPlace place() const { return end_.place; }
  const RunEnd& end() const { return end_; }

private:
  std::string cause_;
  RunEnd end_;
};

/// Runs the job of this name with `input`, in a process that prints nothing, of the program that
/// reads CAD files (ReaderPath.h), and returns its answer. An Error of the job is thrown here.
/// Where it crashes, throws anything else or takes more time or memory than the limits allow,
/// throws RunFailure, whose text begins with `context`; where the program cannot be started, or the
/// system kills it, Error. The process does not outlive the thread that calls. Cost: starting the
/// program, 0.05 s.
std::vector<char> runIsolated(const std::string& job, const std::string& context,
  const RunLimits& limits, const std::vector<char>& input);

/// A job of the program, by its name; it is given the context and the input of runIsolated.
using RunJobs =
  std::map<std::string, std::vector<char> (*)(const std::string& context, ByteReader& input)>;

/// The main function of the program: does the job that runIsolated started it for.
int serveRun(int argc, char** argv, const RunJobs& jobs);

/// To be called by a job where a part of it is done, about once for each entity: what follows may
/// take RunLimits::stepSeconds. Does nothing outside of serveRun. Cost: one addition.
void noteProgress();

/// Notes progress where another part of the work begins, so that a failure tells its place.
void noteStep(int step, int item = -1);

} // namespace cadrefine
