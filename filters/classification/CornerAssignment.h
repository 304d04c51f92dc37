// One mesh vertex for each CAD vertex that wants one.
#pragma once

#include "classification/ProjectionTask.h"
#include "classification/VertexClassification.h"

#include <vector>

namespace cadrefine
{

/// CAD vertices are given to mesh vertices one to one. A mesh vertex may take
///   - an end of one of its CAD edges, or an apex of one of its faces, that is a corner (see
///     findCorners), within half of its longest boundary edge;
///   - any other end of one of its CAD edges, if it lies on a second one of that end's edges too,
///     within 0.15 of its shortest boundary edge, and is not on the CAD elsewhere already.
/// It asks for the one it suits best: of those of which it has two CAD edges, so near, the
/// nearest; otherwise the nearest. The CAD vertex goes to the mesh vertex that suits it best in
/// the same sense, on a tie to the one with the smallest id. Only vertices with `onCAD` take part.
///
/// `hits` of those that take a CAD vertex are changed to it; 1 is returned for these. Collective;
/// three reductions of a number for each CAD vertex.
std::vector<unsigned char> giveCorners(const ProjectionTask& task,
  const VertexClassification& meeting, const std::vector<unsigned char>& onCAD,
  std::vector<ClosestPoint>& hits);

} // namespace cadrefine
