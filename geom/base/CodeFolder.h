// Where a library or program lies, for what is installed beside it and moved with it.
#pragma once

#include <dlfcn.h>
#include <filesystem>
#include <string>

namespace cadrefine
{

/// The folder of the library or program that holds the code of this address, links resolved. Where
/// it is not known, the root, and not the one that a user happens to work in.
inline std::filesystem::path folderOfCode(const void* address)
{
  Dl_info info{};
  dladdr(address, &info);
  std::error_code error;
  const auto file = std::filesystem::canonical(info.dli_fname ? info.dli_fname : "", error);
  return error ? std::filesystem::path("/") : file.parent_path();
}

} // namespace cadrefine
