// The parsing, checking and repairing of IGES files, up to where Open CASCADE takes over. A
// repaired file must be one that nothing more is wrong with.

#include "MemoryFile.h"

#include <cadrefine/base/Error.h>
#include <cadrefine/cad/readers/iges/IgesRepair.h>
#include <cadrefine/cad/readers/iges/IgesTopLevel.h>

#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  const fuzz::MemoryFile file(data, size);
  const cadrefine::RepairedIges repaired(file.path());
  for (const int root : cadrefine::findIgesRoots(repaired).kept)
  {
    if (repaired.isBroken(root))
    {
      std::abort();
    }
  }
  const cadrefine::RepairedIges again(repaired.path());
  if (again.entries().size() != repaired.entries().size())
  {
    std::abort();
  }
  return 0;
}
