#include "InjectedFault.h"

#include <Standard_NumericError.hxx>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <fcntl.h>
#include <link.h>
#include <new>
#include <stdexcept>
#include <string>
#include <sys/mman.h>
#include <thread>
#include <unistd.h>

namespace
{

using Place = cadtest::InjectedFault::Place;

/// Seen by programs that are started, too.
struct Shared
{
  std::atomic<bool> counting{ false };
  std::atomic<std::int64_t> allocations{ 0 };
  std::atomic<Place> place{ Place::Nowhere };
  std::int64_t faulty = cadtest::InjectedFault::none;
  cadtest::FaultKind kind = cadtest::FaultKind::Memory;
  pid_t maker = 0;
};

constexpr const char* variable = "CADREFINE_TEST_FAULT"; ///< Holds the descriptor of that memory.

Shared* map(int file)
{
  void* const mapped = mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  if (mapped == MAP_FAILED)
  {
    std::abort();
  }
  return static_cast<Shared*>(mapped);
}

Shared* makeShared()
{
  constexpr int free = 100; // far from those that programs are given
  const int file = fcntl(memfd_create("fault", MFD_CLOEXEC), F_DUPFD, free);
  if (ftruncate(file, sizeof(Shared)) != 0)
  {
    std::abort();
  }
  setenv(variable, std::to_string(file).c_str(), 1);
  return new (map(file)) Shared;
}

Shared* memory = nullptr;

Shared& shared()
{
  memory = memory ? memory : makeShared();
  return *memory;
}

std::thread::id maker;

Place placeHere()
{
  return getpid() != shared().maker            ? Place::OtherProcess
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
  return memory && memory->counting.load(std::memory_order_relaxed) &&
         counted.have(reinterpret_cast<std::uintptr_t>(caller)) &&
         memory->allocations.fetch_add(1) == memory->faulty;
}

[[noreturn]] void strike()
{
  shared().place = placeHere();
  switch (shared().kind)
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
  void* const allocated = std::malloc(std::max(size, std::size_t{ 1 }));
  if (!allocated)
  {
    throw std::bad_alloc();
  }
  return allocated;
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
  maker = std::this_thread::get_id();
  shared().kind = kind;
  shared().faulty = number;
  shared().maker = getpid();
  shared().allocations = 0;
  shared().place = Place::Nowhere;
  shared().counting = true;
}

InjectedFault::~InjectedFault()
{
  shared().counting = false;
}

void InjectedFault::join(const void* inside)
{
  if (const char* const file = std::getenv(variable))
  {
    counted = libraryWith(inside);
    memory = map(std::atoi(file));
  }
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

void operator delete(void* allocated) noexcept
{
  std::free(allocated);
}

void operator delete(void* allocated, std::size_t) noexcept
{
  std::free(allocated);
}

void operator delete[](void* allocated) noexcept
{
  std::free(allocated);
}

void operator delete[](void* allocated, std::size_t) noexcept
{
  std::free(allocated);
}
