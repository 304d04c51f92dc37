#include <cadrefine/cad/import/OwnThreads.h>

#include <cadrefine/base/LowestFailure.h>

#include <algorithm>
#include <atomic>
#include <system_error>
#include <thread>
#include <vector>

namespace cadrefine
{
namespace
{

/// Starts as many threads as the system gives, `wanted` at most.
template<typename Work>
std::vector<std::thread> startThreads(std::size_t wanted, const Work& work)
{
  std::vector<std::thread> threads;
  try
  {
    while (threads.size() < wanted)
    {
      threads.emplace_back(work);
    }
  }
  catch (const std::system_error&)
  {
    // The thread that calls does what is left.
  }
  return threads;
}

void forRanges(std::size_t threads, std::size_t count, std::size_t grain, const RangeBody& body)
{
  std::atomic<std::size_t> next{ 0 };
  LowestFailure failure;
  const auto work = [&]
  {
    for (std::size_t begin = next.fetch_add(grain); begin < count; begin = next.fetch_add(grain))
    {
      try
      {
        body(begin, std::min(count, begin + grain));
      }
      catch (...)
      {
        failure.keep(begin);
      }
    }
  };
  const std::size_t useful = std::min(threads, (count + grain - 1) / grain);
  std::vector<std::thread> others = startThreads(std::max<std::size_t>(useful, 1) - 1, work);
  work();
  for (std::thread& other : others)
  {
    other.join();
  }
  failure.rethrow();
}

} // namespace

ParallelFor forOnOwnThreads(int threads)
{
  return [threads = static_cast<std::size_t>(std::max(1, threads))](std::size_t count,
           std::size_t grain, const RangeBody& body) { forRanges(threads, count, grain, body); };
}

} // namespace cadrefine
