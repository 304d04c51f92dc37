// Boxes round edges and round parts of faces, to leave out what cannot be nearest.
#pragma once

#include <cadrefine/base/Vector3.h>

#include <Bnd_Box.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>

#include <vector>

namespace exacttest
{

/// Distance from a point to a box; 0 inside.
double boxDistance(const Bnd_Box& box, const cadrefine::Point3& q);

/// A part of a face's surface, and a box that holds it.
struct SurfaceBlock
{
  double u0 = 0;
  double u1 = 0;
  double v0 = 0;
  double v1 = 0;
  Bnd_Box box;
};

/// Rectangles of parameters that cover the face: of a spline a few knot spans each, so that boxes
/// are tight and Open CASCADE's search, whose cost grows with the spans, looks at few of them. The
/// boxes of splines are those of control points, those of planes, cylinders, cones, spheres and
/// tori exact; of other surfaces Open CASCADE's are estimates from samples, and enlarged by a
/// tenth.
std::vector<SurfaceBlock> blocksOf(const TopoDS_Face& face);

/// A box that holds the edge's curve in space, likewise.
Bnd_Box boxOf(const TopoDS_Edge& edge);

} // namespace exacttest
