#include "classification/MidpointSides.h"

#include "classification/FacetClassification.h"

#include <cadrefine/base/IndicesWhere.h>
#include <cadrefine/classification/MidpointProjection.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>

namespace cadrefine
{
namespace
{

/// A vector in whole numbers of 2^-40, so that a sum does not depend on the order.
using WholeVector = std::array<std::int64_t, 3>;

/// For each edge the sum of the unit normals of the outer facets on the CAD at it; zero where there
/// are none. Collective.
std::vector<WholeVector> sumNormals(
  RankExchange& exchange, const MarkedEdges& edges, const ClassifiedBoundary& classified)
{
  const DistributedBoundary& boundary = classified.boundary;
  std::vector<WholeVector> sums(edges.table.edges.size(), WholeVector{});
  for (std::size_t f = 0; f < boundary.facets.size(); ++f)
  {
    const FacetRecord& record = classified.classes.facets[f];
    const bool isOuter = record.onCAD && !record.isInside;
    for (int k = 0; k < boundary.facets[f].edges() && isOuter; ++k)
    {
      const auto& [a, b] = boundary.edges.edges()[boundary.facetEdges[f][k]];
      WholeVector& sum = sums[edges.table.find(a, b)];
      for (int axis = 0; axis < 3; ++axis)
      {
        sum[axis] += std::llround(std::ldexp(record.normal[axis], 40));
      }
    }
  }
  combineShared(exchange, edges.sharedEdges, sums,
    [](WholeVector a, const WholeVector& b)
    {
      std::transform(a.begin(), a.end(), b.begin(), a.begin(), std::plus<>());
      return a;
    });
  return sums;
}

} // namespace

void turnToFacets(RankExchange& exchange, const MarkedEdges& edges,
  const ClassifiedBoundary& classified, const Classification& classification,
  const std::vector<Index>& edgesOf, const std::function<BoundaryEdge(std::size_t)>& edgeAt,
  std::vector<MidpointOnCAD>& midpoints)
{
  if (classified.boundary.ofSurface)
  {
    return;
  }
  const auto far = indicesWhere(midpoints.size(), [&](std::size_t i)
    { return isFarAcross(classified.projector, edgeAt(i), midpoints[i].where); });
  if (!exchange.any(!far.empty()))
  {
    return;
  }
  const auto placeOf = [&](Index vertex)
  {
    ClosestPoint place;
    place.entity = classification.entities[vertex];
    place.parameters = classification.parameters[vertex];
    return place;
  };
  const FaceSides sides = findSides(exchange, classified.projector.model(), classified.boundary,
    classified.classes.facets, placeOf);
  const auto sums = sumNormals(exchange, edges, classified);
  for (const Index i : far)
  {
    const auto& [x, y, z] = sums[edgesOf[i]];
    const Vector3 sum{ static_cast<double>(x), static_cast<double>(y), static_cast<double>(z) };
    if (sum != Vector3{})
    {
      ClosestPoint& where = midpoints[i].where;
      where = facing(classified.projector, edgeAt(i), where, normalized(sum), sides);
    }
  }
}

} // namespace cadrefine
