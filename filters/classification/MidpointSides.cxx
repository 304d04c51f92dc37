#include "classification/MidpointSides.h"

#include <cadrefine/base/IndicesWhere.h>
#include <cadrefine/classification/CADAdjacency.h>
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

/// Whether a facet is one of the mesh's outer boundary on the CAD.
bool isOuter(const FacetRecord& record)
{
  return record.onCAD && !record.isInside;
}

/// Whether normals of CAD and mesh point the same way, by the votes of facets. Collective.
FaceSides voteOnSides(
  RankExchange& exchange, const Mesh& mesh, const ClassifiedBoundary& classified)
{
  const CADModel& model = classified.projector.model();
  const std::size_t faces = model.nurbs().faces.size();
  std::vector<std::int64_t> votes(2 * faces, 0); // alike, opposite
  for (std::size_t f = 0; f < classified.boundary.facets.size(); ++f)
  {
    const FacetRecord& record = classified.classes.facets[f];
    if (isOuter(record) && record.face >= 0)
    {
      const Vector3 ofCAD =
        model.normalNear(record.face, centroidOf(mesh, classified.boundary.facets[f]));
      if (fitsEitherWay(ofCAD, record.normal))
      {
        ++votes[record.face + (dot(ofCAD, record.normal) < 0 ? faces : 0)];
      }
    }
  }
  votes = exchange.sum(votes);
  const auto opposite = votes.begin() + static_cast<std::ptrdiff_t>(faces);
  return decideSides({ votes.begin(), opposite }, { opposite, votes.end() });
}

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
    for (int k = 0; k < boundary.facets[f].edges() && isOuter(record); ++k)
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

void turnToFacets(RankExchange& exchange, const Mesh& mesh, const MarkedEdges& edges,
  const ClassifiedBoundary& classified, const std::vector<Index>& edgesOf,
  const std::function<BoundaryEdge(std::size_t)>& edgeAt, std::vector<MidpointOnCAD>& midpoints)
{
  const auto far = indicesWhere(
    midpoints.size(), [&](std::size_t i) { return isFarAcross(edgeAt(i), midpoints[i].where); });
  if (mesh.dimension < 3 || !exchange.any(!far.empty()))
  {
    return;
  }
  const FaceSides sides = voteOnSides(exchange, mesh, classified);
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
