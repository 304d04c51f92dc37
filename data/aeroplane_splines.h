// Bicubic spline surfaces for aeroplane.cxx, and solids of their patches.
#pragma once

#include <Geom_BSplineSurface.hxx>
#include <TopoDS_Shape.hxx>
#include <gp_XYZ.hxx>

#include <functional>
#include <vector>

namespace aeroplane
{

using SurfaceFunction = std::function<gp_XYZ(double u, double v)>;
using Stations = std::vector<double>;
using Patches = std::vector<Handle(Geom_BSplineSurface)>;

/// `count` + 1 equally spaced values from `first` to `last`.
Stations spaced(double first, double last, int count);

/// Bicubic spline through `function` at the stations, which become its knots; C2, with the
/// function's derivatives along the border. The function must be smooth a little beyond it.
Handle(Geom_BSplineSurface)
  interpolate(const SurfaceFunction& function, const Stations& u, const Stations& v);

/// Rational surface of the arc of `angle` (below half a turn) that the profile curve of the poles
/// (x, r) with these knots (degree 3, clamped) sweeps about the x axis, from angle `start`.
Handle(Geom_BSplineSurface)
  revolve(const std::vector<gp_XYZ>& poles, const Stations& knots, double start, double angle);

/// Poles of the cubic spline through `points` at the parameters `knots`, with these end tangents.
std::vector<gp_XYZ> interpolateCurve(const std::vector<gp_XYZ>& points, const Stations& knots,
  const gp_XYZ& startTangent, const gp_XYZ& endTangent);

/// Cuts at every `strideU`-th and `strideV`-th knot; each patch is a surface of its own.
void cut(const Handle(Geom_BSplineSurface) & surface, int strideU, int strideV, Patches& patches);

/// The solid that the patches bound, with planar faces over what they leave open. Throws
/// std::runtime_error where they do not close.
TopoDS_Shape solidOf(const Patches& patches);

} // namespace aeroplane
