#include "comm/Threads.h"

#include <cadrefine/base/LowestFailure.h>

#include <vtkSMPTools.h>
#include <vtksys/SystemInformation.hxx>
#include <vtksys/SystemTools.hxx>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <sched.h>
#include <string>
#include <thread>

namespace cadrefine
{
namespace
{

bool userChoseBackend()
{
  return vtksys::SystemTools::HasEnv("VTK_SMP_BACKEND_IN_USE") ||
         std::string(vtkSMPTools::GetBackend()) != "Sequential";
}

struct Cores
{
  std::int64_t number; ///< The same on ranks that are bound to the same cores of the same host.
  int count;
};

/// The cores that this rank is bound to; all of the host where the system does not tell.
Cores ownCores()
{
  vtksys::SystemInformation host;
  std::string name = host.GetHostname();
  int count = static_cast<int>(std::thread::hardware_concurrency());
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof(set), &set) == 0)
  {
    name.append(reinterpret_cast<const char*>(&set), sizeof(set));
    count = CPU_COUNT(&set);
  }
  return { static_cast<std::int64_t>(std::hash<std::string>()(name)), count };
}

/// This number of threads, but at most as many as the user allows each process.
int limited(int threads)
{
  const char* limit = vtksys::SystemTools::GetEnv("VTK_SMP_MAX_THREADS");
  const int most = limit ? std::atoi(limit) : 0;
  return most > 0 ? std::min(most, threads) : threads;
}

/// Runs a loop on threads, which are started anew for every loop.
void forRanges(int threads, std::size_t count, std::size_t grain, const RangeBody& body)
{
  if (threads == 1 || count <= grain)
  {
    body(0, count);
    return;
  }
  LowestFailure failure;
  const auto guarded = [&](vtkIdType begin, vtkIdType end)
  {
    try
    {
      body(static_cast<std::size_t>(begin), static_cast<std::size_t>(end));
    }
    catch (...)
    {
      failure.keep(static_cast<std::size_t>(begin));
    }
  };
  const auto run = [&]
  { vtkSMPTools::For(0, static_cast<vtkIdType>(count), static_cast<vtkIdType>(grain), guarded); };
  if (threads == 0)
  {
    run();
  }
  else
  {
    vtkSMPTools::LocalScope(vtkSMPTools::Config{ threads, "STDThread", false }, run);
  }
  failure.rethrow();
}

} // namespace

int findThreads(RankExchange& exchange)
{
  const Cores own = ownCores();
  const std::vector<std::int64_t> numbers = exchange.gather(own.number);
  if (userChoseBackend())
  {
    return 0;
  }
  const auto ranksHere = static_cast<int>(std::count(numbers.begin(), numbers.end(), own.number));
  return limited(std::max(1, own.count / std::max(1, ranksHere)));
}

ParallelFor forOnThreads(int threads)
{
  return [threads](std::size_t count, std::size_t grain, const RangeBody& body)
  { forRanges(threads, count, grain, body); };
}

ParallelFor forOnThreads(RankExchange& exchange)
{
  return forOnThreads(findThreads(exchange));
}

} // namespace cadrefine
