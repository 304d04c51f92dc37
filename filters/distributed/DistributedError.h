// Geometric error of a mesh in pieces.
#pragma once

#include "CADArrays.h"
#include "DistributedMesh.h"
#include "EvenWork.h"

#include <vector>

namespace cadrefine
{

/// For the cells of the mesh's own dimension, and over all ranks.
struct MeshError
{
  std::vector<double> ofCells; ///< Area or volume between the cell's CAD facets and the CAD.
  std::vector<double> distanceOfCells; ///< Largest distance found from these facets to the CAD.
  int dimension = 0;                   ///< Of what the error measures: 2 area, 3 volume.
  double global = 0;
  double maximumDistance = 0;
  WorkBalance balance; ///< Of the facets over the ranks.
};

/// Error of every facet on the CAD, added up for its cell (see geometricError). The global sum is
/// bit for bit the same for every partition. Throws Error for points alone.
///
/// Collective. Work: that of findBoundary and classifyBoundary, and the projections of
/// geometricError, at most 3 (1 + 4 + ... + 4^(depth-1)) a facet on the CAD, shared out evenly over
/// ranks and threads. Messages: a few exchanges of the interface, those of answerEvenly, and a few
/// reductions of up to four numbers.
MeshError measureError(RankExchange& exchange, const DistributedMesh& mesh, const CADModel& model,
  const Classification& classification, int depth);

} // namespace cadrefine
