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

/// From a node of a wall to the first one over it.
struct FirstEdge
{
  Vector3 up{}; ///< Zero: there is none.
  /// As long as it is, or, if it is halfway between two that are equally long, as these.
  double wantedLength = 0;
  bool onBoundary = false; ///< Its upper end, too.
  /// What it will be, once the wall's node has moved: of that length.
  Vector3 lifted{};
};

/// Over each node of these facets; of several the shortest. `onBoundary`: 1 for nodes there, over
/// all ranks. Needs the parents of the nodes. Collective. Work: linear in facets and nodes, and
/// three closest points for each edge that is too short.
std::vector<FirstEdge> findFirstEdges(RankExchange& exchange, const CellStacks& stacks,
  const ColumnNodes& nodes, const std::vector<Facet>& facets, const Moves& moves,
  const BoundaryProjector& projector, const std::vector<unsigned char>& onBoundary);

} // namespace cadrefine
