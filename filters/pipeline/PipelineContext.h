// What the steps of the filters run with.
#pragma once

#include "comm/RankExchange.h"
#include "comm/RunStatistics.h"

#include <cadrefine/cad/model/CADModel.h>

#include <functional>
#include <string>

namespace cadrefine
{

struct PipelineContext
{
  RankExchange& exchange;
  const CADModel& model;
  RunStatistics& statistics;
  /// Tells the user of something that is no failure, once for all ranks.
  std::function<void(const std::string&)> warn;
};

} // namespace cadrefine
