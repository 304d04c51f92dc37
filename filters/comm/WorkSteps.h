// Steps of work, with their progress and their times.
#pragma once

#include "comm/Progress.h"
#include "comm/RunStatistics.h"

#include <optional>
#include <string>

namespace cadrefine
{

/// One step after the other: each has a range of the progress, and adds its time to a figure if
/// that is named. A step ends where the next one begins, or with this object.
class WorkSteps
{
public:
  explicit WorkSteps(Progress& progress) : progress_(progress) {}
  WorkSteps(Progress& progress, RunStatistics& statistics)
    : progress_(progress), statistics_(&statistics)
  {
  }

  void begin(double from, double to)
  {
    end();
    part_.emplace(progress_, from, to);
  }
  /// `figure`: such as "seconds moves", of the statistics.
  void begin(double from, double to, const std::string& figure)
  {
    begin(from, to);
    watch_.emplace(*statistics_, figure);
  }
  void end()
  {
    watch_.reset();
    part_.reset();
  }

private:
  Progress& progress_;
  RunStatistics* statistics_ = nullptr;
  std::optional<Progress::Part> part_;
  std::optional<RunStatistics::Stopwatch> watch_;
};

} // namespace cadrefine
