// Bezier pieces of Open CASCADE's curves and surfaces. Private to geom/cad.
#pragma once

#include <cadrefine/nurbs/Bezier.h>

#include <Geom2d_Curve.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_Curve.hxx>
#include <Geom_Surface.hxx>
#include <gp_Trsf.hxx>

#include <vector>

namespace cadrefine
{

/// A polynomial spline that follows `curve` in place and parameter, to 1e-9 of its size.
Handle(Geom_BSplineCurve) fitSpline(const Handle(Geom_Curve) & curve, double first, double last);

/// Pieces of `curve` between its parameters `first` and `last`, in order; the pieces' parameters
/// are the curve's own at the ends. Exact but for offset curves, which are fitted.
std::vector<BezierCurve> bezierPieces(const Handle(Geom_Curve) & curve, double first, double last);

/// Pieces of a curve in a parameter plane, in order.
std::vector<BezierCurve2> bezierPieces(
  const Handle(Geom2d_Curve) & curve, double first, double last);

/// Applies a similarity to homogeneous control points.
void transform(const gp_Trsf& trsf, std::vector<ControlPoint>& points);

/// A grid of patches as NurbsFace has it, and where the parameters repeat.
struct PatchGrid
{
  std::vector<BezierPatch> patches;
  int patchesU = 0;
  int patchesV = 0;
  double periodU = 0; ///< 0: not periodic.
  double periodV = 0;
};

/// The whole of a B-spline or Bezier surface, one period of a periodic one.
PatchGrid bezierPatches(const Handle(Geom_Surface) & surface);

} // namespace cadrefine
