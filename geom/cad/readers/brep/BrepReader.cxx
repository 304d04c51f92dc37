// Open CASCADE's own files, text or binary. They carry no unit.

#include <cadrefine/cad/extraction/ShapeIndex.h>
#include <cadrefine/cad/import/OccGuard.h>
#include <cadrefine/cad/readers/OccProgress.h>
#include <cadrefine/cad/readers/ShapeReaders.h>

#include <BRepTools.hxx>
#include <BRepTools_ReShape.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <BinTools.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>

#include <fstream>
#include <utility>

namespace cadrefine
{
namespace
{

/// Faces and edges are known by their order in the file.
void numberEntities(ReadShape& read)
{
  for (const auto& [type, name] :
    { std::pair(TopAbs_FACE, "BREP face"), std::pair(TopAbs_EDGE, "BREP edge") })
  {
    const auto entities = entitiesOf(read.shape, type);
    for (int i = 1; i <= entities.Extent(); ++i)
    {
      read.attributeMap.add(entities(i), {}, { i, name });
    }
  }
}

/// Open CASCADE leaves a surface out that it cannot make, and crashes on the face later.
void dropFacesWithoutSurface(ReadShape& read)
{
  BRepTools_ReShape changes;
  const auto faces = entitiesOf(read.shape, TopAbs_FACE);
  for (int i = 1; i <= faces.Extent(); ++i)
  {
    const TopoDS_Face face = TopoDS::Face(faces(i));
    if (!BRep_Tool::Surface(face).IsNull())
    {
      continue;
    }
    TopLoc_Location location;
    const bool hasTriangles = !BRep_Tool::Triangulation(face, location).IsNull();
    changes.Remove(face);
    read.report.unread.push_back(read.attributeMap.lost(
      face, hasTriangles ? "has triangles, but no surface" : "has no surface that can be read"));
  }
  if (!read.report.unread.empty())
  {
    read.shape = changes.Apply(read.shape);
  }
}

} // namespace

ReadShape readBrep(const std::string& path, OptionalSteps&)
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
    throw Error(path + ": cannot be read as a BREP file");
  }
  numberEntities(result);
  dropFacesWithoutSurface(result);
  return result;
}

} // namespace cadrefine
