// 1. Give faces without edges their border (FaceBounding.cxx).
// 2. Sort: solids and closed shells stay as they are; faces that are open to others; edges outside
//    of faces.
// 3. Leave out open faces that are there twice (RepeatedFaces.cxx); sew the others, unless they are
//    one shell already (FaceSewing.cxx).
// 4. Heal what Open CASCADE's own checker finds broken; make solids of closed shells, which turns
//    them outward.
// 5. See that every edge has its curve in space.

#include "ShapePreparation.h"

#include "OccProgress.h"

#include <BRepCheck_Analyzer.hxx>
#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <ShapeBuild_ReShape.hxx>
#include <ShapeFix_Shape.hxx>
#include <ShapeFix_Solid.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>

#include <vector>

namespace cadrefine
{
namespace
{

int countOf(const TopoDS_Shape& shape, TopAbs_ShapeEnum type)
{
  TopTools_IndexedMapOfShape map;
  TopExp::MapShapes(shape, type, map);
  return map.Extent();
}

/// Shapes of `type` that are in none of type `avoid`, each once.
std::vector<TopoDS_Shape> freeShapes(
  const TopoDS_Shape& shape, TopAbs_ShapeEnum type, TopAbs_ShapeEnum avoid)
{
  TopTools_IndexedMapOfShape inside, map;
  for (TopExp_Explorer outer(shape, avoid); outer.More(); outer.Next())
  {
    TopExp::MapShapes(outer.Current(), type, inside);
  }
  std::vector<TopoDS_Shape> shapes;
  for (TopExp_Explorer free(shape, type, avoid); free.More(); free.Next())
  {
    if (!inside.Contains(free.Current()) && map.FindIndex(free.Current()) == 0)
    {
      map.Add(free.Current());
      shapes.push_back(free.Current());
    }
  }
  return shapes;
}

void followFix(const TopoDS_Shape& shape, ShapeBuild_ReShape& changes, LookMap& looks)
{
  if (looks.empty())
  {
    return;
  }
  for (const TopAbs_ShapeEnum type : { TopAbs_FACE, TopAbs_EDGE })
  {
    TopTools_IndexedMapOfShape map;
    TopExp::MapShapes(shape, type, map);
    for (int i = 1; i <= map.Extent(); ++i)
    {
      looks.follow(map(i), changes.Apply(map(i)));
    }
  }
}

TopoDS_Shape heal(const TopoDS_Shape& shape, LookMap& looks)
{
  if (BRepCheck_Analyzer(shape).IsValid())
  {
    return shape;
  }
  ShapeFix_Shape fix(shape);
  const Handle(OccProgress) progress = new OccProgress;
  fix.Perform(progress->Start());
  const TopoDS_Shape fixed = fix.Shape();
  const bool lost = fixed.IsNull() || countOf(fixed, TopAbs_FACE) < countOf(shape, TopAbs_FACE);
  if (lost)
  {
    return shape;
  }
  followFix(shape, *fix.Context(), looks);
  return fixed;
}

/// Closed free shells as solids, with their normals outward; all else as it is.
TopoDS_Shape orientShells(const TopoDS_Shape& shape)
{
  std::vector<TopoDS_Shape> parts;
  for (TopExp_Explorer solid(shape, TopAbs_SOLID); solid.More(); solid.Next())
  {
    parts.push_back(solid.Current());
  }
  for (const TopoDS_Shape& shell : freeShapes(shape, TopAbs_SHELL, TopAbs_SOLID))
  {
    const bool closed = BRep_Tool::IsClosed(shell);
    parts.push_back(
      closed ? TopoDS_Shape(ShapeFix_Solid().SolidFromShell(TopoDS::Shell(shell))) : shell);
  }
  for (const TopoDS_Shape& face : freeShapes(shape, TopAbs_FACE, TopAbs_SHELL))
  {
    parts.push_back(face);
  }
  return compoundOf(parts);
}

struct Surfaces
{
  std::vector<TopoDS_Shape> whole;     ///< Solids and closed shells, or the only shell.
  std::vector<TopoDS_Shape> openFaces; ///< Faces that may have to be sewn.
};

Surfaces collectSurfaces(const TopoDS_Shape& shape)
{
  Surfaces surfaces;
  std::vector<TopoDS_Shape> openShells;
  for (TopExp_Explorer solid(shape, TopAbs_SOLID); solid.More(); solid.Next())
  {
    surfaces.whole.push_back(solid.Current());
  }
  for (const TopoDS_Shape& shell : freeShapes(shape, TopAbs_SHELL, TopAbs_SOLID))
  {
    (BRep_Tool::IsClosed(shell) ? surfaces.whole : openShells).push_back(shell);
  }
  const std::vector<TopoDS_Shape> freeFaces = freeShapes(shape, TopAbs_FACE, TopAbs_SHELL);
  if (freeFaces.empty() && openShells.size() == 1)
  {
    surfaces.whole.push_back(openShells.front());
    return surfaces;
  }
  const TopoDS_Compound open = compoundOf({ compoundOf(openShells), compoundOf(freeFaces) });
  surfaces.openFaces = freeShapes(open, TopAbs_FACE, TopAbs_SOLID);
  return surfaces;
}

} // namespace

TopoDS_Compound compoundOf(const std::vector<TopoDS_Shape>& shapes)
{
  BRep_Builder builder;
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  for (const TopoDS_Shape& shape : shapes)
  {
    builder.Add(compound, shape);
  }
  return compound;
}

PreparedShape prepareShape(const TopoDS_Shape& shape, LookMap& looks)
{
  if (shape.IsNull())
  {
    return {};
  }
  PreparedShape prepared;
  const BoundedFaces bounded = boundFaces(shape, looks);
  prepared.removedFaces = bounded.removed;
  if (bounded.shape.IsNull())
  {
    return prepared;
  }
  std::vector<TopoDS_Shape> parts;
  Surfaces surfaces = collectSurfaces(bounded.shape);
  if (!surfaces.openFaces.empty())
  {
    const std::size_t given = surfaces.openFaces.size();
    surfaces.openFaces = distinctFaces(surfaces.openFaces);
    prepared.repeatedFaces = static_cast<int>(given - surfaces.openFaces.size());
    const SewnFaces sewn = sewFaces(surfaces.openFaces, looks);
    prepared.sewingTolerance = surfaces.openFaces.size() > 1 ? sewn.tolerance : 0;
    surfaces.whole.push_back(sewn.shape);
  }
  if (!surfaces.whole.empty())
  {
    parts.push_back(orientShells(heal(compoundOf(surfaces.whole), looks)));
  }
  const std::vector<TopoDS_Shape> curves = freeShapes(bounded.shape, TopAbs_EDGE, TopAbs_FACE);
  if (!curves.empty())
  {
    parts.push_back(joinCurves(compoundOf(curves), looks));
  }
  const TopoDS_Compound all = compoundOf(parts);
  BRepLib::BuildCurves3d(all);
  prepared.shape = TopExp_Explorer(all, TopAbs_EDGE).More() ? TopoDS_Shape(all) : TopoDS_Shape();
  return prepared;
}

} // namespace cadrefine
