// The first edges over the nodes of walls, and how far new ones go to be as long as their
// neighbours.
#pragma once

#include "motion/ColumnClimb.h"

#include <cadrefine/base/Moves.h>
#include <cadrefine/base/Vector3.h>
#include <cadrefine/classification/BoundaryProjector.h>
#include <cadrefine/mesh/Facets.h>
#include <cadrefine/motion/CellStacks.h>

#include <vector>

namespace cadrefine
{

/// The edge from a node of a wall to the first node over it.
struct FirstEdge
{
  Vector3 up{}; ///< Zero: there is none.
  /// Its length, or, if it is halfway between two edges that are equally long, that of these.
  double wantedLength = 0;
  bool onBoundary = false; ///< Whether its upper end is on the boundary, too.
  /// The edge once the wall's node has moved, of the wanted length.
  Vector3 lifted{};
};

/// Finds the first edge over each node of these facets; of several the shortest. `onBoundary`: 1
/// for nodes on the boundary, over all ranks. Needs the parents of the nodes. Collective. Work:
/// linear in facets and nodes, and three closest points for each edge that is too short.
std::vector<FirstEdge> findFirstEdges(RankExchange& exchange, const CellStacks& stacks,
  const ColumnNodes& nodes, const std::vector<Facet>& facets, const Moves& moves,
  const BoundaryProjector& projector, const std::vector<unsigned char>& onBoundary);

} // namespace cadrefine
