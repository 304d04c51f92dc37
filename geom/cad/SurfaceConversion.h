// Rational Bezier patches of any surface. Private to geom/cad.
#pragma once

#include "BezierConversion.h"
#include "ParameterMap.h"
#include "TrimLoops.h"

#include <Geom_Surface.hxx>

namespace cadrefine
{

struct ConvertedSurface
{
  PatchGrid grid;
  ParameterMap mapU; ///< From the surface's parameters to the grid's.
  ParameterMap mapV;
};

/// The part of `surface` over `window`: planes, extrusions and surfaces of revolution (cylinders,
/// cones, spheres, tori) exactly, splines as they are, with their whole patches; anything else,
/// such as offset surfaces, to 1e-9 of its size.
ConvertedSurface convertSurface(Handle(Geom_Surface) surface, const ParameterBox& window);

/// Image of the loops under the maps: straight pieces along a parameter line stay straight, the
/// others are interpolated to 1e-10 of the extent.
std::vector<TrimLoop> mapLoops(
  const std::vector<TrimLoop>& loops, const ParameterMap& mapU, const ParameterMap& mapV);

} // namespace cadrefine
