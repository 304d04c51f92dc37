#include <cadrefine/cad/readers/healing/ShapePreparation.h>

#include <cadrefine/cad/extraction/ShapeIndex.h>

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepTools_ReShape.hxx>
#include <BRep_Tool.hxx>
#include <Geom_Surface.hxx>
#include <Precision.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>

namespace cadrefine
{
namespace
{

bool hasEdge(const TopoDS_Face& face)
{
  for (TopExp_Explorer edge(face, TopAbs_EDGE); edge.More(); edge.Next())
  {
    if (!BRep_Tool::Degenerated(TopoDS::Edge(edge.Current())))
    {
      return true;
    }
  }
  return false;
}

bool isBounded(const Geom_Surface& surface)
{
  double u0 = 0, u1 = 0, v0 = 0, v1 = 0;
  surface.Bounds(u0, u1, v0, v1);
  return !Precision::IsInfinite(u0) && !Precision::IsInfinite(u1) && !Precision::IsInfinite(v0) &&
         !Precision::IsInfinite(v1);
}

} // namespace

BoundedFaces boundFaces(const TopoDS_Shape& shape, AttributeMap& attributeMap)
{
  const auto faces = entitiesOf(shape, TopAbs_FACE);
  BRepTools_ReShape changes;
  BoundedFaces result{ shape, {} };
  for (int i = 1; i <= faces.Extent(); ++i)
  {
    const TopoDS_Face face = TopoDS::Face(faces(i).Oriented(TopAbs_FORWARD));
    if (hasEdge(face))
    {
      continue;
    }
    const Handle(Geom_Surface) surface = BRep_Tool::Surface(face);
    if (!surface.IsNull() && isBounded(*surface))
    {
      const TopoDS_Face whole = BRepBuilderAPI_MakeFace(surface, Precision::Confusion()).Face();
      attributeMap.follow(face, whole);
      changes.Replace(face, whole);
    }
    else
    {
      result.removed.push_back(face);
      changes.Remove(face);
    }
  }
  result.shape = changes.Apply(shape);
  return result;
}

} // namespace cadrefine
