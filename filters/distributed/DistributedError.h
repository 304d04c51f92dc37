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
  double global = 0;
  double maximumDistance = 0;
  WorkBalance balance; ///< Of the facets over the ranks.
};

/// Error of every facet on the CAD, added up for its cell (see geometricError). The global sum is
/// bit for bit the same for every partition. The facets are shared out evenly over ranks and
/// threads. Throws Error for points alone. Collective.
MeshError measureError(RankExchange& exchange, const DistributedMesh& mesh, const CADModel& model,
  const Classification& classification, int depth);

} // namespace cadrefine
