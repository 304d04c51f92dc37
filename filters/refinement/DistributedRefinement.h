// One level of refinement over all ranks.
#pragma once

#include "classification/DistributedBoundary.h"
#include "classification/EdgeMidpoints.h"
#include "comm/RunStatistics.h"
#include "mesh/DistributedMesh.h"
#include "motion/BoundaryMotion.h"

#include <cadrefine/base/Moves.h>
#include <cadrefine/refinement/RefinementTrace.h>

#include <vector>

namespace cadrefine
{

/// Which edges of a piece are cut.
struct RefinementPlan : MarkedEdges
{
  SharedQuads quads = {}; ///< All quadrilaterals of the piece.
  bool uniform = false;
};

/// Marks all edges. Throws Error where a cell would be cut badly (see cellsCutBadly). Collective.
RefinementPlan planUniform(RankExchange& exchange, const DistributedMesh& mesh);

/// The boundary of a mesh whose marked cells' facets are to be cut.
struct FacetsToCut
{
  const ClassifiedBoundary& boundary;
  const Classification& classification;
};

/// Marks the longest edges of the marked cells (one entry for each cell of the mesh's own
/// dimension; see markLongestEdges), with `toCut` also those of markFacets, and others until no
/// vertex hangs on any rank. A simplex is bisected at the longest of its marked edges first. Where
/// cells would be cut badly (see cellsCutBadly) all of their edges are marked; throws Error where
/// that does not help. Collective; one message to each neighbour, of a byte a shared edge, for
/// every time that marks cross between ranks.
RefinementPlan planLongestEdge(RankExchange& exchange, const DistributedMesh& mesh,
  const std::vector<unsigned char>& cellMarks, const FacetsToCut* toCut, bool keepLayers);

/// Marks these edges, and others until no vertex hangs on any rank, as planLongestEdge.
RefinementPlan planFromEdges(
  RankExchange& exchange, const DistributedMesh& mesh, const EdgeMarks& edges, bool keepLayers);

/// The children that `refine` makes of each cell.
ChildRanges countChildren(const Mesh& mesh, const RefinementPlan& plan);

/// Cuts the mesh as planned (new vertices at midpoints; new ids by a parallel sort of the ids of
/// the edges' ends, so that they do not depend on the partition). What is shared with other ranks
/// follows from what was. Adds to the figures "seconds cutting" and "seconds numbering".
/// Collective.
RefinementTrace refine(RankExchange& exchange, DistributedMesh& mesh, const RefinementPlan& plan,
  RunStatistics& statistics);

/// Global ids of the children, by their dimension: parents in the order of their ids, the children
/// of each, of which there may be none, in a row. Collective (see denseOffsets).
std::array<std::vector<GlobalId>, 4> numberChildren(
  RankExchange& exchange, const DistributedMesh& mesh, const RefinementTrace& trace);

/// What is done with the new vertices of classified edges.
enum class NewVertices
{
  MoveOntoCAD,
  /// As MoveOntoCAD, and cells that are inverted or flat are mended (see MoveSettings).
  MoveAndMend,
  StayStraight ///< The new vertices are classified, and keep their distance from the CAD.
};

struct CutSettings
{
  NewVertices newVertices;
  /// Hashes of the tags of the cells of the mesh's own dimension (none on any rank: there are no
  /// tags); what they tell apart makes no way (see verticesBetweenTags).
  std::vector<std::uint64_t> tags;
};

/// What a cut onto the CAD did: first cells were cut, with the new vertices at the middles of
/// edges, then vertices moved (StayStraight: none did).
struct CutOntoCAD
{
  RefinementTrace trace;
  MotionTrace motion;
};

/// Cuts the mesh as `refine` does, and classifies the new vertices of classified edges: each
/// belongs onto the entity of its edge in `classified`, the boundary of the mesh (S. Strunk, KTH
/// 2013, Algorithm 4.3). MoveOntoCAD moves them there as far as all cells stay valid; vertices that
/// stopped on the way earlier try again. Adds to "seconds projection" and "seconds moves" too.
/// Collective.
CutOntoCAD refineOntoCAD(RankExchange& exchange, DistributedMesh& mesh, const RefinementPlan& plan,
  const ClassifiedBoundary& classified, Classification& classification, const CutSettings& settings,
  RunStatistics& statistics);

} // namespace cadrefine
