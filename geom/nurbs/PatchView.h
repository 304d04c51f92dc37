// A rational Bezier patch or curve seen over the unit square. Private to geom/nurbs.
#pragma once

#include <cadrefine/nurbs/Bezier.h>

namespace cadrefine
{

/// Refers to the control points of a patch, or of a curve (degreeV = 0), which must outlive it.
/// Its local parameters (s, t) run over [0, 1]^2; t has no effect on a curve.
struct PatchView
{
  const ControlPoint* points = nullptr;
  int degreeU = 0;
  int degreeV = 0;
  bool isCurve() const { return degreeV == 0; }
  int count() const { return (degreeU + 1) * (degreeV + 1); }
};

inline Point3 toPoint(const ControlPoint& p)
{
  return { p[0] / p[3], p[1] / p[3], p[2] / p[3] };
}

PatchView viewOf(const BezierPatch& patch);
PatchView viewOf(const BezierCurve& curve);

/// Point at local parameters. O(degreeU * degreeV), no allocation; degrees up to maximumDegree.
Point3 evaluateLocal(const PatchView& patch, double s, double t);

/// Point at local parameters, with derivatives with respect to (s, t) (Piegl & Tiller, The NURBS
/// Book, A4.4).
PatchDerivatives evaluateLocalDerivatives(const PatchView& patch, double s, double t);

} // namespace cadrefine
