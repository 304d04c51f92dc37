// Drawings of single entities. Private to geom/cad.
#pragma once

#include <cadrefine/cad/extraction/ShapeIndex.h>
#include <cadrefine/cad/model/CADModel.h>

namespace cadrefine
{

/// Triangles of a face, the polyline of an edge, nothing of a vertex; with the normals of `face`,
/// which is the entity, or holds the edge, or is -1: without. Works on a copy of a face's topology,
/// so the shape itself stays as it is.
Tessellation tessellate(const ShapeIndex& index, EntityId entity, int face, double deflection);

} // namespace cadrefine
