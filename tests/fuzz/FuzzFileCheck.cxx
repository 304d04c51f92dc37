// What is told of a file before it is read: a format or an Error that names the file.

#include "MemoryFile.h"

#include <cadrefine/base/Error.h>
#include <cadrefine/cad/import/FileCheck.h>

#include <array>
#include <cstdlib>
#include <filesystem>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  const fuzz::MemoryFile file(data, size);
  const std::string folder =
    (std::filesystem::temp_directory_path() / ("fuzz-" + std::to_string(getpid()))).string();
  for (const char* extension : { ".igs", ".STEP", ".brep", ".txt" })
  {
    const std::string link = folder + extension;
    std::filesystem::remove(link);
    std::filesystem::create_symlink(file.path(), link);
    try
    {
      cadrefine::checkFile(link);
    }
    catch (const cadrefine::Error& error)
    {
      if (std::string(error.what()).find(link + ": ") != 0)
      {
        std::abort();
      }
    }
    std::filesystem::remove(link);
  }
  return 0;
}
