#include "WindowPlugin.h"

#include <vtkNew.h>
#include <vtkPVPluginLoader.h>

#include <dlfcn.h>
#include <filesystem>

namespace
{

/// ParaView's window is in the process: pqApplicationCore::instance() is. (That it has been made
/// yet is not asked: what PV_PLUGIN_CONFIG_FILE names is loaded before.)
bool inWindow()
{
  return dlsym(RTLD_DEFAULT, "_ZN17pqApplicationCore8instanceEv") != nullptr;
}

std::filesystem::path ownFolder()
{
  Dl_info info{};
  dladdr(reinterpret_cast<const void*>(&ownFolder), &info);
  std::error_code error;
  const auto own = std::filesystem::canonical(info.dli_fname ? info.dli_fname : "", error);
  return own.parent_path();
}

} // namespace

void loadWindowPlugin()
{
  if (inWindow())
  {
    const auto plugin = ownFolder() / "CADRefineWindow" / "CADRefineWindow.so";
    vtkNew<vtkPVPluginLoader> loader;
    loader->LoadPlugin(plugin.c_str()); // which tells why it cannot be loaded
  }
}
