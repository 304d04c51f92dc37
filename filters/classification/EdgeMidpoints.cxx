#include "classification/EdgeMidpoints.h"

#include "classification/BoundaryCache.h"
#include "classification/MidpointSides.h"
#include "comm/GlobalNumbering.h"
#include "comm/VertexNumbering.h"

#include <cadrefine/base/IndicesWhere.h>
#include <cadrefine/base/LargeMemory.h>
#include <cadrefine/classification/MidpointProjection.h>
#include <cadrefine/error/GeometricError.h>

#include <algorithm>
#include <utility>

namespace cadrefine
{
namespace
{

BoundaryEdge edgeOf(const EdgeClass& edgeClass, const std::array<Index, 2>& ends, const Mesh& mesh,
  const Classification& classification)
{
  const auto [a, b] = ends;
  return { edgeClass, { mesh.points[a], mesh.points[b] },
    { classification.entities[a], classification.entities[b] } };
}

/// The edge whose midpoint is the middle of a facet that is a quadrilateral on the CAD.
BoundaryEdge middleOfFacet(const Mesh& mesh, const Classification& classification,
  const ClassifiedBoundary& classified, Index f)
{
  const ClassifiedFacet facet =
    classifiedFacet(mesh, classification.entities, classified.boundary.facets[f]);
  return middleOfQuad(facet.points, facet.entities, classified.classes.facets[f].face);
}

/// An edge of the piece whose midpoint is known.
struct KnownMidpoint
{
  Index edge;
  Index boundaryEdge;

  bool operator<(const KnownMidpoint& other) const { return edge < other.edge; }
};

/// The edges whose midpoints are known, in their order.
std::vector<KnownMidpoint> findKnown(const EdgeTable& table, const ClassifiedBoundary& classified)
{
  std::vector<KnownMidpoint> known;
  if (classified.midpoints)
  {
    const auto& ends = classified.boundary.edges.edges();
    for (std::size_t e = 0; e < ends.size(); ++e)
    {
      known.push_back({ table.find(ends[e][0], ends[e][1]), static_cast<Index>(e) });
    }
  }
  std::sort(known.begin(), known.end());
  return known;
}

/// For each edge at which the CAD meets an outer facet that is not on it, the normal of that facet,
/// or its opposite; zero for other edges. Empty where there are no such edges on any rank.
/// Collective.
std::vector<Vector3> findWalls(
  RankExchange& exchange, const MarkedEdges& edges, const ClassifiedBoundary& classified)
{
  const DistributedBoundary& boundary = classified.boundary;
  std::vector<std::pair<Index, Vector3>> found;
  for (std::size_t f = 0; f < boundary.facets.size(); ++f)
  {
    const FacetRecord& record = classified.classes.facets[f];
    const bool isWall = !record.onCAD && !record.free && !record.isInside;
    for (int k = 0; k < boundary.facets[f].edges() && isWall; ++k)
    {
      const Index edge = boundary.facetEdges[f][k];
      if (classified.classes.ofEdges[edge].kind == EdgeClass::Smooth)
      {
        const auto& [a, b] = boundary.edges.edges()[edge];
        found.emplace_back(edges.table.find(a, b), std::max(record.normal, -1.0 * record.normal));
      }
    }
  }
  std::vector<Vector3> walls;
  if (boundary.kind == BoundaryKind::Faces && exchange.any(!found.empty()))
  {
    walls.resize(edges.table.edges.size());
    for (const auto& [edge, normal] : found)
    {
      walls[edge] = std::max(walls[edge], normal);
    }
    combineLargest(exchange, edges.sharedEdges, walls);
  }
  return walls;
}

/// Fills in the midpoints that are in the cache. Returns 1 for the boundary edges of these.
std::vector<unsigned char> rememberMidpoints(
  const BoundaryCache& cache, ClassifiedBoundary& classified)
{
  const auto& [ofEdges, facets, known] = classified.classes;
  std::vector<unsigned char> isKnown(ofEdges.size(), 0);
  for (std::size_t f = 0; f < facets.size(); ++f)
  {
    for (int k = 0; k < 4 && known[f] >= 0; ++k)
    {
      const Index edge = classified.boundary.facetEdges[f][k];
      const ClosestPoint* midpoint =
        edge < 0 || isKnown[edge] ? nullptr : cache.midpoint(known[f], k, ofEdges[edge]);
      if (midpoint)
      {
        (*classified.midpoints)[edge] = *midpoint;
        isKnown[edge] = 1;
      }
    }
  }
  return isKnown;
}

} // namespace

std::vector<Index> quadsOnCAD(const ClassifiedBoundary& classified)
{
  return indicesWhere(classified.boundary.facets.size(), [&](std::size_t f)
    { return classified.boundary.facets[f].corners() == 4 && classified.classes.facets[f].onCAD; });
}

MarkedEdges findEdges(RankExchange& exchange, const DistributedMesh& mesh, unsigned char mark)
{
  MarkedEdges edges;
  edges.table = buildEdgeTable(mesh.mesh());
  edges.sharedEdges = findSharedEdges(exchange, mesh.shared, mesh.mesh().ids, edges.table.edges);
  edges.marks.assign(edges.table.edges.size(), mark);
  return edges;
}

SharedQuads findQuads(RankExchange& exchange, const DistributedMesh& mesh, const EdgeTable& table)
{
  SharedQuads quads;
  quads.table = buildQuadTable(table);
  quads.any = exchange.any(!quads.table.edges.empty());
  if (quads.any)
  {
    for (const auto& edges : quads.table.edges)
    {
      const auto& [a, b] = table.edges[edges[0]];
      const auto& [c, d] = table.edges[edges[2]];
      quads.corners.push_back({ a, b, c, d });
    }
    quads.shared = findSharedCells(exchange, mesh.shared, mesh.mesh().ids, quads.corners);
  }
  return quads;
}

std::vector<GlobalId> numberMidpoints(RankExchange& exchange, const SharedVertices& shared,
  const std::vector<GlobalId>& ids, GlobalId& idBound,
  const std::vector<std::array<Index, 2>>& parentEdges)
{
  std::vector<VertexKey<1>> keys;
  resizeLong(keys, parentEdges.size());
  std::transform(parentEdges.begin(), parentEdges.end(), keys.begin(),
    [&](const std::array<Index, 2>& ends) {
      return VertexKey<1>{ ends[0], { ids[ends[1]] } };
    });
  Numbering numbering = numberAtVertices(exchange, shared, ids, keys);
  for (GlobalId& number : numbering.numbers)
  {
    number += idBound;
  }
  idBound += numbering.count;
  return std::move(numbering.numbers);
}

std::vector<SharedClass> classesOfEdges(
  RankExchange& exchange, const MarkedEdges& edges, const ClassifiedBoundary& classified)
{
  std::vector<SharedClass> classes(edges.table.edges.size());
  const auto& ends = classified.boundary.edges.edges();
  for (std::size_t e = 0; e < ends.size(); ++e)
  {
    classes[edges.table.find(ends[e][0], ends[e][1])] = { 1, classified.classes.ofEdges[e] };
  }
  combineLargest(exchange, edges.sharedEdges, classes);
  return classes;
}

WorkBalance findMidpoints(RankExchange& exchange, const Mesh& mesh,
  const Classification& classification, const BoundaryCache& cache, ClassifiedBoundary& classified)
{
  const auto& ends = classified.boundary.edges.edges();
  const std::vector<Index> quads = quadsOnCAD(classified);
  auto& midpoints = classified.midpoints.emplace(ends.size() + quads.size());
  const auto isKnown = rememberMidpoints(cache, classified);
  NumberedQueries<BoundaryEdge> asked;
  for (std::size_t e = 0; e < ends.size(); ++e)
  {
    const EdgeClass& edgeClass = classified.classes.ofEdges[e];
    if (edgeClass.kind != EdgeClass::Straight && !isKnown[e])
    {
      asked.add(e, edgeOf(edgeClass, ends[e], mesh, classification));
    }
  }
  for (std::size_t q = 0; q < quads.size(); ++q)
  {
    asked.add(ends.size() + q, middleOfFacet(mesh, classification, classified, quads[q]));
  }
  return answerBalanced<ClosestPoint>(
    exchange, std::move(asked),
    [&](const BoundaryEdge& edge) { return projectMidpoint(classified.projector, edge); },
    [&](std::size_t place, const ClosestPoint& where) { midpoints[place] = where; },
    { "projecting", "boundary edges" });
}

std::vector<MidpointOnCAD> projectMidpoints(RankExchange& exchange, const Mesh& mesh,
  const MarkedEdges& edges, const std::vector<SharedClass>& classes,
  const ClassifiedBoundary& classified, const Classification& classification,
  RunStatistics& statistics)
{
  const auto known = findKnown(edges.table, classified);
  auto next = known.begin();
  std::vector<MidpointOnCAD> midpoints;
  std::vector<Index> edgesOf;
  NumberedQueries<BoundaryEdge> asked; // by their place among these
  std::size_t place = 0;
  for (std::size_t e = 0; e < classes.size(); ++e)
  {
    const bool isKnown = next != known.end() && next->edge == static_cast<Index>(e);
    const Index boundaryEdge = isKnown ? (next++)->boundaryEdge : -1;
    const EdgeClass& edgeClass = classes[e].edgeClass;
    if (edges.marks[e] && edgeClass.kind != EdgeClass::Straight)
    {
      if (!isKnown)
      {
        asked.add(midpoints.size(), edgeOf(edgeClass, edges.table.edges[e], mesh, classification));
      }
      midpoints.push_back(
        { place, isKnown ? (*classified.midpoints)[boundaryEdge] : ClosestPoint{} });
      edgesOf.push_back(static_cast<Index>(e));
    }
    place += edges.marks[e];
  }
  const WorkBalance balance = answerBalanced<ClosestPoint>(
    exchange, std::move(asked),
    [&](const BoundaryEdge& edge) { return projectMidpoint(classified.projector, edge); },
    [&](std::size_t i, const ClosestPoint& where) { midpoints[i].where = where; },
    { "projecting", "new vertices" });
  recordBalance(statistics, "new points", balance);
  const auto edgeAt = [&](std::size_t i)
  {
    const Index e = edgesOf[i];
    return edgeOf(classes[e].edgeClass, edges.table.edges[e], mesh, classification);
  };
  turnToFacets(exchange, edges, classified, classification, edgesOf, edgeAt, midpoints);
  const bool staysOffBorders = edges.withOperations || exchange.any(mesh.hasNonSimplices());
  const std::vector<Vector3> walls = findWalls(exchange, edges, classified);
  for (std::size_t i = 0; (staysOffBorders || !walls.empty()) && i < midpoints.size(); ++i)
  {
    const BoundaryEdge edge = edgeAt(i);
    ClosestPoint& where = midpoints[i].where;
    where = staysOffBorders ? offBorder(classified.projector, edge, where) : where;
    where = walls.empty() ? where : inPlane(classified.projector, edge, where, walls[edgesOf[i]]);
  }
  midpoints.erase(std::remove_if(midpoints.begin(), midpoints.end(),
                    [](const MidpointOnCAD& midpoint) { return !midpoint.where.entity; }),
    midpoints.end());
  return midpoints;
}

std::vector<SharedClass> classesOfQuads(RankExchange& exchange, const EdgeTable& table,
  const SharedQuads& quads, const ClassifiedBoundary& classified)
{
  std::vector<SharedClass> classes(quads.corners.size());
  const DistributedBoundary& boundary = classified.boundary;
  for (std::size_t f = 0; f < boundary.facets.size(); ++f)
  {
    if (boundary.facets[f].corners() == 4)
    {
      std::array<Index, 4> edges;
      std::transform(boundary.facetEdges[f].begin(), boundary.facetEdges[f].end(), edges.begin(),
        [&](Index edge)
        {
          const auto& [a, b] = boundary.edges.edges()[edge];
          return table.find(a, b);
        });
      const FacetRecord& record = classified.classes.facets[f];
      classes[quads.table.find(edges)] = { 1,
        record.onCAD ? EdgeClass{ EdgeClass::Smooth, record.face } : EdgeClass{} };
    }
  }
  combineLargest(exchange, quads.shared, classes);
  return classes;
}

void projectQuads(RankExchange& exchange, const Mesh& mesh, const MarkedQuads& quads,
  const ClassifiedBoundary& classified, const Classification& classification,
  std::vector<MidpointOnCAD>& hits)
{
  if (!quads.all.any)
  {
    return;
  }
  NumberedQueries<BoundaryEdge> asked;
  for (std::size_t i = 0; i < quads.marked.size(); ++i)
  {
    const auto& corners = quads.all.corners[quads.marked[i]];
    const EdgeClass& facetClass = quads.classes[quads.marked[i]].edgeClass;
    if (facetClass.kind != EdgeClass::Straight)
    {
      std::array<Point3, 4> points;
      std::array<EntityId, 4> entities;
      for (int k = 0; k < 4; ++k)
      {
        points[k] = mesh.points[corners[k]];
        entities[k] = classification.entities[corners[k]];
      }
      asked.add(quads.firstPlace + i, middleOfQuad(points, entities, facetClass.entity));
    }
  }
  answerBalanced<ClosestPoint>(
    exchange, std::move(asked),
    [&](const BoundaryEdge& middle)
    {
      const ClosestPoint where = projectMidpoint(classified.projector, middle);
      return where.entity ? offBorder(classified.projector, middle, where) : where;
    },
    [&](std::size_t place, const ClosestPoint& where)
    {
      if (where.entity)
      {
        hits.push_back({ place, where });
      }
    },
    { "projecting", "new vertices" });
}

void classifyMidpoints(
  const std::vector<MidpointOnCAD>& hits, std::size_t count, Classification& classification)
{
  const std::size_t oldCount = classification.entities.size();
  classification.resize(count);
  for (const MidpointOnCAD& hit : hits)
  {
    classification.set(static_cast<Index>(oldCount + hit.place), hit.where);
    classification.distances[oldCount + hit.place] = hit.where.distance;
  }
}

std::int64_t countHits(RankExchange& exchange, const SharedVertices& shared, std::size_t vertices,
  const std::vector<MidpointOnCAD>& hits)
{
  return exchange.sum(std::count_if(hits.begin(), hits.end(),
    [&](const MidpointOnCAD& hit)
    { return shared.owner(static_cast<Index>(vertices + hit.place)) == exchange.rank(); }));
}

} // namespace cadrefine
