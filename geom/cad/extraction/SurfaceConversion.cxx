// Each kind of surface is a profile curve swept along v or round an axis:
// 1. A plane or an extrusion: the profile's Bezier pieces along u, degree 1 along v.
// 2. A surface of revolution: the profile's Bezier pieces along v, turned in arcs of at most 90
//    degrees along u (Piegl & Tiller, The NURBS Book, 8.5).
// Circles and ellipses change their parameter when they become rational arcs: the maps tell how.

#include <cadrefine/cad/extraction/SurfaceConversion.h>

#include <cadrefine/base/Error.h>

#include <GeomConvert_ApproxSurface.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_BezierCurve.hxx>
#include <Geom_BezierSurface.hxx>
#include <Geom_Circle.hxx>
#include <Geom_ElementarySurface.hxx>
#include <Geom_Ellipse.hxx>
#include <Geom_Line.hxx>
#include <Geom_Parabola.hxx>
#include <Geom_Plane.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SurfaceOfLinearExtrusion.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <gp_Ax1.hxx>
#include <gp_Dir.hxx>

#include <algorithm>
#include <cmath>
#include <mutex>

namespace cadrefine
{
namespace
{

constexpr double approximationTolerance = 1e-9;

struct Profile
{
  std::vector<BezierCurve> pieces;
  ParameterMap map;
};

Handle(Geom_Curve) untrimmed(Handle(Geom_Curve) curve)
{
  while (const auto trimmed = Handle(Geom_TrimmedCurve)::DownCast(curve))
  {
    curve = trimmed->BasisCurve();
  }
  return curve;
}

bool keepsParameter(const Handle(Geom_Curve) & curve)
{
  return curve->IsKind(STANDARD_TYPE(Geom_Line)) || curve->IsKind(STANDARD_TYPE(Geom_Parabola)) ||
         curve->IsKind(STANDARD_TYPE(Geom_BSplineCurve)) ||
         curve->IsKind(STANDARD_TYPE(Geom_BezierCurve));
}

bool isElliptic(const Handle(Geom_Curve) & curve)
{
  return curve->IsKind(STANDARD_TYPE(Geom_Circle)) || curve->IsKind(STANDARD_TYPE(Geom_Ellipse));
}

Profile convertProfile(const Handle(Geom_Curve) & given, double first, double last)
{
  const Handle(Geom_Curve) curve = untrimmed(given);
  Profile profile;
  if (isElliptic(curve))
  {
    profile.pieces = bezierPieces(curve, first, last);
    std::vector<double> knots{ profile.pieces.front().t0 };
    for (const BezierCurve& piece : profile.pieces)
    {
      knots.push_back(piece.t1);
    }
    profile.map = ParameterMap::ofAngles(std::move(knots));
  }
  else if (keepsParameter(curve))
  {
    profile.pieces = bezierPieces(curve, first, last);
  }
  else
  {
    profile.pieces = bezierPieces(fitSpline(curve, first, last), first, last);
  }
  return profile;
}

PatchGrid extrude(
  const std::vector<BezierCurve>& pieces, const gp_Dir& direction, double v0, double v1)
{
  PatchGrid grid;
  grid.patchesU = static_cast<int>(pieces.size());
  grid.patchesV = 1;
  for (const BezierCurve& piece : pieces)
  {
    BezierPatch patch;
    patch.degreeU = static_cast<int>(piece.points.size()) - 1;
    patch.degreeV = 1;
    patch.u0 = piece.t0;
    patch.u1 = piece.t1;
    patch.v0 = v0;
    patch.v1 = v1;
    for (const ControlPoint& c : piece.points)
    {
      for (const double v : { v0, v1 })
      {
        const double w = c[3] * v;
        patch.points.push_back(
          { c[0] + w * direction.X(), c[1] + w * direction.Y(), c[2] + w * direction.Z(), c[3] });
      }
    }
    grid.patches.push_back(std::move(patch));
  }
  return grid;
}

/// A control point seen from the axis: its foot there, and the way out from the foot.
struct Spoke
{
  Point3 foot;
  Vector3 out;
  Vector3 side; ///< `out`, turned by 90 degrees about the axis.
  double weight = 1;
};

Spoke makeSpoke(const ControlPoint& c, const gp_Ax1& axis)
{
  const Point3 origin{ axis.Location().X(), axis.Location().Y(), axis.Location().Z() };
  const Vector3 along{ axis.Direction().X(), axis.Direction().Y(), axis.Direction().Z() };
  const Point3 p{ c[0] / c[3], c[1] / c[3], c[2] / c[3] };
  const Point3 foot = origin + dot(p - origin, along) * along;
  Vector3 out = p - foot;
  if (norm(out) < 1e-13 * (norm(p) + norm(p - origin)))
  {
    out = {}; // a pole
  }
  return { foot, out, cross(along, out), c[3] };
}

ControlPoint turned(const Spoke& spoke, double angle, double stretch, double weight)
{
  const double w = spoke.weight * weight;
  const Point3 p =
    spoke.foot + (stretch * std::cos(angle)) * spoke.out + (stretch * std::sin(angle)) * spoke.side;
  return { w * p[0], w * p[1], w * p[2], w };
}

BezierPatch turnPiece(const BezierCurve& piece, const gp_Ax1& axis, double u0, double u1)
{
  BezierPatch patch;
  patch.degreeU = 2;
  patch.degreeV = static_cast<int>(piece.points.size()) - 1;
  patch.u0 = u0;
  patch.u1 = u1;
  patch.v0 = piece.t0;
  patch.v1 = piece.t1;
  const double half = std::cos(0.5 * (u1 - u0));
  for (int i = 0; i < 3; ++i)
  {
    for (const ControlPoint& c : piece.points)
    {
      const Spoke spoke = makeSpoke(c, axis);
      patch.points.push_back(i == 1 ? turned(spoke, 0.5 * (u0 + u1), 1 / half, half)
                                    : turned(spoke, i == 0 ? u0 : u1, 1, 1));
    }
  }
  return patch;
}

ConvertedSurface revolve(
  const Handle(Geom_Surface) & surface, const gp_Ax1& axis, const ParameterBox& window)
{
  const Profile profile = convertProfile(surface->UIso(0), window.v0, window.v1);
  const double quarters = (window.u1 - window.u0) / (0.5 * M_PI);
  const int arcs = std::max(1, static_cast<int>(std::ceil(quarters - 1e-6)));
  std::vector<double> knots;
  for (int i = 0; i <= arcs; ++i)
  {
    knots.push_back(i == arcs ? window.u1 : window.u0 + (window.u1 - window.u0) * i / arcs);
  }
  ConvertedSurface result;
  result.grid.patchesU = arcs;
  result.grid.patchesV = static_cast<int>(profile.pieces.size());
  for (int i = 0; i < arcs; ++i)
  {
    for (const BezierCurve& piece : profile.pieces)
    {
      result.grid.patches.push_back(turnPiece(piece, axis, knots[i], knots[i + 1]));
    }
  }
  result.mapU = ParameterMap::ofAngles(std::move(knots));
  result.mapV = profile.map;
  return result;
}

/// The range where the surface has it: trim curves may stick out by rounding.
void cutToBounds(bool periodic, double low, double high, double& first, double& last)
{
  if (!periodic)
  {
    first = std::max(first, low);
    last = std::min(last, high);
  }
  if (!(last > first))
  {
    throw Error("its trim curves lie outside the surface's parameter domain");
  }
}

ConvertedSurface approximate(const Handle(Geom_Surface) & surface, ParameterBox window)
{
  ParameterBox bounds;
  surface->Bounds(bounds.u0, bounds.u1, bounds.v0, bounds.v1);
  cutToBounds(surface->IsUPeriodic(), bounds.u0, bounds.u1, window.u0, window.u1);
  cutToBounds(surface->IsVPeriodic(), bounds.v0, bounds.v1, window.v0, window.v1);
  const Handle(Geom_Surface) part =
    new Geom_RectangularTrimmedSurface(surface, window.u0, window.u1, window.v0, window.v1);
  const double size =
    part->Value(window.u0, window.v0).Distance(part->Value(window.u1, window.v1)) +
    part->Value(window.u0, window.v1).Distance(part->Value(window.u1, window.v0));
  constexpr int degree = 9;
  constexpr int pieces = 200;
  static std::mutex once; // what fits is translated Fortran, not known to be safe on threads
  const std::lock_guard<std::mutex> lock(once);
  const GeomConvert_ApproxSurface fit(
    part, approximationTolerance * size, GeomAbs_C1, GeomAbs_C1, degree, degree, pieces, 0);
  return { bezierPatches(fit.Surface()), {}, {}, fit.MaxError() };
}

} // namespace

ParameterMap ParameterMap::ofAngles(std::vector<double> knots)
{
  ParameterMap map;
  map.knots_ = std::move(knots);
  return map;
}

double ParameterMap::operator()(double parameter) const
{
  if (isIdentity() || parameter <= knots_.front() || parameter >= knots_.back())
  {
    return parameter;
  }
  const auto upper = std::upper_bound(knots_.begin(), knots_.end(), parameter);
  const double from = *(upper - 1);
  const double width = *upper - from;
  const double x = std::sin(0.5 * (parameter - from));
  const double y = std::sin(0.5 * (width - (parameter - from)));
  return from + width * x / (x + y);
}

Handle(Geom_Surface) untrimmed(Handle(Geom_Surface) surface)
{
  while (const auto trimmed = Handle(Geom_RectangularTrimmedSurface)::DownCast(surface))
  {
    surface = trimmed->BasisSurface();
  }
  return surface;
}

ConvertedSurface convertSurface(const Handle(Geom_Surface) & surface, const ParameterBox& window)
{
  if (surface->IsKind(STANDARD_TYPE(Geom_BSplineSurface)) ||
      surface->IsKind(STANDARD_TYPE(Geom_BezierSurface)))
  {
    return { bezierPatches(surface), {}, {}, 0 };
  }
  if (const auto plane = Handle(Geom_Plane)::DownCast(surface))
  {
    const Profile line = convertProfile(plane->VIso(0), window.u0, window.u1);
    return { extrude(line.pieces, plane->Position().YDirection(), window.v0, window.v1), {}, {} };
  }
  if (const auto extrusion = Handle(Geom_SurfaceOfLinearExtrusion)::DownCast(surface))
  {
    const Profile profile = convertProfile(extrusion->BasisCurve(), window.u0, window.u1);
    return { extrude(profile.pieces, extrusion->Direction(), window.v0, window.v1), profile.map,
      {} };
  }
  if (const auto revolution = Handle(Geom_SurfaceOfRevolution)::DownCast(surface))
  {
    return revolve(surface, revolution->Axis(), window);
  }
  if (const auto elementary = Handle(Geom_ElementarySurface)::DownCast(surface))
  {
    const gp_Ax3 position = elementary->Position();
    // Left-handed axes turn the other way.
    const gp_Dir axis = position.Direct() ? position.Direction() : position.Direction().Reversed();
    return revolve(surface, gp_Ax1(position.Location(), axis), window);
  }
  return approximate(surface, window);
}

} // namespace cadrefine
