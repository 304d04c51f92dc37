#include <cadrefine/cad/import/ReaderPath.h>

#include <cadrefine/cad/import/CADFile.h>

#include <cstdlib>
#include <dlfcn.h>
#include <filesystem>

namespace cadrefine
{
namespace
{

const char* linkedPath = nullptr;

/// The folder of the library or program that holds this code. Where it is not known, the root, and
/// not the one that a user happens to work in.
std::filesystem::path ownFolder()
{
  Dl_info info{};
  dladdr(reinterpret_cast<const void*>(&readerPath), &info);
  std::error_code error;
  const auto own = std::filesystem::canonical(info.dli_fname ? info.dli_fname : "", error);
  return error ? std::filesystem::path("/") : own.parent_path();
}

} // namespace

const char* setLinkedReader(const char* path) noexcept
{
  linkedPath = path;
  return path;
}

std::string readerPath()
{
  const char* const wanted = std::getenv("CADREFINE_READER");
  if (wanted && *wanted)
  {
    return wanted;
  }
  return linkedPath ? linkedPath : (ownFolder() / "cadrefine" / "cadrefine-read-cad").string();
}

} // namespace cadrefine
