#include "error/DistributedError.h"

#include "classification/EdgeMidpoints.h"
#include "comm/CollectiveErrors.h"
#include "comm/LoadBalancedMap.h"
#include "comm/Threads.h"
#include "error/BoundaryAngles.h"

#include <cadrefine/classification/MidpointProjection.h>
#include <cadrefine/error/CurvedError.h>
#include <cadrefine/error/GeometricError.h>

#include <algorithm>

namespace cadrefine
{
namespace
{

ErrorFacet makeErrorFacet(const Mesh& mesh, const DistributedBoundary& boundary,
  const BoundaryClasses& classes, const Classification& classification, std::size_t f)
{
  ErrorFacet facet;
  facet.corners = classifiedFacet(mesh, classification.entities, boundary.facets[f]);
  for (int k = 0; k < 4; ++k)
  {
    const Index edge = boundary.facetEdges[f][k];
    facet.edges[k] = edge < 0 ? EdgeClass{} : classes.ofEdges[edge];
  }
  facet.offCAD = cornersOff(classification, boundary.facets[f]);
  return facet;
}

CurvedErrorFacet makeCurvedFacet(const DistributedMesh& mesh, const DistributedBoundary& boundary,
  const BoundaryClasses& classes, const Classification& classification, std::size_t f)
{
  CurvedErrorFacet facet{};
  facet.straight = makeErrorFacet(mesh.mesh(), boundary, classes, classification, f);
  facet.face = classes.facets[f].face;
  const MidNodes& midNodes = *mesh.converted.midNodes;
  const Facet& of = boundary.facets[f];
  for (int k = 0; k < of.edges(); ++k)
  {
    const Index edge = midNodes.table.find(of.vertices[k], of.vertices[(k + 1) % of.corners()]);
    const std::size_t point = mesh.mesh().points.size() + edge;
    facet.nodes[k] = midNodes.points[edge];
    facet.entities[k] = classification.entities[point];
    facet.offCAD[k] = classification.distances[point] > 0;
  }
  return facet;
}

/// The automatic depth: its extrapolation is nearer to the exact measure than depth 3, which costs
/// four times as much (see docs/methods.md).
constexpr int automaticDepth = 2;

/// Errors of these facets of cells of second order, in their order.
Answers<FacetError> measureCurved(RankExchange& exchange, const DistributedMesh& mesh,
  const ClassifiedBoundary& classified, const Classification& classification,
  const std::vector<std::size_t>& facets, int depth)
{
  std::vector<CurvedErrorFacet> queries;
  queries.reserve(facets.size());
  for (const std::size_t f : facets)
  {
    queries.push_back(
      makeCurvedFacet(mesh, classified.boundary, classified.classes, classification, f));
  }
  return mapBalanced<FacetError>(exchange, std::move(queries),
    [&](const CurvedErrorFacet& facet) { return curvedError(classified.projector, facet, depth); },
    { "measuring", "facets" });
}

/// The facets, with all vertices and edges of this rank's boundary. Collective.
ClassifiedSurface surfaceOf(RankExchange& exchange, const Mesh& mesh,
  const ClassifiedBoundary& classified, const Classification& classification,
  const std::vector<std::size_t>& facets)
{
  const DistributedBoundary& boundary = classified.boundary;
  ClassifiedSurface surface;
  surface.kind = boundary.kind;
  std::vector<Index> pointOf(mesh.points.size(), -1);
  std::vector<double> distances;
  const auto numbered = [&](Index vertex)
  {
    if (pointOf[vertex] < 0)
    {
      pointOf[vertex] = static_cast<Index>(surface.points.size());
      surface.points.push_back({ mesh.points[vertex], classification.entities[vertex] });
      distances.push_back(classification.distances[vertex]);
    }
    return pointOf[vertex];
  };
  const auto& ends = boundary.edges.edges();
  surface.edges.reserve(ends.size());
  for (std::size_t e = 0; e < ends.size(); ++e)
  {
    surface.edges.push_back(
      { { numbered(ends[e][0]), numbered(ends[e][1]) }, classified.classes.ofEdges[e] });
  }
  surface.facets.reserve(facets.size());
  Index quads = 0;
  for (const std::size_t f : facets)
  {
    const Facet& of = boundary.facets[f];
    SurfaceFacet& facet = surface.facets.emplace_back();
    std::transform(of.begin(), of.end(), facet.corners.begin(), numbered);
    facet.edges = boundary.facetEdges[f];
    facet.face = classified.classes.facets[f].face;
    facet.quad = of.corners() == 4 ? quads++ : -1;
  }
  const auto findPlace = [&](std::size_t p)
  {
    SurfacePoint& point = surface.points[p];
    if (distances[p] > 0)
    {
      const ClosestPoint where = classified.projector.nearestOn(point.entity, point.point);
      point.place = where.point;
      point.placeEntity = where.entity;
    }
  };
  const ParallelFor parallelFor = forOnThreads(exchange);
  agreeOnFailure(
    exchange, [&] { forEachIndex(parallelFor, surface.points.size(), coarseGrain, findPlace); });
  return surface;
}

/// The midpoints of all edges of the boundary, and the middles of those of these facets that are
/// quadrilaterals.
std::vector<ClosestPoint> midpointsOf(
  const ClassifiedBoundary& classified, const std::vector<std::size_t>& facets)
{
  const auto& all = *classified.midpoints;
  const std::size_t edges = classified.boundary.edges.edges().size();
  std::vector<ClosestPoint> chosen(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(edges));
  const std::vector<Index> quads = quadsOnCAD(classified);
  for (const std::size_t f : facets)
  {
    if (classified.boundary.facets[f].corners() == 4)
    {
      const auto quad = std::lower_bound(quads.begin(), quads.end(), static_cast<Index>(f));
      chosen.push_back(all[edges + (quad - quads.begin())]);
    }
  }
  return chosen;
}

/// How many runs keep the memory in bounds, on the rank with the most facets.
std::size_t runsFor(RankExchange& exchange, std::size_t facets, int depth)
{
  constexpr std::size_t most = 1 << 17; // facets of the last level
  const std::size_t all = facets << (2 * (depth - 1));
  return 1 + exchange.max(static_cast<std::int64_t>(all / most));
}

/// Errors of these facets, in their order.
std::vector<FacetError> measureStraight(RankExchange& exchange, const Mesh& mesh,
  const ClassifiedBoundary& classified, const Classification& classification,
  const std::vector<std::size_t>& facets, int depth)
{
  // And some more.
  const auto expected = static_cast<double>(std::max<std::size_t>(1, facets.size() << (2 * depth)));
  double done = 0;
  const auto project = [&](std::vector<BoundaryEdge> edges)
  {
    const double begin = std::min(1.0, done / expected);
    done += static_cast<double>(edges.size());
    const Progress::Part part(exchange.progress(), begin, std::min(1.0, done / expected));
    return mapBalanced<ClosestPoint>(exchange, std::move(edges),
      [&](const BoundaryEdge& edge) { return projectMidpoint(classified.projector, edge); },
      { "measuring", "edges" })
      .values;
  };
  return geometricErrors(surfaceOf(exchange, mesh, classified, classification, facets),
    midpointsOf(classified, facets), depth, runsFor(exchange, facets.size(), depth), project);
}

/// Errors of these facets, in their order; those that are in the cache are taken from there.
std::vector<FacetError> measureOrRemember(RankExchange& exchange, const DistributedMesh& mesh,
  const ClassifiedBoundary& classified, const Classification& classification,
  const std::vector<std::size_t>& facets, int depth, const BoundaryCache& cache)
{
  std::vector<FacetError> errors(facets.size());
  std::vector<std::size_t> fresh;     // among the facets
  std::vector<std::size_t> toMeasure; // facets
  for (std::size_t i = 0; i < facets.size(); ++i)
  {
    const std::size_t f = facets[i];
    const Index known = classified.classes.known[f];
    const FacetError* error =
      known < 0
        ? nullptr
        : cache.error(known,
            makeErrorFacet(mesh.mesh(), classified.boundary, classified.classes, classification, f),
            depth);
    if (error)
    {
      errors[i] = *error;
    }
    else
    {
      fresh.push_back(i);
      toMeasure.push_back(f);
    }
  }
  const auto measured =
    measureStraight(exchange, mesh.mesh(), classified, classification, toMeasure, depth);
  for (std::size_t i = 0; i < fresh.size(); ++i)
  {
    errors[fresh[i]] = measured[i];
  }
  return errors;
}

/// Errors of these facets, in their order.
Answers<FacetError> measureFacets(RankExchange& exchange, const DistributedMesh& mesh,
  ClassifiedBoundary& classified, const Classification& classification,
  const std::vector<std::size_t>& facets, int depth, const BoundaryCache& cache)
{
  if (mesh.converted.midNodes)
  {
    return measureCurved(exchange, mesh, classified, classification, facets, depth);
  }
  Answers<FacetError> answers;
  {
    const Progress::Part part(exchange.progress(), 0, 0.2);
    answers.balance = findMidpoints(exchange, mesh.mesh(), classification, cache, classified);
  }
  const Progress::Part part(exchange.progress(), 0.2, 1);
  exchange.progress().say(0, "measuring facets");
  answers.values =
    measureOrRemember(exchange, mesh, classified, classification, facets, depth, cache);
  return answers;
}

} // namespace

void Deviation::add(const Deviation& other)
{
  distance = std::max(distance, other.distance);
  chord = std::max(chord, other.chord);
  angle = std::max(angle, other.angle);
}

MeshError measureError(RankExchange& exchange, const DistributedMesh& mesh,
  ClassifiedBoundary& classified, const Classification& classification, const ErrorScope& scope,
  BoundaryCache& cache, bool remember)
{
  const Mesh& piece = mesh.mesh();
  const DistributedBoundary& boundary = classified.boundary;
  std::vector<std::size_t> facets;
  for (std::size_t f = 0; f < boundary.facets.size(); ++f)
  {
    if (classified.classes.facets[f].onCAD)
    {
      facets.push_back(f);
    }
  }
  const bool isAutomatic = scope.depth == 0;
  const int levels = isAutomatic ? automaticDepth : scope.depth;
  const auto answers =
    measureFacets(exchange, mesh, classified, classification, facets, levels, cache);
  if (remember && !mesh.converted.midNodes)
  {
    cache = BoundaryCache(piece, classification, classified, answers.values, levels);
    classified.classes.known.assign(boundary.facets.size(), -1);
    for (std::size_t i = 0; i < facets.size(); ++i)
    {
      classified.classes.known[facets[i]] = static_cast<Index>(i);
    }
  }
  const auto angles = neighbourAngles(exchange, mesh, classified, classification);

  MeshError result;
  result.dimension = boundary.facetDimension() + 1;
  result.ofCells.resize(mesh.converted.cellIds[piece.dimension].size());
  std::vector<double> addends;
  for (std::size_t i = 0; i < facets.size(); ++i)
  {
    if (!scope.counted.empty() && !scope.counted[facets[i]])
    {
      continue;
    }
    const FacetError& error = answers.values[i];
    CellError& cell = result.ofCells[boundary.facets[facets[i]].cell];
    const double measure = isAutomatic ? extrapolatedMeasure(error) : error.measure;
    cell.measure += measure;
    cell.largest.add({ error.largestDistance, error.chordError, angles[facets[i]] });
    addends.push_back(measure);
  }
  for (const CellError& cell : result.ofCells)
  {
    result.largest.add(cell.largest);
  }
  result.balance = answers.balance;
  result.global = exchange.sumReproducibly(addends);
  const Deviation& mine = result.largest;
  const auto all = exchange.max(std::vector<double>{ mine.distance, mine.chord, mine.angle });
  result.largest = { all[0], all[1], all[2] };
  return result;
}

} // namespace cadrefine
