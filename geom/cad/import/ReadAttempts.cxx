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

/// The thread sanitizer does not see the locks of Open CASCADE, which is built without it.
int allowedThreads([[maybe_unused]] int wanted)
{
#ifdef __SANITIZE_THREAD__
  return 1;
#else
  return std::max(1, wanted);
#endif
}

/// The limits with what each thread more takes of the address space: 8 MiB of stack and two of the
/// allocator's heaps of 64 MiB, of which most stays unused.
RunLimits limitsOn(int threads, RunLimits limits)
{
  constexpr std::uint64_t eachThread = 136;
  limits.megabytes +=
    limits.megabytes > 0 ? eachThread * static_cast<std::uint64_t>(threads - 1) : 0;
  return limits;
}

/// Takes what a run needed off the limits of those after it, so that many entities that never come
/// to an end take little more time than one.
void spend(const RunEnd& end, RunLimits& limits)
{
  limits.spentSeconds += end.cpuSeconds;
  limits.stepSeconds = end.lateStep ? std::max(1, limits.stepSeconds / 2) : limits.stepSeconds;
}

template<typename Key>
void write(ByteWriter& writer, const std::map<Key, std::string>& reasons)
{
  writer.list(reasons,
    [&](const auto& entry)
    {
      writer.number(entry.first);
      writer.text(entry.second);
    });
}

template<typename Key>
void read(ByteReader& reader, std::map<Key, std::string>& reasons)
{
  for (auto count = reader.number<std::uint64_t>(); count > 0; --count)
  {
    const auto key = reader.number<Key>();
    reasons[key] = reader.text();
  }
}

std::vector<char> withOptions(const ReadOptions& options, const std::vector<char>& input)
{
  ByteWriter writer;
  write(writer, options.withoutSteps);
  write(writer, options.withoutConversions);
  write(writer, options.withoutDrawings);
  writer.number(options.threads);
  writer.text(options.failureOnThreads);
  writer.bytes.insert(writer.bytes.end(), input.begin(), input.end());
  return std::move(writer.bytes);
}

} // namespace

std::vector<char> runAttempts(const std::string& job, const std::string& context, RunLimits limits,
  int threads, const std::vector<char>& input)
{
  constexpr int mostAttempts = 20;
  ReadOptions options;
  options.threads = allowedThreads(threads);
  for (int attempt = 1;; ++attempt)
  {
    try
    {
      return runIsolated(
        job, context, limitsOn(options.threads, limits), withOptions(options, input));
    }
    catch (const RunFailure& failure)
    {
      spend(failure.end(), limits);
      const bool isOver = attempt == mostAttempts || limits.spentSeconds + 1 > limits.cpuSeconds;
      if (isOver || !leaveOut(failure, options))
      {
        throw;
      }
    }
  }
}

ReadOptions takeOptions(ByteReader& input)
{
  ReadOptions options;
  read(input, options.withoutSteps);
  read(input, options.withoutConversions);
  read(input, options.withoutDrawings);
  options.threads = input.number<int>();
  options.failureOnThreads = input.text();
  return options;
}

} // namespace cadrefine
