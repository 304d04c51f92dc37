// Putting the boundary of a mesh onto the CAD for the first time.
#pragma once

#include "classification/DistributedBoundary.h"
#include "classification/ProjectionTask.h"
#include "comm/LoadBalancedMap.h"
#include "mesh/DistributedMesh.h"
#include "motion/BoundaryMotion.h"

#include <cadrefine/classification/BoundaryProjector.h>
#include <cadrefine/classification/Classification.h>

#include <cstdint>
#include <vector>

namespace cadrefine
{

struct ProjectionResult
{
  Classification classification;
  std::int64_t projectedPoints = 0; ///< Vertices that were looked up on the CAD, over all ranks.
  /// Looked up vertices whose query has not converged (see ClosestPoint).
  std::int64_t slowPoints = 0;
  WorkBalance balance; ///< Balance of these look-ups over the ranks.
  /// 1 for vertices whose CAD entity could not be decided (see findConflicts).
  std::vector<unsigned char> conflicts;
  /// How far each vertex on the CAD was from its place there.
  std::vector<double> distancesBefore;
  std::vector<FacetRecord> facets; ///< Records of the facets of this rank's boundary.
  MotionTrace motion;
};

/// Moves the boundary vertices of the mesh onto the CAD (S. Strunk, KTH 2013, Algorithm 4.1):
///   1. each boundary vertex in the region finds its nearest point on the trimmed model, within its
///      limit; one that lies on a CAD vertex or edge already takes that (see onSmallest);
///   2. facets on the CAD find their faces (see classifyFacets); vertices without such a facet are
///      left out (walls that meet the CAD, far field);
///   3. mesh edges between them find the CAD edges that they run along, and put their ends onto
///      these; other vertices stay with the faces around them (see placeVertices);
///   4. CAD vertices go to mesh vertices, one to one (see giveCorners);
///   5. vertices whose class contradicts what meets there are found (see findConflicts);
///   6. facets on faces that were not chosen are left out, and vertices of such facets alone;
///   7. the vertices move as far as all cells stay valid (see moveOntoCAD).
/// Work: one whole-model query for each boundary vertex; some for facets where faces meet and for
/// mesh edges along CAD edges; all shared out evenly over ranks and threads. Collective.
ProjectionResult projectBoundary(RankExchange& exchange, DistributedMesh& mesh,
  const BoundaryProjector& projector, const DistributedBoundary& boundary,
  const ProjectionOptions& options);

/// Moves every point of a mesh of dimension 0 to its nearest point on the CAD. Collective.
ProjectionResult projectPoints(RankExchange& exchange, DistributedMesh& mesh, const CADModel& model,
  const ProjectionOptions& options);

} // namespace cadrefine
