#include <cadrefine/cad/extraction/BezierConversion.h>

#include <cadrefine/base/Error.h>

#include <Geom2dConvert.hxx>
#include <Geom2dConvert_BSplineCurveToBezierCurve.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_BezierCurve.hxx>
#include <Geom2d_TrimmedCurve.hxx>
#include <GeomConvert.hxx>
#include <GeomConvert_ApproxCurve.hxx>
#include <GeomConvert_BSplineCurveToBezierCurve.hxx>
#include <GeomConvert_BSplineSurfaceToBezierSurface.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_BezierCurve.hxx>
#include <Geom_BezierSurface.hxx>
#include <Geom_OffsetCurve.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <TColGeom_Array2OfBezierSurface.hxx>
#include <TColStd_Array1OfReal.hxx>

#include <algorithm>

namespace cadrefine
{
namespace
{

ControlPoint homogeneous(const gp_Pnt& p, double w)
{
  return { w * p.X(), w * p.Y(), w * p.Z(), w };
}

BezierPatch toPatch(const Geom_BezierSurface& surface)
{
  BezierPatch patch;
  patch.degreeU = surface.UDegree();
  patch.degreeV = surface.VDegree();
  for (int i = 1; i <= surface.NbUPoles(); ++i)
  {
    for (int j = 1; j <= surface.NbVPoles(); ++j)
    {
      patch.points.push_back(homogeneous(surface.Pole(i, j), surface.Weight(i, j)));
    }
  }
  return patch;
}

/// A curve, and a range of its parameter.
template<typename Curve>
struct CurveRange
{
  Handle(Curve) curve;
  double first = 0;
  double last = 0;
  /// Whether the range is so short that Open CASCADE cuts no spline there.
  bool isPoint() const
  {
    constexpr double little = 1e-12;
    return !(this->last - this->first > little);
  }
};

/// The range cut to that of the curve, or to one period of a periodic one. Files trim curves that
/// are trimmed already, and let ranges stick out by rounding, or by whole periods of what was
/// trimmed.
template<typename Curve, typename TrimmedCurve>
CurveRange<Curve> rangeOf(const Handle(Curve) & given, double first, double last)
{
  CurveRange<Curve> range{ given, first, last };
  while (const auto trimmed = Handle(TrimmedCurve)::DownCast(range.curve))
  {
    range.curve = trimmed->BasisCurve();
  }
  if (range.curve->IsPeriodic())
  {
    range.last = std::min(last, first + range.curve->Period());
  }
  else
  {
    range.first = std::max(first, range.curve->FirstParameter());
    range.last = std::min(last, range.curve->LastParameter());
  }
  return range;
}

} // namespace

Handle(Geom_BSplineCurve) fitSpline(const Handle(Geom_Curve) & curve, double first, double last)
{
  constexpr double tolerance = 1e-9;
  constexpr int mostSegments = 1000;
  constexpr int highestDegree = 9;
  const Handle(Geom_TrimmedCurve) part = new Geom_TrimmedCurve(curve, first, last);
  const gp_Pnt middle = part->Value(0.5 * (first + last));
  const double size = part->StartPoint().Distance(middle) + part->EndPoint().Distance(middle);
  return GeomConvert_ApproxCurve(part, tolerance * size, GeomAbs_C1, mostSegments, highestDegree)
    .Curve();
}

std::vector<BezierCurve> bezierPieces(
  const Handle(Geom_Curve) & given, double givenFirst, double givenLast)
{
  const auto range = rangeOf<Geom_Curve, Geom_TrimmedCurve>(given, givenFirst, givenLast);
  const auto& [curve, first, last] = range;
  if (range.isPoint())
  {
    throw Error("a curve has no length");
  }
  // Open CASCADE fits offset curves to 1e-4, whatever their size.
  const Handle(Geom_BSplineCurve) spline =
    curve->IsKind(STANDARD_TYPE(Geom_OffsetCurve))
      ? fitSpline(curve, first, last)
      : GeomConvert::CurveToBSplineCurve(new Geom_TrimmedCurve(curve, first, last));
  // A range beyond the seam of a periodic curve may come back one period off, and a part of a
  // Bezier curve over [0, 1].
  const double start = spline->FirstParameter();
  const double scale = (last - first) / (spline->LastParameter() - start);
  const auto own = [&, from = first](double knot)
  { return scale == 1 && start == from ? knot : from + scale * (knot - start); };
  GeomConvert_BSplineCurveToBezierCurve converter(spline);
  TColStd_Array1OfReal knots(1, converter.NbArcs() + 1);
  converter.Knots(knots);
  std::vector<BezierCurve> pieces(converter.NbArcs());
  for (int k = 1; k <= converter.NbArcs(); ++k)
  {
    const Handle(Geom_BezierCurve) arc = converter.Arc(k);
    BezierCurve& piece = pieces[k - 1];
    piece.t0 = own(knots(k));
    piece.t1 = own(knots(k + 1));
    for (int i = 1; i <= arc->NbPoles(); ++i)
    {
      piece.points.push_back(homogeneous(arc->Pole(i), arc->Weight(i)));
    }
  }
  return pieces;
}

std::vector<BezierCurve2> bezierPieces(
  const Handle(Geom2d_Curve) & given, double givenFirst, double givenLast)
{
  const auto range = rangeOf<Geom2d_Curve, Geom2d_TrimmedCurve>(given, givenFirst, givenLast);
  if (range.isPoint())
  {
    const gp_Pnt2d a = range.curve->Value(range.first);
    const gp_Pnt2d b = range.curve->Value(range.last);
    std::vector<BezierCurve2> point(1);
    point[0].points = { { a.X(), a.Y(), 1 }, { b.X(), b.Y(), 1 } };
    return point;
  }
  const Handle(Geom2d_BSplineCurve) spline = Geom2dConvert::CurveToBSplineCurve(
    new Geom2d_TrimmedCurve(range.curve, range.first, range.last));
  Geom2dConvert_BSplineCurveToBezierCurve converter(spline);
  std::vector<BezierCurve2> pieces(converter.NbArcs());
  for (int k = 1; k <= converter.NbArcs(); ++k)
  {
    const Handle(Geom2d_BezierCurve) arc = converter.Arc(k);
    for (int i = 1; i <= arc->NbPoles(); ++i)
    {
      const double w = arc->Weight(i);
      const gp_Pnt2d p = arc->Pole(i);
      pieces[k - 1].points.push_back({ w * p.X(), w * p.Y(), w });
    }
  }
  return pieces;
}

void transform(const gp_Trsf& trsf, std::vector<ControlPoint>& points)
{
  if (trsf.Form() == gp_Identity)
  {
    return;
  }
  for (ControlPoint& c : points)
  {
    gp_XYZ p(c[0] / c[3], c[1] / c[3], c[2] / c[3]);
    trsf.Transforms(p);
    c = homogeneous(p, c[3]);
  }
}

PatchGrid bezierPatches(const Handle(Geom_Surface) & surface)
{
  const Handle(Geom_BSplineSurface) spline =
    Handle(Geom_BSplineSurface)::DownCast(GeomConvert::SurfaceToBSplineSurface(surface)->Copy());
  PatchGrid grid;
  grid.periodU = spline->IsUPeriodic() ? spline->UPeriod() : 0;
  grid.periodV = spline->IsVPeriodic() ? spline->VPeriod() : 0;
  spline->SetUNotPeriodic();
  spline->SetVNotPeriodic();
  GeomConvert_BSplineSurfaceToBezierSurface converter(spline);
  grid.patchesU = converter.NbUPatches();
  grid.patchesV = converter.NbVPatches();
  TColStd_Array1OfReal u(1, grid.patchesU + 1);
  TColStd_Array1OfReal v(1, grid.patchesV + 1);
  converter.UKnots(u);
  converter.VKnots(v);
  for (int i = 1; i <= grid.patchesU; ++i)
  {
    for (int j = 1; j <= grid.patchesV; ++j)
    {
      BezierPatch patch = toPatch(*converter.Patch(i, j));
      patch.u0 = u(i);
      patch.u1 = u(i + 1);
      patch.v0 = v(j);
      patch.v1 = v(j + 1);
      grid.patches.push_back(std::move(patch));
    }
  }
  return grid;
}

} // namespace cadrefine
