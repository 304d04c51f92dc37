// What CAD Geometric Error does with a mesh.
#pragma once

#include "pipeline/MeshState.h"

namespace cadrefine
{

/// Measures the error of a classified mesh (see measureError): cell arrays and field data.
/// Collective. Throws Error for points alone.
void measureMesh(const PipelineContext& context, MeshState& state, int recursionDepth);

} // namespace cadrefine
