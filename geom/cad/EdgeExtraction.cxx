#include "BezierConversion.h"
#include "Error.h"
#include "NurbsExtraction.h"

#include <BRep_Tool.hxx>

namespace cadrefine
{

NurbsEdge extractEdge(const TopoDS_Edge& edge)
{
  double first = 0;
  double last = 0;
  const Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, first, last);
  if (curve.IsNull())
  {
    throw Error("an edge has no curve in space");
  }
  NurbsEdge result;
  result.segments = bezierPieces(curve, first, last);
  result.tolerance = BRep_Tool::Tolerance(edge);
  return result;
}

} // namespace cadrefine
