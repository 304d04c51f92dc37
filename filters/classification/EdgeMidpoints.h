// The middles of edges over all ranks: their ids, and where they belong on the CAD.
#pragma once

#include "classification/DistributedBoundary.h"
#include "comm/LoadBalancedMap.h"
#include "comm/RunStatistics.h"
#include "comm/SharedEdges.h"
#include "mesh/DistributedMesh.h"

#include <cadrefine/classification/BoundaryProjector.h>
#include <cadrefine/classification/Classification.h>
#include <cadrefine/mesh/EdgeTable.h>
#include <cadrefine/mesh/QuadTable.h>
#include <cadrefine/refinement/LongestEdgeMarking.h>

#include <array>
#include <tuple>
#include <vector>

namespace cadrefine
{

/// The edges of a piece, and which of them have a point in their middle.
struct MarkedEdges
{
  EdgeTable table;
  SharedEdges sharedEdges;
  EdgeMarks marks;
  /// Local operations follow: see offBorder in MidpointProjection.h and MoveSettings::smoothWorst.
  bool withOperations = false;
};

/// The quadrilaterals of a piece.
struct SharedQuads
{
  bool any = false; ///< Whether any rank has quadrilaterals.
  QuadTable table;
  /// Corners of each quadrilateral: the ends of its first and third edge in the table.
  std::vector<std::array<Index, 4>> corners;
  SharedItems shared;
};

/// Finds the quadrilaterals of a piece. Collective; work of buildQuadTable, messages of
/// findSharedCells.
SharedQuads findQuads(RankExchange& exchange, const DistributedMesh& mesh, const EdgeTable& table);

/// Finds the edges of a piece, all with this mark. Collective; work of buildEdgeTable, messages of
/// findSharedEdges.
MarkedEdges findEdges(RankExchange& exchange, const DistributedMesh& mesh, unsigned char mark);

/// Global ids of the midpoints of edges with these ends, in the order of the ids of the ends: from
/// `idBound` on, which is raised above them. Collective (see numberAtVertices).
std::vector<GlobalId> numberMidpoints(RankExchange& exchange, const SharedVertices& shared,
  const std::vector<GlobalId>& ids, GlobalId& idBound,
  const std::vector<std::array<Index, 2>>& parentEdges);

/// The facets that are quadrilaterals on the CAD, ascending.
std::vector<Index> quadsOnCAD(const ClassifiedBoundary& classified);

/// How an edge or a quadrilateral of a piece lies on the boundary, as all ranks together know. Of
/// what ranks have, the largest counts: a rank without a facet there has the smallest.
struct SharedClass
{
  std::int32_t onBoundary = 0; ///< 1: it is on the boundary of the mesh.
  EdgeClass edgeClass;         ///< A quadrilateral on the CAD is Smooth.

  friend bool operator<(const SharedClass& a, const SharedClass& b)
  {
    return std::tie(a.onBoundary, a.edgeClass.entity, a.edgeClass.kind) <
           std::tie(b.onBoundary, b.edgeClass.entity, b.edgeClass.kind);
  }
};

/// The classes of all edges of a piece (see classifyBoundary), and of all quadrilaterals, also of
/// those whose boundary facets are on other ranks. Collective.
std::vector<SharedClass> classesOfEdges(
  RankExchange& exchange, const MarkedEdges& edges, const ClassifiedBoundary& classified);
std::vector<SharedClass> classesOfQuads(RankExchange& exchange, const EdgeTable& table,
  const SharedQuads& quads, const ClassifiedBoundary& classified);

/// A midpoint that belongs onto the CAD.
struct MidpointOnCAD
{
  /// Its place among the midpoints of marked edges, and after these of marked quadrilaterals.
  std::size_t place;
  ClosestPoint where;
};

/// Projects the midpoints of all boundary edges and quadrilaterals on the CAD (see
/// ClassifiedBoundary::midpoints). Collective;
/// one projection for each that does not stay straight and is not in the cache, shared out evenly
/// over ranks and threads.
WorkBalance findMidpoints(RankExchange& exchange, const Mesh& mesh,
  const Classification& classification, const BoundaryCache& cache, ClassifiedBoundary& classified);

/// Where the midpoints of marked edges belong, by the class of their edge (S. Strunk, KTH 2013,
/// Algorithm 4.3). Collective; one projection for each that is not known yet, shared out as in
/// findMidpoints.
std::vector<MidpointOnCAD> projectMidpoints(RankExchange& exchange, const Mesh& mesh,
  const MarkedEdges& edges, const std::vector<SharedClass>& classes,
  const ClassifiedBoundary& classified, const Classification& classification,
  RunStatistics& statistics);

/// Quadrilaterals of a piece that have a point in their middle, and the classes of all.
struct MarkedQuads
{
  const SharedQuads& all;
  const std::vector<Index>& marked;
  const std::vector<SharedClass>& classes;
  std::size_t firstPlace; ///< Place of the first of their midpoints, see MidpointOnCAD.
};

/// Appends where the middles of marked quadrilaterals belong. Collective; one projection for each
/// on the CAD, shared out as in findMidpoints.
void projectQuads(RankExchange& exchange, const Mesh& mesh, const MarkedQuads& quads,
  const ClassifiedBoundary& classified, const Classification& classification,
  std::vector<MidpointOnCAD>& hits);

/// Appends entries for new vertices, so that there are `count`: midpoints get their places on the
/// CAD, and their distance from it.
void classifyMidpoints(
  const std::vector<MidpointOnCAD>& hits, std::size_t count, Classification& classification);

/// How many of these midpoints, numbered after `vertices` vertices, there are over all ranks, none
/// counted twice. Collective.
std::int64_t countHits(RankExchange& exchange, const SharedVertices& shared, std::size_t vertices,
  const std::vector<MidpointOnCAD>& hits);

} // namespace cadrefine
