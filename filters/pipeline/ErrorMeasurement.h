// What CAD Geometric Error does with a mesh.
#pragma once

#include "pipeline/MeshState.h"

#include <string>
#include <vector>

namespace cadrefine
{

/// Measures the error of a classified mesh (see measureError) on these CAD faces (see
/// selectEntities; empty: on all), and adds it as cell arrays and field data. Collective. Throws
/// Error for points alone.
void measureMesh(const PipelineContext& context, MeshState& state, int recursionDepth,
  const std::vector<std::string>& faces);

} // namespace cadrefine
