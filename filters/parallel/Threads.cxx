#include "Threads.h"

#include <vtkSMPTools.h>
#include <vtksys/SystemInformation.hxx>
#include <vtksys/SystemTools.hxx>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <functional>
#include <mutex>
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

/// The same on ranks that may run on the same cores of the same host.
std::int64_t coresNumber()
{
  vtksys::SystemInformation host;
  std::string cores = host.GetHostname();
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof(set), &set) == 0)
    cores.append(reinterpret_cast<const char*>(&set), sizeof(set));
  return static_cast<std::int64_t>(std::hash<std::string>()(cores));
}

int mostThreads()
{
  const char* limit = vtksys::SystemTools::GetEnv("VTK_SMP_MAX_THREADS");
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  const int wanted = limit ? std::atoi(limit) : 0;
  return wanted > 0 ? std::min(wanted, cores) : cores;
}

/// Threads are started anew for every loop.
void forRanges(int threads, std::size_t count, std::size_t grain, const RangeBody& body)
{
  if (threads == 1 || count <= grain)
  {
    body(0, count);
    return;
  }
  std::mutex mutex;
  std::exception_ptr failure;
  const auto guarded = [&](vtkIdType begin, vtkIdType end)
  {
    try
    {
      body(static_cast<std::size_t>(begin), static_cast<std::size_t>(end));
    }
    catch (...)
    {
      const std::lock_guard<std::mutex> lock(mutex);
      failure = std::current_exception();
    }
  };
  const auto run = [&]
  { vtkSMPTools::For(0, static_cast<vtkIdType>(count), static_cast<vtkIdType>(grain), guarded); };
  if (threads == 0)
    run();
  else
    vtkSMPTools::LocalScope(vtkSMPTools::Config{ threads, "STDThread", false }, run);
  if (failure)
    std::rethrow_exception(failure);
}

} // namespace

int findThreads(RankExchange& exchange)
{
  const std::vector<std::int64_t> cores = exchange.gather(coresNumber());
  if (userChoseBackend())
    return 0;
  const auto ranksHere = std::count(cores.begin(), cores.end(), cores[exchange.rank()]);
  return std::max(1, mostThreads() / static_cast<int>(ranksHere));
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
