#include <cadrefine/base/Error.h>
#include <cadrefine/cad/extraction/BezierConversion.h>
#include <cadrefine/cad/extraction/NurbsExtraction.h>

#include <BRep_Tool.hxx>
#include <TopLoc_Location.hxx>

namespace cadrefine
{

NurbsEdge extractEdge(const TopoDS_Edge& edge)
{
  double first = 0;
  double last = 0;
  TopLoc_Location location;
  const Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, location, first, last);
  if (curve.IsNull())
  {
    throw Error("has no curve in space");
  }
  NurbsEdge result;
  result.segments = bezierPieces(curve, first, last);
  for (BezierCurve& segment : result.segments)
  {
    transform(location.Transformation(), segment.points);
  }
  result.tolerance = BRep_Tool::Tolerance(edge);
  return result;
}

} // namespace cadrefine
