// Writes an aeroplane of 962 NURBS patches, as a designer's IGES file has them.
//
//   aeroplane FILE.igs            the patches, side by side, without topology
//   aeroplane --plain FILE.brep   the same shape with few faces, as one solid, to be meshed
//
// 1. Each part is a closed solid of spline patches that meet at frames and stringers.
// 2. The parts are fused: patches are trimmed where parts meet, and vanish inside others.
// 3. What is left is written face by face.

#include "aeroplane_iges.h"
#include "aeroplane_parts.h"

#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Geom_Plane.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>

#include <iostream>
#include <stdexcept>

namespace
{

using namespace aeroplane;

struct Aeroplane
{
  TopoDS_Shape solid;
  std::vector<NamedFace> faces;
};

/// The faces of `part` that are left in `solid`, trimmed or whole.
void collect(const Part& part, BRepAlgoAPI_Fuse& fuse, const TopTools_IndexedMapOfShape& left,
  std::vector<NamedFace>& faces)
{
  for (TopExp_Explorer face(part.solid, TopAbs_FACE); face.More(); face.Next())
  {
    const TopTools_ListOfShape& pieces = fuse.Modified(face.Current());
    for (const TopoDS_Shape& piece : pieces)
    {
      if (left.Contains(piece))
      {
        faces.push_back({ TopoDS::Face(piece), false, part.name, part.color });
      }
    }
    if (pieces.IsEmpty() && left.Contains(face.Current()))
    {
      const TopoDS_Face whole = TopoDS::Face(face.Current());
      const bool isCap = BRep_Tool::Surface(whole)->IsKind(STANDARD_TYPE(Geom_Plane));
      faces.push_back({ whole, !isCap, part.name, part.color });
    }
  }
}

Aeroplane build(Layout layout)
{
  const std::vector<Part> parts = makeParts(layout);
  TopTools_ListOfShape first, others;
  for (const Part& part : parts)
  {
    (first.IsEmpty() ? first : others).Append(part.solid);
  }
  BRepAlgoAPI_Fuse fuse;
  fuse.SetArguments(first);
  fuse.SetTools(others);
  fuse.Build();
  Aeroplane result{ fuse.Shape(), {} };
  TopTools_IndexedMapOfShape left, solids;
  TopExp::MapShapes(result.solid, TopAbs_FACE, left);
  TopExp::MapShapes(result.solid, TopAbs_SOLID, solids);
  if (fuse.HasErrors() || solids.Extent() != 1 || !BRepCheck_Analyzer(result.solid).IsValid())
  {
    throw std::runtime_error("the parts cannot be fused to one solid");
  }
  for (const Part& part : parts)
  {
    collect(part, fuse, left, result.faces);
  }
  return result;
}

void writeBrep(const TopoDS_Shape& shape, const std::string& path)
{
  gp_Trsf scale;
  scale.SetScaleFactor(1 / metre);
  const TopoDS_Shape scaled = BRepBuilderAPI_Transform(shape, scale).Shape();
  if (!BRepTools::Write(scaled, path.c_str()))
  {
    throw std::runtime_error("cannot write " + path);
  }
}

int run(const std::vector<std::string>& arguments)
{
  const bool plain = arguments.size() == 2 && arguments[0] == "--plain";
  if (!plain && arguments.size() != 1)
  {
    std::cerr << "usage: aeroplane FILE.igs | aeroplane --plain FILE.brep\n";
    return 2;
  }
  const Aeroplane model = build(plain ? Layout::Plain : Layout::Patches);
  if (plain)
  {
    writeBrep(model.solid, arguments[1]);
  }
  else
  {
    writeIges(model.faces, arguments[0]);
  }
  std::cout << arguments.back() << ": " << model.faces.size() << " faces\n";
  return 0;
}

} // namespace

int main(int count, char** values)
{
  try
  {
    return run({ values + 1, values + count });
  }
  catch (const Standard_Failure& failure)
  {
    std::cerr << "aeroplane: " << failure.DynamicType()->Name() << ": "
              << failure.GetMessageString() << "\n";
  }
  catch (const std::exception& failure)
  {
    std::cerr << "aeroplane: " << failure.what() << "\n";
  }
  return 1;
}
