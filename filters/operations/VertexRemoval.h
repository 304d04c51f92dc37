// Which vertices a level of coarsening takes out.
#pragma once

#include "classification/DistributedBoundary.h"
#include "mesh/DistributedMesh.h"

#include <cadrefine/classification/Classification.h>

#include <vector>

namespace cadrefine
{

/// Flags vertices so that those without a flag are a maximal independent set among those that may
/// go (`mayGo`, a flag for each vertex), and all others: each flagged vertex has a neighbour
/// without a flag that it can be collapsed into, and of those that may go no two are left that
/// could be collapsed into each other. A vertex on a CAD edge goes along that, one on a CAD face
/// along the surface, one on flat boundary off the CAD along that, and one on a straight crease of
/// it along the crease; one on a CAD vertex stays. Vertices are taken with the least free ones
/// first, and then in the order of their ids (lexicographically first maximal independent set): the
/// set is unique, the same on any number of ranks. Vertices of uniform refinement have larger ids
/// than those before it, and go.
///
/// The mesh must be classified. Collective. Work: linear in the cells but for sorts; messages:
/// those of findSharedEdges, and a byte a shared vertex and a reduction for each time that a
/// decision has to wait for another rank's. (D. Ibanez, "Conformal mesh adaptation on heterogeneous
/// supercomputers", RPI 2016, chapter on independent sets; G. Miller, D. Talmor, S.-H. Teng,
/// "Optimal coarsening of unstructured meshes", J. Algorithms 31, 1999.)
std::vector<unsigned char> verticesToRemove(RankExchange& exchange, const DistributedMesh& mesh,
  const Classification& classification, const ClassifiedBoundary& boundary,
  const std::vector<unsigned char>& mayGo);

} // namespace cadrefine
