#include <cadrefine/cad/import/ReaderPath.h>

#include <cadrefine/base/CodeFolder.h>
#include <cadrefine/cad/import/CADFile.h>

#include <cstdlib>

namespace cadrefine
{
namespace
{

const char* linkedPath = nullptr;

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
  if (linkedPath)
  {
    return linkedPath;
  }
  const auto folder = folderOfCode(reinterpret_cast<const void*>(&readerPath));
  return (folder / "cadrefine" / "cadrefine-read-cad").string();
}

} // namespace cadrefine
