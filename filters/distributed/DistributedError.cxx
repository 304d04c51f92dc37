#include "DistributedError.h"

#include "BoundaryAngles.h"
#include "CurvedError.h"
#include "Error.h"
#include "EvenWork.h"
#include "GeometricError.h"

#include <algorithm>

namespace cadrefine
{
namespace
{

ErrorFacet makeErrorFacet(const SimplexMesh& mesh, const DistributedBoundary& boundary,
  const BoundaryClasses& classes, const Classification& classification, std::size_t f)
{
  ErrorFacet facet;
  facet.corners = classifiedFacet(mesh, classification.entities, boundary.facets[f], boundary.kind);
  for (int k = 0; k < 3; ++k)
  {
    const Index edge = boundary.facetEdges[f][k];
    facet.edges[k] = edge < 0 ? EdgeClass{} : classes.ofEdges[edge];
    const Index vertex = boundary.facets[f].vertices[k];
    facet.offCAD[k] = vertex >= 0 && classification.distances[vertex] > 0;
  }
  return facet;
}

CurvedErrorFacet makeCurvedFacet(const DistributedMesh& mesh, const DistributedBoundary& boundary,
  const BoundaryClasses& classes, const Classification& classification, std::size_t f)
{
  CurvedErrorFacet facet{ makeErrorFacet(mesh.mesh(), boundary, classes, classification, f), {},
    {} };
  const MidNodes& midNodes = *mesh.converted.midNodes;
  const int corners = boundary.facetCorners();
  for (int k = 0; k < (corners == 3 ? 3 : 1); ++k)
  {
    const auto& vertices = boundary.facets[f].vertices;
    const Index edge = midNodes.table.find(vertices[k], vertices[(k + 1) % corners]);
    const std::size_t point = mesh.mesh().points.size() + edge;
    facet.nodes[k] = midNodes.points[edge];
    facet.entities[k] = classification.entities[point];
    facet.offCAD[k] = classification.distances[point] > 0;
  }
  return facet;
}

constexpr CountedWork counted{ "measuring", "facets" };

/// Errors of these facets, in their order.
Answers<FacetError> measureFacets(RankExchange& exchange, const DistributedMesh& mesh,
  const ClassifiedBoundary& classified, const Classification& classification,
  const std::vector<std::size_t>& facets, int depth)
{
  if (mesh.converted.midNodes)
  {
    std::vector<CurvedErrorFacet> questions;
    questions.reserve(facets.size());
    for (const std::size_t f : facets)
    {
      questions.push_back(
        makeCurvedFacet(mesh, classified.boundary, classified.classes, classification, f));
    }
    return answerEvenly<FacetError>(
      exchange, std::move(questions),
      [&](const CurvedErrorFacet& facet)
      { return curvedError(classified.projector, facet, depth); },
      counted);
  }
  std::vector<ErrorFacet> questions;
  questions.reserve(facets.size());
  for (const std::size_t f : facets)
  {
    questions.push_back(
      makeErrorFacet(mesh.mesh(), classified.boundary, classified.classes, classification, f));
  }
  return answerEvenly<FacetError>(
    exchange, std::move(questions),
    [&](const ErrorFacet& facet) { return geometricError(classified.projector, facet, depth); },
    counted);
}

} // namespace

void Deviation::add(const Deviation& other)
{
  distance = std::max(distance, other.distance);
  chord = std::max(chord, other.chord);
  angle = std::max(angle, other.angle);
}

MeshError measureError(RankExchange& exchange, const DistributedMesh& mesh, const CADModel& model,
  const Classification& classification, int depth)
{
  const SimplexMesh& piece = mesh.mesh();
  if (piece.dimension == 0)
  {
    throw Error("the mesh has no triangles or tetrahedra; points alone have no geometric error");
  }
  const ClassifiedBoundary classified =
    findClassifiedBoundary(exchange, mesh, model, classification);
  const DistributedBoundary& boundary = classified.boundary;
  std::vector<std::size_t> facets;
  for (std::size_t f = 0; f < boundary.facets.size(); ++f)
  {
    if (classified.classes.facetOnCAD[f])
    {
      facets.push_back(f);
    }
  }
  const auto answers = measureFacets(exchange, mesh, classified, classification, facets, depth);
  const auto angles = neighbourAngles(exchange, mesh, classified, classification);

  MeshError result;
  result.dimension = boundary.facetCorners();
  result.ofCells.resize(mesh.converted.cellIds[piece.dimension].size());
  std::vector<double> addends;
  for (std::size_t i = 0; i < facets.size(); ++i)
  {
    const FacetError& error = answers.values[i];
    CellError& cell = result.ofCells[boundary.facets[facets[i]].cell];
    cell.measure += error.measure;
    cell.largest.add({ error.maximumDistance, error.chordError, angles[facets[i]] });
    addends.push_back(error.measure);
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
