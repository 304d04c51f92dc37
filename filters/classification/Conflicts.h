// Vertices whose CAD entity is in doubt.
#pragma once

#include "classification/FacetClassification.h"
#include "classification/ProjectionTask.h"
#include "classification/VertexClassification.h"

#include <vector>

namespace cadrefine
{

/// Returns 1 for vertices whose class contradicts that of what meets there, so that it may be
/// wrong:
///   - the face of a facet at it is not known, or its entity does not bound that face;
///   - two facets at an edge of it are on different faces, and the edge runs along no CAD edge nor
///     from one that both faces have to another;
///   - a row of mesh edges along its CAD edge ends or branches there, or fewer or more of them than
///     of CAD edges run into the CAD vertex it has taken;
///   - beside the end of such a row it lies on a face, at a crease: no farther away than a quarter
///     of its longest boundary edge;
///   - its CAD edges are of several lines (see findCreaseLines) that do not all meet in the CAD
///     vertex it has taken, or, if it has none, in one that is no corner;
///   - it lies on a corner which another vertex has taken. Faces that meet in a smooth edge which
///     the mesh does not follow count as one; near an end of a smooth CAD edge a row may end, as
///     the mesh need not know of that. For segments, only the last two are looked at. Only vertices
///     with `onCAD` take part. `taken`: those that have taken a CAD vertex.
///
/// Collective. Work: linear in the boundary, and a query of the creases for each vertex beside the
/// end of a row. Messages: an exchange of the facets beside shared edges, 7 bytes a shared vertex,
/// and a sum of a number for each CAD edge.
std::vector<unsigned char> findConflicts(const ProjectionTask& task, const FacetClasses& facets,
  const VertexClassification& meeting, const std::vector<unsigned char>& onCAD,
  const std::vector<unsigned char>& taken, const std::vector<ClosestPoint>& hits);

} // namespace cadrefine
