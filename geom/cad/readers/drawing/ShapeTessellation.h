// Drawings of single entities. Private to geom/cad.
#pragma once

#include <cadrefine/cad/extraction/ShapeIndex.h>
#include <cadrefine/cad/model/DrawnEntity.h>
#include <cadrefine/cad/model/LengthUnit.h>

namespace cadrefine
{

/// Draws an entity: triangles of a face, the polyline of an edge, nothing of a vertex. `deflection`
/// and the drawing are in the unit that `scale` leads to from that of the shape. Works on a copy of
/// a face's topology, so the shape itself stays as it is. Throws Error where Open CASCADE fails.
Tessellation tessellate(
  const ShapeIndex& index, const LengthScale& scale, const DrawnEntity& drawn, double deflection);

} // namespace cadrefine
