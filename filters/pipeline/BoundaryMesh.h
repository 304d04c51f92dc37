// What CAD Boundary makes of a mesh.
#pragma once

#include "pipeline/MeshState.h"
#include "pipeline/PipelineContext.h"

namespace cadrefine
{

/// The boundary of a classified mesh (see findBoundary) as a mesh of its own: triangles, or the
/// segments of a planar mesh, with the vertices that they use. Vertices keep their ids; facets have
/// ids by those of their vertices. Cell arrays are those of the cell that a facet is a side of, and
/// CADDimension, CADEntity (the face, or of a segment the edge, that it lies on; -1 where it does
/// not lie on the CAD), CADName and CADColor of that. A facet that spans several faces is given the
/// one nearest to its centroid. Of a mesh of second order, facets have corners alone.
///
/// Collective. Work: that of classifying the boundary, and in the plane one projection a segment.
MeshState boundaryMesh(const PipelineContext& context, MeshState state);

} // namespace cadrefine
