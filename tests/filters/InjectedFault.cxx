#include "InjectedFault.h"

#include <Standard_NumericError.hxx>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <link.h>
#include <new>
#include <stdexcept>
#include <sys/mman.h>
#include <thread>
#include <unistd.h>

namespace
{

using Place = cadtest::InjectedFault::Place;

/// Seen by processes that are forked, too.
struct Shared
{
  std::atomic<std::int64_t> allocations{ 0 };
  std::atomic<Place> place{ Place::Nowhere };
};

Shared& shared()
{
  static Shared* const memory =
    new (mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0))
      Shared;
  return *memory;
}

std::atomic<bool> counting{ false };
std::int64_t faulty = cadtest::InjectedFault::none;
cadtest::FaultKind faultKind = cadtest::FaultKind::Memory;
std::thread::id maker;
pid_t process = 0;

Place placeHere()
{
  return getpid() != process                   ? Place::OtherProcess
         : std::this_thread::get_id() != maker ? Place::OtherThread
                                               : Place::OwnThread;
}

/// The addresses of a library.
struct Addresses
{
  std::uintptr_t begin = 0;
  std::uintptr_t end = 0;

  bool have(std::uintptr_t address) const { return begin <= address && address < end; }
};
Addresses counted;

Addresses addressesOf(const dl_phdr_info& library)
{
  Addresses all{ UINTPTR_MAX, 0 };
  for (int i = 0; i < library.dlpi_phnum; ++i)
  {
    const auto& segment = library.dlpi_phdr[i];
    if (segment.p_type == PT_LOAD)
    {
      const std::uintptr_t begin = library.dlpi_addr + segment.p_vaddr;
      all.begin = std::min(all.begin, begin);
      all.end = std::max(all.end, begin + segment.p_memsz);
    }
  }
  return all;
}

Addresses libraryWith(const void* address)
{
  struct Search
  {
    std::uintptr_t address;
    Addresses found;
  } search{ reinterpret_cast<std::uintptr_t>(address), {} };
  dl_iterate_phdr(
    [](dl_phdr_info* library, std::size_t, void* data)
    {
      auto& wanted = *static_cast<Search*>(data);
      const Addresses all = addressesOf(*library);
      wanted.found = all.have(wanted.address) ? all : wanted.found;
      return 0;
    },
    &search);
  return search.found;
}

bool mustFail(const void* caller)
{
  return counting.load(std::memory_order_relaxed) &&
         counted.have(reinterpret_cast<std::uintptr_t>(caller)) &&
         shared().allocations.fetch_add(1) == faulty;
}

[[noreturn]] void strike()
{
  shared().place = placeHere();
  switch (faultKind)
  {
    case cadtest::FaultKind::Exception:
      throw std::runtime_error("injected exception");
    case cadtest::FaultKind::OpenCascade:
      throw Standard_NumericError("injected failure");
    default:
      throw std::bad_alloc();
  }
}

void* allocate(std::size_t size, const void* caller)
{
  if (mustFail(caller))
  {
    strike();
  }
  void* const memory = std::malloc(std::max(size, std::size_t{ 1 }));
  if (!memory)
  {
    throw std::bad_alloc();
  }
  return memory;
}

} // namespace

namespace cadtest
{

const char* traceOf(FaultKind kind)
{
  return kind == FaultKind::Memory      ? "memory"
         : kind == FaultKind::Exception ? "injected exception"
                                        : "Standard_NumericError";
}

InjectedFault::InjectedFault(const void* inside, FaultKind kind, std::int64_t number)
{
  counted = libraryWith(inside);
  faultKind = kind;
  faulty = number;
  maker = std::this_thread::get_id();
  process = getpid();
  shared().allocations = 0;
  shared().place = Place::Nowhere;
  counting = true;
}

InjectedFault::~InjectedFault()
{
  counting = false;
}

std::int64_t InjectedFault::allocations()
{
  return shared().allocations;
}

Place InjectedFault::place()
{
  return shared().place;
}

} // namespace cadtest

void* operator new(std::size_t size)
{
  return allocate(size, __builtin_return_address(0));
}

void* operator new[](std::size_t size)
{
  return allocate(size, __builtin_return_address(0));
}

void operator delete(void* memory) noexcept
{
  std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept
{
  std::free(memory);
}

void operator delete[](void* memory) noexcept
{
  std::free(memory);
}

void operator delete[](void* memory, std::size_t) noexcept
{
  std::free(memory);
}
