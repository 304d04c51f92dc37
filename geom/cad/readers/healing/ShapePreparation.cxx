// 1. Give faces without edges their border (FaceBounding.cxx).
// 2. Sort: solids and closed shells stay as they are; faces that are open to others; edges outside
//    of faces.
// 3. Leave out open faces that are there twice (RepeatedFaces.cxx); sew the others, unless they are
//    one shell already (FaceSewing.cxx).
// 4. Heal what Open CASCADE's own checker finds broken; make solids of closed shells, which turns
//    them outward.
// 5. See that every edge has its curve in space.

#include <cadrefine/cad/readers/healing/ShapePreparation.h>

#include <cadrefine/cad/extraction/ShapeIndex.h>
#include <cadrefine/cad/readers/OccProgress.h>

#include <BRepCheck_Analyzer.hxx>
#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Geom_Curve.hxx>
#include <ShapeBuild_ReShape.hxx>
#include <ShapeFix_Shape.hxx>
#include <ShapeFix_Solid.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>

#include <algorithm>
#include <iterator>
#include <vector>

namespace cadrefine
{
namespace
{

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

void followFix(const TopoDS_Shape& shape, ShapeBuild_ReShape& changes, AttributeMap& attributeMap)
{
  if (attributeMap.empty())
  {
    return;
  }
  for (const TopAbs_ShapeEnum type : { TopAbs_FACE, TopAbs_EDGE })
  {
    const auto map = entitiesOf(shape, type);
    for (int i = 1; i <= map.Extent(); ++i)
    {
      attributeMap.follow(map(i), changes.Apply(map(i)));
    }
  }
}

TopoDS_Shape heal(const TopoDS_Shape& shape, AttributeMap& attributeMap)
{
  if (BRepCheck_Analyzer(shape).IsValid())
  {
    return shape;
  }
  ShapeFix_Shape fix(shape);
  const Handle(OccProgress) progress = new OccProgress;
  fix.Perform(progress->Start());
  const TopoDS_Shape fixed = fix.Shape();
  const bool lost = fixed.IsNull() || entitiesOf(fixed, TopAbs_FACE).Extent() <
                                        entitiesOf(shape, TopAbs_FACE).Extent();
  if (lost)
  {
    return shape;
  }
  followFix(shape, *fix.Context(), attributeMap);
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

std::vector<UnreadEntity> lostFaces(const std::vector<TopoDS_Shape>& faces,
  const AttributeMap& attributeMap, const std::string& reason)
{
  std::vector<UnreadEntity> lost;
  std::transform(faces.begin(), faces.end(), std::back_inserter(lost),
    [&](const TopoDS_Shape& face) { return attributeMap.lost(face, reason); });
  return lost;
}

} // namespace

void buildCurvesInSpace(const TopoDS_Shape& shape)
{
  for (TopExp_Explorer explorer(shape, TopAbs_EDGE); explorer.More(); explorer.Next())
  {
    const TopoDS_Edge edge = TopoDS::Edge(explorer.Current());
    double first = 0;
    double last = 0;
    if (BRep_Tool::Degenerated(edge) || !BRep_Tool::Curve(edge, first, last).IsNull())
    {
      continue;
    }
    try
    {
      BRepLib::BuildCurve3d(edge);
    }
    catch (const Standard_Failure&)
    {
      // The edge stays without a curve, and is lost when it is converted.
    }
  }
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

PreparedShape prepareShape(
  const TopoDS_Shape& shape, AttributeMap& attributeMap, OptionalSteps& steps)
{
  if (shape.IsNull())
  {
    return {};
  }
  PreparedShape prepared;
  const BoundedFaces bounded = boundFaces(shape, attributeMap);
  prepared.unread = lostFaces(bounded.removed, attributeMap, "is unbounded");
  if (bounded.shape.IsNull())
  {
    return prepared;
  }
  std::vector<TopoDS_Shape> parts;
  Surfaces surfaces = collectSurfaces(bounded.shape);
  if (!surfaces.openFaces.empty())
  {
    const DistinctFaces distinct = distinctFaces(surfaces.openFaces);
    prepared.leftOut = lostFaces(distinct.repeated, attributeMap, "is a duplicate of another face");
    SewnFaces sewn{ compoundOf(distinct.faces), 0 };
    steps.run(ReadStep::Sewing, [&] { sewn = sewFaces(distinct.faces, attributeMap); });
    prepared.sewingTolerance = distinct.faces.size() > 1 ? sewn.tolerance : 0;
    surfaces.whole.push_back(sewn.shape);
  }
  if (!surfaces.whole.empty())
  {
    TopoDS_Shape healed = compoundOf(surfaces.whole);
    steps.run(ReadStep::Healing, [&] { healed = heal(healed, attributeMap); });
    parts.push_back(orientShells(healed));
  }
  const std::vector<TopoDS_Shape> curves = freeShapes(bounded.shape, TopAbs_EDGE, TopAbs_FACE);
  if (!curves.empty())
  {
    const JoinedCurves joined = joinCurves(compoundOf(curves), attributeMap);
    prepared.unread.insert(prepared.unread.end(), joined.lost.begin(), joined.lost.end());
    parts.push_back(joined.shape);
  }
  const TopoDS_Compound all = compoundOf(parts);
  buildCurvesInSpace(all);
  prepared.shape = TopExp_Explorer(all, TopAbs_EDGE).More() ? TopoDS_Shape(all) : TopoDS_Shape();
  return prepared;
}

} // namespace cadrefine
