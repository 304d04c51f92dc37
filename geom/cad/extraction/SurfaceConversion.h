// Rational Bezier patches of any surface. Private to geom/cad.
#pragma once

#include <cadrefine/cad/extraction/BezierConversion.h>
#include <cadrefine/cad/extraction/TrimLoops.h>

#include <Geom_Surface.hxx>

#include <vector>

namespace cadrefine
{

/// Maps the parameters of an analytic curve to those of its rational Bezier pieces. A circle's
/// angle and the parameter of its rational quadratic arcs agree at the ends of the arcs only; the
/// other curves keep their parameter. (For an arc of half angle a, whose middle weight is cos a,
/// the local parameter of the angle x from its start is sin(x/2) / (sin(x/2) + sin(a - x/2)); Piegl
/// & Tiller, The NURBS Book, 7.3.)
class ParameterMap
{
public:
  /// Angles over arcs that meet at `knots`, ascending.
  static ParameterMap ofAngles(std::vector<double> knots);

  bool isIdentity() const { return knots_.empty(); }
  double operator()(double parameter) const;
  /// Where the map is not smooth.
  const std::vector<double>& knots() const { return knots_; }

private:
  std::vector<double> knots_;
};

struct ConvertedSurface
{
  PatchGrid grid;
  ParameterMap mapU; ///< Maps the surface's parameters to the grid's.
  ParameterMap mapV;
  double fitError = 0; ///< How far the patches lie off a surface that was fitted.
};

/// The surface that `surface` is a rectangular part of, or `surface` itself.
Handle(Geom_Surface) untrimmed(Handle(Geom_Surface) surface);

/// The part of `surface`, which is untrimmed, over `window`: planes, extrusions and surfaces of
/// revolution (cylinders, cones, spheres, tori) exactly, splines as they are, with their whole
/// patches; anything else, such as offset surfaces, to 1e-9 of its size.
ConvertedSurface convertSurface(const Handle(Geom_Surface) & surface, const ParameterBox& window);

/// Image of the loops under the maps: straight pieces along a parameter line stay straight, the
/// others are interpolated to 1e-10 of the extent.
std::vector<TrimLoop> mapLoops(
  const std::vector<TrimLoop>& loops, const ParameterMap& mapU, const ParameterMap& mapV);

} // namespace cadrefine
