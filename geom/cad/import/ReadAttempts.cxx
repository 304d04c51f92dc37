#include <cadrefine/cad/import/ReadAttempts.h>

#include <algorithm>

namespace cadrefine
{
namespace
{

/// Leaves out what a run died over. False where that is nothing that can be left out.
bool leaveOut(const RunFailure& failure, ReadOptions& options)
{
  const RunPlace place = failure.place();
  options.failureOnThreads.clear();
  const auto step = static_cast<ReadStep>(place.step);
  switch (step)
  {
    case ReadStep::Attributes:
    case ReadStep::Sewing:
    case ReadStep::Healing:
    case ReadStep::Gaps:
      return options.withoutSteps.emplace(step, failure.cause()).second;
    case ReadStep::Conversion:
    case ReadStep::Drawing:
    {
      if (place.item < 0)
      {
        options.threads = 1;
        options.failureOnThreads = failure.cause();
        return true;
      }
      auto& without =
        step == ReadStep::Conversion ? options.withoutConversions : options.withoutDrawings;
      return without.emplace(place.item, failure.cause()).second;
    }
    default:
      return false;
  }
}

/// The thread sanitizer ends processes that start threads after a fork.
int allowedThreads([[maybe_unused]] int wanted)
{
#ifdef __SANITIZE_THREAD__
  return 1;
#else
  return std::max(1, wanted);
#endif
}

/// With what each thread more takes of the address space: 8 MiB of stack and two of the allocator's
/// heaps of 64 MiB, of which most stays unused.
RunLimits limitsOn(int threads, RunLimits limits)
{
  constexpr std::uint64_t eachThread = 136;
  limits.megabytes +=
    limits.megabytes > 0 ? eachThread * static_cast<std::uint64_t>(threads - 1) : 0;
  return limits;
}

} // namespace

std::vector<char> runAttempts(const std::string& context, const RunLimits& limits, int threads,
  const std::function<std::vector<char>(const ReadOptions&)>& work)
{
  constexpr int mostAttempts = 20;
  ReadOptions options;
  options.threads = allowedThreads(threads);
  for (int attempt = 1;; ++attempt)
  {
    try
    {
      return runIsolated(context, limitsOn(options.threads, limits), [&] { return work(options); });
    }
    catch (const RunFailure& failure)
    {
      if (attempt == mostAttempts || !leaveOut(failure, options))
      {
        throw;
      }
    }
  }
}

} // namespace cadrefine
