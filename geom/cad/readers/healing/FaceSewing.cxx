#include <cadrefine/cad/extraction/ShapeIndex.h>
#include <cadrefine/cad/readers/OccProgress.h>
#include <cadrefine/cad/readers/healing/ShapePreparation.h>

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <Bnd_Box.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Iterator.hxx>

#include <cmath>

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

Handle(BRepBuilderAPI_Sewing) sewWith(const TopoDS_Shape& faces, double tolerance)
{
  Handle(BRepBuilderAPI_Sewing) sewing = new BRepBuilderAPI_Sewing(tolerance);
  for (TopoDS_Iterator face(faces); face.More(); face.Next())
  {
    sewing->Add(face.Value());
  }
  const Handle(OccProgress) progress = new OccProgress;
  sewing->Perform(progress->Start());
  return sewing;
}

void followSewing(
  const TopoDS_Shape& unsewn, BRepBuilderAPI_Sewing& sewing, AttributeMap& attributeMap)
{
  if (attributeMap.empty())
  {
    return;
  }
  const auto faces = entitiesOf(unsewn, TopAbs_FACE);
  for (int i = 1; i <= faces.Extent(); ++i)
  {
    attributeMap.follow(faces(i), sewing.Modified(faces(i)));
  }
  const auto edges = entitiesOf(unsewn, TopAbs_EDGE);
  for (int i = 1; i <= edges.Extent(); ++i)
  {
    attributeMap.follow(edges(i), sewing.ModifiedSubShape(edges(i)));
  }
}

} // namespace

SewnFaces sewFaces(const std::vector<TopoDS_Shape>& faces, AttributeMap& attributeMap)
{
  const TopoDS_Shape unsewn = compoundOf(faces);
  const double size = diagonal(unsewn);
  SewnFaces best{ unsewn, 0 };
  Handle(BRepBuilderAPI_Sewing) bestSewing;
  for (const double relative : { 1e-7, 1e-6, 1e-5, 1e-4 })
  {
    if (!bestSewing.IsNull() && bestSewing->NbFreeEdges() == 0)
    {
      break;
    }
    const double tolerance = relative * size;
    const Handle(BRepBuilderAPI_Sewing) sewing = sewWith(unsewn, tolerance);
    const TopoDS_Shape& sewn = sewing->SewedShape();
    const bool complete =
      !sewn.IsNull() && entitiesOf(sewn, TopAbs_FACE).Extent() == static_cast<int>(faces.size());
    if (complete && (bestSewing.IsNull() || sewing->NbFreeEdges() < bestSewing->NbFreeEdges()))
    {
      best = { sewn, tolerance };
      bestSewing = sewing;
    }
  }
  if (!bestSewing.IsNull())
  {
    followSewing(unsewn, *bestSewing, attributeMap);
  }
  return best;
}

} // namespace cadrefine
