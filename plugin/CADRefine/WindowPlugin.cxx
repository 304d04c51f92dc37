#include "WindowPlugin.h"

#include <cadrefine/base/CodeFolder.h>

#include <vtkNew.h>
#include <vtkPVPluginLoader.h>

#include <dlfcn.h>

namespace
{

/// ParaView's window is in the process: pqApplicationCore::instance() is. (That it has been made
/// yet is not asked: what PV_PLUGIN_CONFIG_FILE names is loaded before.)
bool inWindow()
{
  return dlsym(RTLD_DEFAULT, "_ZN17pqApplicationCore8instanceEv") != nullptr;
}

} // namespace

void loadWindowPlugin()
{
  if (inWindow())
  {
    const auto folder = cadrefine::folderOfCode(reinterpret_cast<const void*>(&loadWindowPlugin));
    const auto plugin = folder / "CADRefineWindow" / "CADRefineWindow.so";
    vtkNew<vtkPVPluginLoader> loader;
    loader->LoadPlugin(plugin.c_str()); // which tells why it cannot be loaded
  }
}
