// Rational Bezier patches of any surface. Private to geom/cad.
#pragma once

#include <cadrefine/cad/extraction/BezierConversion.h>
#include <cadrefine/cad/extraction/ParameterMap.h>
#include <cadrefine/cad/extraction/TrimLoops.h>

#include <Geom_Surface.hxx>

namespace cadrefine
{

struct ConvertedSurface
{
  PatchGrid grid;
  ParameterMap mapU; ///< From the surface's parameters to the grid's.
  ParameterMap mapV;
  double fitError = 0; ///< How far the patches lie off a surface that was fitted.
};

/// What `surface` is a rectangular part of, or itself.
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
