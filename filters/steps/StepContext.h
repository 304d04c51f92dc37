// What the steps of the filters run with.
#pragma once

#include "CADModel.h"
#include "RankExchange.h"
#include "RunStatistics.h"

#include <functional>
#include <string>

namespace cadrefine
{

struct StepContext
{
  RankExchange& exchange;
  const CADModel& model;
  RunStatistics& statistics;
  /// Tells the user of something that is no failure. Called on rank 0 alone.
  std::function<void(const std::string&)> warn;
};

} // namespace cadrefine
