// Drawings of single entities. Private to geom/cad.
#pragma once

#include "CADModel.h"

#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>

namespace cadrefine
{

/// Triangles of a face. Works on a copy of its topology, so the shape itself stays as it is.
Tessellation tessellateFace(const TopoDS_Face& face, double deflection);

/// Polyline of an edge.
Tessellation tessellateEdge(const TopoDS_Edge& edge, double deflection);

} // namespace cadrefine
