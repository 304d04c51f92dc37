// Putting the boundary of a mesh onto the CAD for the first time.
#pragma once

#include "BoundaryProjector.h"
#include "CADArrays.h"
#include "DistributedBoundary.h"
#include "DistributedMesh.h"
#include "EvenWork.h"

#include <array>
#include <cstdint>
#include <optional>

namespace cadrefine
{

struct ProjectionOptions
{
  /// Only vertices inside xmin xmax ymin ymax zmin zmax.
  std::optional<std::array<double, 6>> region;
  /// Vertices farther from the CAD stay; 0: a vertex's longest boundary edge (points alone: no
  /// limit).
  double maximumDistance = 0;
};

struct ProjectionResult
{
  Classification classification;
  std::int64_t projectedPoints = 0; ///< Vertices that were looked up on the CAD, over all ranks.
  WorkBalance balance;              ///< Of these look-ups over the ranks.
};

/// Moves the boundary vertices of the mesh onto the CAD (S. Strunk, KTH 2013, Algorithm 4.1):
///   1. each boundary vertex in the region finds its nearest point on the trimmed model, within its
///      limit;
///   2. a facet is on the CAD if its corners found one, its normal fits, and it looks alike there;
///      vertices without such a facet are left out (walls that meet the CAD, far field);
///   3. mesh edges along the rim of these facets, or with a dihedral angle, that run along a crease
///      of the CAD put their ends onto that crease;
///   4. each corner of the CAD takes the nearest of these vertices that is within half of its
///      longest edge;
///   5. the vertices move as far as all cells stay valid (see moveVertices).
/// Work: one whole-model query for each boundary vertex, shared out evenly over ranks and threads,
/// and for some facets and boundary edges.
/// Collective.
ProjectionResult projectBoundary(RankExchange& exchange, DistributedMesh& mesh,
  const BoundaryProjector& projector, const DistributedBoundary& boundary,
  const ProjectionOptions& options);

/// Moves every point of a mesh of dimension 0 to its nearest point. Collective.
ProjectionResult projectPoints(RankExchange& exchange, DistributedMesh& mesh, const CADModel& model,
  const ProjectionOptions& options);

} // namespace cadrefine
