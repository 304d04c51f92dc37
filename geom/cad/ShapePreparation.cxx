// 1. Sort: solids and shells stay as they are; free faces; edges outside of faces.
// 2. Sew the free faces, with the smallest tolerance after which the fewest edges stay open.
// 3. Heal what Open CASCADE's own checker finds broken; make solids of closed shells, which turns
//    them outward.
// 4. See that every edge has its curve in space.

#include "ShapePreparation.h"

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <ShapeFix_Shape.hxx>
#include <ShapeFix_Solid.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>

#include <algorithm>
#include <cmath>
#include <vector>

namespace cadrefine
{
namespace
{

double diagonal(const TopoDS_Shape& shape)
{
  Bnd_Box box;
  BRepBndLib::Add(shape, box, false);
  return box.IsVoid() ? 0 : std::sqrt(box.SquareExtent());
}

int countOf(const TopoDS_Shape& shape, TopAbs_ShapeEnum type)
{
  TopTools_IndexedMapOfShape map;
  TopExp::MapShapes(shape, type, map);
  return map.Extent();
}

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

struct Sewn
{
  TopoDS_Shape shape;
  int openEdges = 0;
};

Sewn sewWith(const std::vector<TopoDS_Shape>& faces, double tolerance)
{
  BRepBuilderAPI_Sewing sewing(tolerance);
  for (const TopoDS_Shape& face : faces)
  {
    sewing.Add(face);
  }
  sewing.Perform();
  return { sewing.SewedShape(), sewing.NbFreeEdges() };
}

/// Tries tolerances up to 1e-4 of the model's size; a sewing that loses a face does not count.
TopoDS_Shape sew(const std::vector<TopoDS_Shape>& faces)
{
  const TopoDS_Shape unsewn = compoundOf(faces);
  const double size = diagonal(unsewn);
  Sewn best{ unsewn, -1 };
  for (const double relative : { 1e-7, 1e-6, 1e-5, 1e-4 })
  {
    if (best.openEdges == 0)
    {
      break;
    }
    const Sewn sewn = sewWith(faces, relative * size);
    const bool complete =
      !sewn.shape.IsNull() && countOf(sewn.shape, TopAbs_FACE) == static_cast<int>(faces.size());
    if (complete && (best.openEdges < 0 || sewn.openEdges < best.openEdges))
    {
      best = sewn;
    }
  }
  return best.shape;
}

TopoDS_Shape heal(const TopoDS_Shape& shape)
{
  if (BRepCheck_Analyzer(shape).IsValid())
  {
    return shape;
  }
  ShapeFix_Shape fix(shape);
  fix.Perform();
  const TopoDS_Shape fixed = fix.Shape();
  const bool lost = fixed.IsNull() || countOf(fixed, TopAbs_FACE) < countOf(shape, TopAbs_FACE);
  return lost ? shape : fixed;
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

/// The solids, shells and faces of `shape`, the free ones sewn.
std::vector<TopoDS_Shape> collectSurfaces(const TopoDS_Shape& shape)
{
  std::vector<TopoDS_Shape> parts;
  for (TopExp_Explorer solid(shape, TopAbs_SOLID); solid.More(); solid.Next())
  {
    parts.push_back(solid.Current());
  }
  for (const TopoDS_Shape& shell : freeShapes(shape, TopAbs_SHELL, TopAbs_SOLID))
  {
    parts.push_back(shell);
  }
  const std::vector<TopoDS_Shape> faces = freeShapes(shape, TopAbs_FACE, TopAbs_SHELL);
  if (!faces.empty())
  {
    parts.push_back(sew(faces));
  }
  return parts;
}

} // namespace

TopoDS_Shape prepareShape(const TopoDS_Shape& shape)
{
  if (shape.IsNull())
  {
    return {};
  }
  std::vector<TopoDS_Shape> parts;
  const std::vector<TopoDS_Shape> surfaces = collectSurfaces(shape);
  if (!surfaces.empty())
  {
    parts.push_back(orientShells(heal(compoundOf(surfaces))));
  }
  const std::vector<TopoDS_Shape> curves = freeShapes(shape, TopAbs_EDGE, TopAbs_FACE);
  if (!curves.empty())
  {
    parts.push_back(joinCurves(compoundOf(curves)));
  }
  const TopoDS_Compound all = compoundOf(parts);
  BRepLib::BuildCurves3d(all);
  return TopExp_Explorer(all, TopAbs_EDGE).More() ? TopoDS_Shape(all) : TopoDS_Shape();
}

} // namespace cadrefine
