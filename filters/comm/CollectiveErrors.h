// Ending together: a failure on one rank is a failure on all.
#pragma once

#include "comm/RankExchange.h"

#include <string>

class vtkMultiProcessController;
class vtkObject;

namespace cadrefine
{

/// The reason of the exception, of whatever type, that is being handled; for the user; never empty.
std::string caughtReason();

/// Runs `work`, which must not communicate, and throws an AgreedError with the first failing rank's
/// reason on all ranks where it threw on any. Collective; one reduction.
template<class Work>
void agreeOnFailure(RankExchange& exchange, const Work& work)
{
  std::string reason;
  try
  {
    work();
  }
  catch (...)
  {
    reason = caughtReason();
  }
  exchange.agree(reason);
}

/// Runs `work`, which may communicate, and throws on all ranks where it throws on any, at any
/// place: the others throw where they wait next, at the end of `work` at the latest. What is thrown
/// is an Error on all ranks. `exchange` is of no use afterwards, unless the Error was an
/// AgreedError. Collective; one reduction, or one message to each rank from one that fails.
template<class Work>
void runCollectively(RankExchange& exchange, const Work& work)
{
  try
  {
    work();
    exchange.agree("");
  }
  catch (const AgreedError&)
  {
    throw;
  }
  catch (...)
  {
    const std::string reason = caughtReason();
    exchange.fail(reason);
    throw Error(reason);
  }
}

/// Reports an exception that is being handled on all ranks: rank 0 reports its reason as an error
/// of the object.
void reportOnce(vtkObject* object, vtkMultiProcessController* controller);

} // namespace cadrefine
