// What Project Onto CAD does with a mesh.
#pragma once

#include "classification/ProjectionTask.h"
#include "pipeline/MeshState.h"

#include <string>
#include <vector>

namespace cadrefine
{

/// Options of a projection. `region`: xmin xmax ymin ymax zmin zmax, or null: everywhere. Throws
/// Error for what is out of range (see PropertyCheck).
ProjectionOptions makeProjectionOptions(
  const double* region, double maximumDistance, std::vector<std::string> faces);

/// Puts the boundary onto the CAD (see projectBoundary; points alone: projectPoints). The mesh gets
/// its classification, conflicts as a point array, counts and the fit (see writeFit) as field data.
/// Whether cells are to be mended is decided here. Warns of a misfit; throws Error where no vertex
/// lies on the CAD. Returns the fit as text. Collective.
std::string projectMesh(
  const PipelineContext& context, MeshState& state, const ProjectionOptions& options);

} // namespace cadrefine
