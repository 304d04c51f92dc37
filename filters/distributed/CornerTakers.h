// One mesh vertex for each CAD vertex that wants one.
#pragma once

#include "ProjectionTask.h"
#include "VertexEntities.h"

#include <vector>

namespace cadrefine
{

/// CAD vertices are given to mesh vertices one to one. A mesh vertex may take
///   - an end of one of its CAD edges, or an apex of one of its faces, that is a corner (see
///     findCorners), within half of its longest boundary edge;
///   - any other end of one of its CAD edges, if it lies on a second one of that end's edges too,
///     within a quarter of its longest boundary edge, and is not on the CAD elsewhere already.
/// It asks for the one it suits best: of those of which it has two CAD edges, within the quarter,
/// the nearest; otherwise the nearest. The CAD vertex goes to the mesh vertex that suits it best in
/// the same sense, on a tie to the one with the smallest id. Only vertices with `onCAD` take part.
///
/// `hits` of those that take a CAD vertex are changed to it. Returns 1 for vertices in conflict:
///   - of a facet whose face is not known, or where a row of mesh edges along a crease ends;
///   - whose CAD edges are of several lines (see findCreaseLines) that do not all meet in the CAD
///     vertex it has taken, or, if it has none, in one that is no corner;
///   - that lie on a corner which another vertex has taken.
/// Collective; three reductions of a number for each CAD vertex.
std::vector<unsigned char> giveCorners(const ProjectionTask& task, const VertexEntities& meeting,
  const std::vector<unsigned char>& onCAD, std::vector<ClosestPoint>& hits);

} // namespace cadrefine
