// Making a mesh one of second order, its mid nodes on the CAD.
#pragma once

#include "classification/DistributedBoundary.h"
#include "comm/RunStatistics.h"
#include "mesh/DistributedMesh.h"

#include <cadrefine/classification/Classification.h>
#include <cadrefine/refinement/LongestEdgeMarking.h>

#include <cstdint>
#include <vector>

namespace cadrefine
{

/// Gives the mesh a mid node in the middle of each edge, shared by all ranks that have the edge,
/// with ids that follow from those of the ends. Collective; one numbering (see numberMidpoints).
void addMidNodes(RankExchange& exchange, DistributedMesh& mesh);

struct PlacedMidNodes
{
  std::int64_t projected = 0; ///< Nodes that belong onto the CAD, over all ranks.
  /// 1 for the cells of the mesh's own dimension that kept nodes from the CAD.
  std::vector<unsigned char> tooCurved = {};
};

/// Adds mid nodes as addMidNodes does, and moves those of edges on the CAD to where the class of
/// their edge in `classified`, the boundary of the mesh, says, as far as all cells stay valid (see
/// MidNodeGuard), but for those of pyramids; those of the edges over them in layers go along (see
/// LayerColumns). The classification gets an entry for each mid node, with what is left of its way
/// for a distance. With `move` false they stay in the middle, classified. Adds to the figures
/// "seconds mid nodes".
///
/// Collective. Work: that of LayerColumns, one projection for each edge on the CAD, shared out
/// evenly, and the sweeps of MidNodeGuard, at most 20 over cells whose nodes have changed.
/// Messages: those of these steps, and for each sweep an exchange of 8 bytes a shared edge and one
/// reduction.
PlacedMidNodes placeMidNodes(RankExchange& exchange, DistributedMesh& mesh,
  const ClassifiedBoundary& classified, Classification& classification, bool move,
  RunStatistics& statistics);

/// Takes the mid nodes away again. `idBound` is the bound of the ids of vertices.
void removeMidNodes(DistributedMesh& mesh, Classification& classification, GlobalId idBound);

/// Marks the longest edge of each of these cells, which are simplices. With `atCAD` the longest of
/// those that let the nodes get to the CAD: of the edges on it, which then bulge less; or, where
/// three of them meet at a corner, of the others, so that they no longer do. (The tangents of three
/// edges on a smooth surface lie nearly in a plane, however short they are.)
EdgeMarks edgesOfTooCurved(const DistributedMesh& mesh, const Classification& classification,
  const std::vector<unsigned char>& tooCurved, bool atCAD);

} // namespace cadrefine
