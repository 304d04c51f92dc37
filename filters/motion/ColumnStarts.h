// On which facets of which walls columns stand.
#pragma once

#include "motion/ColumnClimb.h"
#include "motion/Columns.h"

#include <vector>

namespace cadrefine
{

/// A column is at most so many times as high as the move of its wall: over that the move may fade
/// out, as no height changes by more than some hundredths, and the first one not by one.
inline constexpr double reachOfMove = 100;

struct ColumnStarts
{
  /// For each node, the cosine between its move and the normal of the facet that its column stands
  /// on; -1: it has no column.
  std::vector<double> cosines;
  std::vector<ColumnVisit> visits; ///< What columns come to on this rank, see ColumnClimb::run.
};

/// Finds the facets of the walls, `columns.facets`, and lets columns climb from those at moving
/// nodes: of several the one whose normal is nearest to the move. Collective.
ColumnStarts startColumns(RankExchange& exchange, const Moves& moves,
  const BoundarySearch& boundary, const CellStacks& stacks, Columns& columns);

} // namespace cadrefine
