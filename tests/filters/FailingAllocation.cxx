#include "FailingAllocation.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace
{

std::atomic<bool> counting{ false };
std::atomic<std::int64_t> allocations{ 0 };
std::int64_t failing = cadtest::FailingAllocation::none;

bool mustFail()
{
  return counting.load(std::memory_order_relaxed) && allocations.fetch_add(1) == failing;
}

} // namespace

namespace cadtest
{

FailingAllocation::FailingAllocation(std::int64_t number)
{
  failing = number;
  allocations = 0;
  counting = true;
}

FailingAllocation::~FailingAllocation()
{
  counting = false;
}

std::int64_t FailingAllocation::count()
{
  return allocations;
}

} // namespace cadtest

// The other forms of operator new call this one.
void* operator new(std::size_t size)
{
  void* memory = mustFail() ? nullptr : std::malloc(size);
  if (!memory)
  {
    throw std::bad_alloc();
  }
  return memory;
}

void operator delete(void* memory) noexcept
{
  std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept
{
  std::free(memory);
}
