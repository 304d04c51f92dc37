// Geometric error of a mesh in pieces.
#pragma once

#include "CADArrays.h"
#include "DistributedMesh.h"
#include "EvenWork.h"

#include <vector>

namespace cadrefine
{

/// How far facets are from the CAD: the largest of each.
struct Deviation
{
  double distance = 0; ///< Found from the facets to the CAD.
  double chord = 0;    ///< From the middle of an edge of the facets to the CAD.
  double angle = 0;    ///< Between neighbouring facets, in degrees (see neighbourAngles).

  void add(const Deviation& other);
};

struct CellError
{
  double measure = 0; ///< Area or volume between the cell's CAD facets and the CAD.
  Deviation largest;
};

struct MeshError
{
  std::vector<CellError> ofCells; ///< Of the mesh's own dimension.
  int dimension = 0;              ///< Of what the error measures: 2 area, 3 volume.
  double global = 0;              ///< Measure of all facets of all ranks.
  Deviation largest;              ///< Of all ranks.
  WorkBalance balance;            ///< Of the facets over the ranks.
};

/// Error of every facet on the CAD, added up for its cell (see geometricError; of a mesh of second
/// order curvedError, and the classification has entries for mid nodes after those of vertices).
/// The global sum is bit for bit the same for every partition. Throws Error for points alone.
///
/// Collective. Work: that of findBoundary and classifyBoundary, and the projections of
/// geometricError, at most 3 (1 + 4 + ... + 4^(depth-1)) a facet on the CAD, shared out evenly over
/// ranks and threads. Messages: a few exchanges of the interface, those of answerEvenly, and a few
/// reductions of up to four numbers.
MeshError measureError(RankExchange& exchange, const DistributedMesh& mesh, const CADModel& model,
  const Classification& classification, int depth);

} // namespace cadrefine
