// Geometric error of a mesh in pieces.
#pragma once

#include "classification/BoundaryCache.h"
#include "classification/DistributedBoundary.h"
#include "comm/LoadBalancedMap.h"
#include "mesh/DistributedMesh.h"

#include <cadrefine/classification/Classification.h>

#include <vector>

namespace cadrefine
{

/// How far facets are from the CAD: the largest of each.
struct Deviation
{
  double distance = 0; ///< Distance found from the facets to the CAD.
  double chord = 0;    ///< Distance from the middle of an edge of the facets to the CAD.
  double angle = 0;    ///< Angle between neighbouring facets, in degrees (see neighbourAngles).

  void add(const Deviation& other);
};

struct CellError
{
  double measure = 0; ///< Area or volume between the cell's CAD facets and the CAD.
  Deviation largest;
};

struct MeshError
{
  std::vector<CellError> ofCells; ///< Errors of the cells of the mesh's own dimension.
  int dimension = 0;              ///< Dimension of what the error measures: 2 area, 3 volume.
  double global = 0;              ///< Measure of all facets of all ranks.
  Deviation largest;              ///< The largest of all ranks.
  /// Balance of the boundary edges over the ranks; of cells of second order, that of the facets.
  WorkBalance balance;
};

/// What of the boundary is measured, and how.
struct ErrorScope
{
  int depth = 1;                      ///< 0: automatic.
  std::vector<unsigned char> counted; ///< A flag for each facet that is added up; empty: all are.
};

/// Measures the error of every facet on the CAD, added up for its cell (see geometricErrors; for a
/// mesh of second order curvedError, and the classification has entries for mid nodes after those
/// of vertices). Automatic depth: the extrapolation (see extrapolatedMeasure) of a small one. The
/// global sum is bit for bit the same for every partition. Fills classified.midpoints. `cache` is
/// that to which classified.classes.known refers; with `remember` it becomes that of this boundary
/// (not of second order).
///
/// Collective. Work: the projections of geometricErrors, or of curvedError, shared out evenly over
/// ranks and threads. Messages: those of mapBalanced for each level of depth, and a few reductions
/// of up to four numbers.
MeshError measureError(RankExchange& exchange, const DistributedMesh& mesh,
  ClassifiedBoundary& classified, const Classification& classification, const ErrorScope& scope,
  BoundaryCache& cache, bool remember);

} // namespace cadrefine
