// 1. Take the curves of every wire in its order, both sides of a seam and degenerated edges too.
// 2. Shift each by whole periods to begin where the one before it ends, and close what is left of
//    the gap: by moving the start where it is tiny, by a straight piece otherwise.
// 3. Shift the smaller loops by whole periods into the largest.

#include <cadrefine/cad/extraction/TrimLoops.h>

#include <cadrefine/base/Error.h>
#include <cadrefine/cad/extraction/BezierConversion.h>

#include <BRepTools_WireExplorer.hxx>
#include <BRep_Tool.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Wire.hxx>

#include <algorithm>
#include <cmath>
#include <limits>

namespace cadrefine
{
namespace
{

/// Relative to the extent of the loops in the parameter plane.
constexpr double snapTolerance = 1e-9;

Point2 toPoint(const ControlPoint2& c)
{
  return { c[0] / c[2], c[1] / c[2] };
}

struct BoxOfPoints
{
  void include(const Point2& p)
  {
    box.u0 = std::min(box.u0, p[0]);
    box.u1 = std::max(box.u1, p[0]);
    box.v0 = std::min(box.v0, p[1]);
    box.v1 = std::max(box.v1, p[1]);
  }

  static constexpr double infinity = std::numeric_limits<double>::infinity();
  ParameterBox box{ infinity, -infinity, infinity, -infinity };
};

Point2 startOf(const TrimLoop& curves)
{
  return toPoint(curves.front().points.front());
}

Point2 endOf(const TrimLoop& curves)
{
  return toPoint(curves.back().points.back());
}

void shift(TrimLoop& curves, double du, double dv)
{
  if (du == 0 && dv == 0)
  {
    return;
  }
  for (BezierCurve2& curve : curves)
  {
    for (ControlPoint2& c : curve.points)
    {
      c[0] += c[2] * du;
      c[1] += c[2] * dv;
    }
  }
}

double wholePeriods(double difference, double period)
{
  return period > 0 ? period * std::round(difference / period) : 0;
}

/// The edges of a wire in the order in which they are joined; as they are stored, where the
/// explorer loses its way.
std::vector<TopoDS_Edge> orderedEdges(const TopoDS_Wire& wire, const TopoDS_Face& face)
{
  std::vector<TopoDS_Edge> stored, ordered;
  for (TopoDS_Iterator it(wire); it.More(); it.Next())
  {
    const TopAbs_Orientation orientation = it.Value().Orientation();
    if (orientation == TopAbs_FORWARD || orientation == TopAbs_REVERSED)
    {
      stored.push_back(TopoDS::Edge(it.Value()));
    }
  }
  for (BRepTools_WireExplorer explorer(wire, face); explorer.More(); explorer.Next())
  {
    ordered.push_back(explorer.Current());
  }
  return ordered.size() == stored.size() ? ordered : stored;
}

TrimLoop curvesOf(const TopoDS_Edge& edge, const TopoDS_Face& face)
{
  double first = 0;
  double last = 0;
  const Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(edge, face, first, last);
  if (curve.IsNull())
  {
    throw Error("has an edge without a curve in its parameter plane");
  }
  TrimLoop curves = bezierPieces(curve, first, last);
  if (edge.Orientation() == TopAbs_REVERSED)
  {
    std::reverse(curves.begin(), curves.end());
    for (BezierCurve2& piece : curves)
    {
      std::reverse(piece.points.begin(), piece.points.end());
    }
  }
  return curves;
}

void setStart(TrimLoop& curves, const Point2& p)
{
  ControlPoint2& c = curves.front().points.front();
  c = { c[2] * p[0], c[2] * p[1], c[2] };
}

BezierCurve2 straight(const Point2& a, const Point2& b)
{
  BezierCurve2 curve;
  curve.points = { { a[0], a[1], 1 }, { b[0], b[1], 1 } };
  return curve;
}

/// Lets `next` begin at `end`; `tolerance` separates a tiny gap from one to be bridged.
void closeGap(TrimLoop& loop, const Point2& end, TrimLoop& next, double tolerance)
{
  const Point2 start = startOf(next);
  if (start == end)
  {
    return;
  }
  if (std::hypot(start[0] - end[0], start[1] - end[1]) <= tolerance)
  {
    setStart(next, end);
  }
  else
  {
    loop.push_back(straight(end, start));
  }
}

double longerSide(const ParameterBox& box)
{
  return std::max(box.u1 - box.u0, box.v1 - box.v0);
}

TrimLoop joinCurves(std::vector<TrimLoop> pieces, double periodU, double periodV)
{
  for (std::size_t i = 1; i < pieces.size(); ++i)
  {
    const Point2 end = endOf(pieces[i - 1]);
    const Point2 start = startOf(pieces[i]);
    shift(pieces[i], wholePeriods(end[0] - start[0], periodU),
      wholePeriods(end[1] - start[1], periodV));
  }
  const double tolerance = snapTolerance * longerSide(hullOf(pieces));
  TrimLoop loop;
  for (TrimLoop& piece : pieces)
  {
    if (!loop.empty())
    {
      closeGap(loop, endOf(loop), piece, tolerance);
    }
    loop.insert(loop.end(), piece.begin(), piece.end());
  }
  TrimLoop last = { loop.front() };
  closeGap(loop, endOf(loop), last, tolerance);
  loop.front() = last.front();
  return loop;
}

double middle(double a, double b)
{
  return 0.5 * (a + b);
}

void gatherLoops(std::vector<TrimLoop>& loops, double periodU, double periodV)
{
  ParameterBox outer;
  for (const TrimLoop& loop : loops)
  {
    const ParameterBox box = hullOf({ loop });
    const bool larger =
      (box.u1 - box.u0) * (box.v1 - box.v0) > (outer.u1 - outer.u0) * (outer.v1 - outer.v0);
    outer = larger ? box : outer;
  }
  for (TrimLoop& loop : loops)
  {
    const ParameterBox box = hullOf({ loop });
    const double u = middle(box.u0, box.u1);
    const double v = middle(box.v0, box.v1);
    const bool outsideU = u < outer.u0 || u > outer.u1;
    const bool outsideV = v < outer.v0 || v > outer.v1;
    shift(loop, outsideU ? wholePeriods(middle(outer.u0, outer.u1) - u, periodU) : 0,
      outsideV ? wholePeriods(middle(outer.v0, outer.v1) - v, periodV) : 0);
  }
}

/// Signed area of the polygon of the control points.
double polygonArea(const TrimLoop& loop)
{
  double area = 0;
  Point2 before = endOf(loop);
  for (const BezierCurve2& curve : loop)
  {
    for (const ControlPoint2& c : curve.points)
    {
      const Point2 p = toPoint(c);
      area += 0.5 * (before[0] * p[1] - before[1] * p[0]);
      before = p;
    }
  }
  return area;
}

bool liesOnBorder(const BezierCurve2& curve, const ParameterBox& box)
{
  const double du = snapTolerance * (box.u1 - box.u0);
  const double dv = snapTolerance * (box.v1 - box.v0);
  bool left = true, right = true, bottom = true, top = true;
  for (const ControlPoint2& c : curve.points)
  {
    const Point2 p = toPoint(c);
    left = left && std::abs(p[0] - box.u0) <= du;
    right = right && std::abs(p[0] - box.u1) <= du;
    bottom = bottom && std::abs(p[1] - box.v0) <= dv;
    top = top && std::abs(p[1] - box.v1) <= dv;
  }
  return left || right || bottom || top;
}

} // namespace

std::vector<TrimLoop> extractLoops(
  const TopoDS_Face& face, double periodU, double periodV, const ShapeIndex* index)
{
  const TopoDS_Face forward = TopoDS::Face(face.Oriented(TopAbs_FORWARD));
  std::vector<TrimLoop> loops;
  for (TopExp_Explorer wires(forward, TopAbs_WIRE); wires.More(); wires.Next())
  {
    std::vector<TrimLoop> pieces;
    for (const TopoDS_Edge& edge : orderedEdges(TopoDS::Wire(wires.Current()), forward))
    {
      pieces.push_back(curvesOf(edge, forward));
      for (BezierCurve2& curve : pieces.back())
      {
        curve.edge = index ? index->edge(edge) : -1;
      }
    }
    if (!pieces.empty())
    {
      loops.push_back(joinCurves(std::move(pieces), periodU, periodV));
    }
  }
  gatherLoops(loops, periodU, periodV);
  return loops;
}

ParameterBox hullOf(const std::vector<TrimLoop>& loops)
{
  BoxOfPoints box;
  for (const TrimLoop& loop : loops)
  {
    for (const BezierCurve2& curve : loop)
    {
      for (const ControlPoint2& c : curve.points)
      {
        box.include(toPoint(c));
      }
    }
  }
  return box.box;
}

ParameterBox extentOf(const std::vector<TrimLoop>& loops)
{
  constexpr int steps = 32;
  BoxOfPoints box;
  for (const TrimLoop& loop : loops)
  {
    for (const BezierCurve2& curve : loop)
    {
      for (int i = 0; i <= steps; ++i)
      {
        box.include(evaluate(curve, static_cast<double>(i) / steps));
      }
    }
  }
  return box.box;
}

bool followsBorder(const std::vector<TrimLoop>& loops, const ParameterBox& box)
{
  if (loops.size() != 1 || !std::all_of(loops.front().begin(), loops.front().end(),
                             [&](const BezierCurve2& curve) { return liesOnBorder(curve, box); }))
  {
    return false;
  }
  const double area = (box.u1 - box.u0) * (box.v1 - box.v0);
  return std::abs(std::abs(polygonArea(loops.front())) - area) <= 1e-6 * area;
}

} // namespace cadrefine
