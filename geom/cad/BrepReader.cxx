// Open CASCADE's own files, text or binary. They carry no unit.

#include "OccGuard.h"
#include "OccProgress.h"
#include "ShapeReaders.h"

#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <BinTools.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>

#include <fstream>

namespace cadrefine
{
namespace
{

/// Open CASCADE leaves a surface out that it cannot make, and crashes on the face later.
void checkFaces(const std::string& path, const TopoDS_Shape& shape)
{
  TopTools_IndexedMapOfShape faces;
  TopExp::MapShapes(shape, TopAbs_FACE, faces);
  for (int i = 1; i <= faces.Extent(); ++i)
  {
    if (BRep_Tool::Surface(TopoDS::Face(faces(i))).IsNull())
    {
      throw Error(path + ": the file is damaged: face " + std::to_string(i) +
                  " has no surface that can be read");
    }
  }
}

} // namespace

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
  checkFaces(path, result.shape);
  return result;
}

} // namespace cadrefine
