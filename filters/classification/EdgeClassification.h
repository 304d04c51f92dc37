// Which CAD edges the edges of a mesh's boundary run along.
#pragma once

#include "classification/ProjectionTask.h"

#include <cstdint>
#include <vector>

namespace cadrefine
{

/// For each boundary edge a CAD edge or -1, given the nearest point of each vertex, the records of
/// this rank's facets, and which vertices lie on the CAD already. For triangles: by
/// EdgeFinder::find with each pair of facets at the mesh edge; smooth CAD edges only if the mesh
/// runs along half of their length or more. For segments: the CAD edge nearest to the middle.
/// Collective; an exchange of the interface, and a sum of one number for each CAD edge.
std::vector<std::int32_t> findCADEdges(const ProjectionTask& task,
  const std::vector<ClosestPoint>& hits, const std::vector<FacetRecord>& records,
  const std::vector<unsigned char>& settled);

} // namespace cadrefine
