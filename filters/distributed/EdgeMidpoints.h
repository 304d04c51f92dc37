// The middles of edges over all ranks: their ids, and where they belong on the CAD.
#pragma once

#include "BoundaryProjector.h"
#include "CADArrays.h"
#include "DistributedBoundary.h"
#include "DistributedMesh.h"
#include "EdgeTable.h"
#include "LongestEdgeMarking.h"
#include "RunStatistics.h"
#include "SharedEdges.h"
#include "Split.h"

#include <array>
#include <vector>

namespace cadrefine
{

/// The edges of a piece, and which of them have a point in their middle.
struct MarkedEdges
{
  EdgeTable table;
  SharedEdges sharedEdges;
  EdgeMarks marks;
};

/// With this mark for all edges. Collective; work of buildEdgeTable, messages of findSharedEdges.
MarkedEdges findEdges(RankExchange& exchange, const DistributedMesh& mesh, unsigned char mark);

/// Ids of the midpoints of edges, given their ends, from the order of the ids of these: larger than
/// all ids so far. Collective (see numberAtVertices).
std::vector<GlobalId> numberMidpoints(RankExchange& exchange, DistributedMesh& mesh,
  const std::vector<std::array<Index, 2>>& parentEdges);

/// The classes of all edges of a piece (see classifyBoundary), also of those whose boundary facets
/// are on other ranks, as numbers: 0 for an edge inside the mesh. Collective.
std::vector<std::int64_t> edgeCodes(
  RankExchange& exchange, const MarkedEdges& edges, const ClassifiedBoundary& classified);

/// A midpoint that belongs onto the CAD.
struct MidpointOnCAD
{
  std::size_t place; ///< Among the midpoints of marked edges.
  ClosestPoint where;
};

/// Where the midpoints of marked edges belong, by the class of their edge (S. Strunk, KTH 2013,
/// Algorithm 4.3). Collective; one projection each, shared out evenly over ranks and threads.
std::vector<MidpointOnCAD> projectMidpoints(RankExchange& exchange, const SimplexMesh& mesh,
  const MarkedEdges& edges, const std::vector<std::int64_t>& codes,
  const BoundaryProjector& projector, const Classification& classification,
  RunStatistics& statistics);

/// Appends the midpoints at their distance from the CAD, so that there are `count` entries.
void classifyMidpoints(
  const std::vector<MidpointOnCAD>& hits, std::size_t count, Classification& classification);

/// How many of these midpoints, numbered after `vertices` vertices, there are over all ranks, none
/// counted twice. Collective.
std::int64_t countHits(RankExchange& exchange, const SharedVertices& shared, std::size_t vertices,
  const std::vector<MidpointOnCAD>& hits);

} // namespace cadrefine
