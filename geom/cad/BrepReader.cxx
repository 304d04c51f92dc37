// Open CASCADE's own files, text or binary. They carry no unit.

#include "OccGuard.h"
#include "OccProgress.h"
#include "ShapeReaders.h"

#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BinTools.hxx>

#include <fstream>

namespace cadrefine
{

ReadShape readBrep(const std::string& path)
{
  ReadShape result;
  const Handle(OccProgress) progress = new OccProgress;
  std::ifstream file(path, std::ios::binary);
  std::string start(30, '\0');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  file.clear();
  file.seekg(0);
  if (start.find("Open CASCADE Topology") != std::string::npos)
  {
    BinTools::Read(result.shape, file, progress->Start());
  }
  else
  {
    // Open CASCADE goes on for ever where the text ends too early.
    file.exceptions(std::ios::failbit | std::ios::badbit);
    try
    {
      BRepTools::Read(result.shape, file, BRep_Builder(), progress->Start());
    }
    catch (const std::ios::failure&)
    {
      throw Error(path + ": the file is damaged: its text cannot be read to the end");
    }
  }
  if (result.shape.IsNull())
  {
    throw Error(path + ": not a BREP file that can be read");
  }
  return result;
}

} // namespace cadrefine
