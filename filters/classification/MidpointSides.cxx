#include "classification/MidpointSides.h"

#include "comm/CollectiveErrors.h"
#include "comm/Threads.h"

#include <cadrefine/base/IndicesWhere.h>
#include <cadrefine/classification/CADAdjacency.h>
#include <cadrefine/classification/MidpointProjection.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>

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

/// Whether normals of CAD and mesh point the same way, by the votes of facets, on the faces with
/// `isAsked` on some rank. Collective.
FaceSides voteOnSides(RankExchange& exchange, const Mesh& mesh,
  const ClassifiedBoundary& classified, std::vector<std::int64_t> isAsked)
{
  const CADModel& model = classified.projector.model();
  const auto& records = classified.classes.facets;
  isAsked = exchange.sum(isAsked);
  std::vector<signed char> signs(records.size(), 0);
  const auto look = [&](std::size_t f)
  {
    const FacetRecord& record = records[f];
    if (isOuter(record) && record.face >= 0 && isAsked[record.face] > 0)
    {
      const Vector3 ofCAD =
        model.normalNear(record.face, centroidOf(mesh, classified.boundary.facets[f]));
      const bool isAlike = dot(ofCAD, record.normal) > 0;
      signs[f] = fitsEitherWay(ofCAD, record.normal) ? (isAlike ? 1 : -1) : 0;
    }
  };
  agreeOnFailure(
    exchange, [&] { forEachIndex(forOnThreads(exchange), records.size(), coarseGrain, look); });
  const std::size_t faces = isAsked.size();
  std::vector<std::int64_t> votes(2 * faces, 0); // alike, opposite
  for (std::size_t f = 0; f < records.size(); ++f)
  {
    if (signs[f] != 0)
    {
      ++votes[records[f].face + (signs[f] < 0 ? faces : 0)];
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
  std::vector<std::int64_t> isAsked(classified.projector.model().count(2), 0);
  for (const Index i : far)
  {
    isAsked[midpoints[i].where.entity.index] = 1;
  }
  const FaceSides sides = voteOnSides(exchange, mesh, classified, std::move(isAsked));
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
