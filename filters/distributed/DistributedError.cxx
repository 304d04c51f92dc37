#include "DistributedError.h"

#include "DistributedBoundary.h"
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

} // namespace

MeshError measureError(RankExchange& exchange, const DistributedMesh& mesh, const CADModel& model,
  const Classification& classification, int depth)
{
  const SimplexMesh& piece = mesh.mesh();
  if (piece.dimension == 0)
  {
    throw Error("the mesh has no triangles or tetrahedra; points alone have no geometric error");
  }
  const DistributedBoundary boundary = findBoundary(exchange, mesh, model);
  const BoundaryProjector projector(model, boundary.kind);
  const BoundaryClasses classes =
    classifyBoundary(exchange, piece, boundary, classification.entities, projector);

  MeshError result;
  result.dimension = boundary.facetCorners();
  const std::size_t cells = mesh.converted.cellIds[piece.dimension].size();
  result.ofCells.assign(cells, 0.0);
  result.distanceOfCells.assign(cells, 0.0);
  std::vector<std::size_t> facets;
  std::vector<ErrorFacet> questions;
  for (std::size_t f = 0; f < boundary.facets.size(); ++f)
  {
    if (classes.facetOnCAD[f])
    {
      facets.push_back(f);
      questions.push_back(makeErrorFacet(piece, boundary, classes, classification, f));
    }
  }
  const auto answers = answerEvenly<FacetError>(exchange, std::move(questions),
    [&](const ErrorFacet& facet) { return geometricError(projector, facet, depth); });
  std::vector<double> addends;
  for (std::size_t i = 0; i < facets.size(); ++i)
  {
    const FacetError& error = answers.values[i];
    const Index cell = boundary.facets[facets[i]].cell;
    result.ofCells[cell] += error.measure;
    result.distanceOfCells[cell] = std::max(result.distanceOfCells[cell], error.maximumDistance);
    result.maximumDistance = std::max(result.maximumDistance, error.maximumDistance);
    addends.push_back(error.measure);
  }
  result.balance = answers.balance;
  result.global = exchange.sumReproducibly(addends);
  result.maximumDistance = exchange.max(result.maximumDistance);
  return result;
}

} // namespace cadrefine
