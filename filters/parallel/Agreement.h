// Ending together: a failure on one rank is a failure on all.
#pragma once

#include "RankExchange.h"

#include <exception>
#include <string>

namespace cadrefine
{

/// Runs `work`, which must not communicate, and throws an Error with the first failing rank's
/// reason on all ranks where it threw on any. Collective; one reduction.
template<class Work>
void attempt(RankExchange& exchange, const Work& work)
{
  std::string reason;
  try
  {
    work();
  }
  catch (const std::exception& error)
  {
    reason = error.what();
    reason = reason.empty() ? "unknown failure" : reason;
  }
  exchange.agree(reason);
}

} // namespace cadrefine
