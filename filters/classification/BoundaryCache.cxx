#include "classification/BoundaryCache.h"

#include "mesh/BoundaryFacets.h"

#include <cadrefine/base/MixedBits.h>

#include <tuple>

namespace cadrefine
{
namespace
{

bool operator==(const EdgeClass& a, const EdgeClass& b)
{
  return std::tie(a.kind, a.entity) == std::tie(b.kind, b.entity);
}

bool operator==(const ClassifiedFacet& a, const ClassifiedFacet& b)
{
  return std::tie(a.points, a.entities) == std::tie(b.points, b.entities);
}

} // namespace

std::size_t BoundaryCache::Hash::operator()(const std::array<GlobalId, 4>& ids) const
{
  std::uint64_t hash = 0;
  for (const GlobalId id : ids)
  {
    hash = mixedBits(hash ^ static_cast<std::uint64_t>(id));
  }
  return hash;
}

BoundaryCache::BoundaryCache(const Mesh& mesh, const Classification& classification,
  const ClassifiedBoundary& classified, const std::vector<FacetError>& errors, int depth)
  : edgeClasses_(classified.classes.ofEdges), midpoints_(*classified.midpoints), depth_(depth)
{
  const DistributedBoundary& boundary = classified.boundary;
  byIds_.reserve(errors.size());
  facets_.reserve(errors.size());
  for (std::size_t f = 0; f < boundary.facets.size(); ++f)
  {
    const FacetRecord& record = classified.classes.facets[f];
    if (record.onCAD)
    {
      const Facet& facet = boundary.facets[f];
      Known& known = facets_.emplace_back();
      known.corners = classifiedFacet(mesh, classification.entities, facet);
      known.offCAD = cornersOff(classification, facet);
      known.record = record;
      known.edges = boundary.facetEdges[f];
      known.error = errors[facets_.size() - 1];
      byIds_.emplace(idsOf(mesh, facet.vertices), static_cast<Index>(facets_.size() - 1));
    }
  }
}

Index BoundaryCache::find(
  const Mesh& mesh, const Facet& facet, const ClassifiedFacet& corners) const
{
  const auto found = byIds_.find(idsOf(mesh, facet.vertices));
  return found != byIds_.end() && facets_[found->second].corners == corners ? found->second : -1;
}

const ClosestPoint* BoundaryCache::midpoint(Index facet, int k, const EdgeClass& edgeClass) const
{
  const Index edge = facets_[facet].edges[k];
  return edgeClasses_[edge] == edgeClass ? &midpoints_[edge] : nullptr;
}

const FacetError* BoundaryCache::error(Index facet, const ErrorFacet& now, int depth) const
{
  const Known& known = facets_[facet];
  bool isSame = depth == depth_ && known.offCAD == now.offCAD;
  for (int k = 0; k < 4; ++k)
  {
    isSame = isSame && (known.edges[k] < 0 || edgeClasses_[known.edges[k]] == now.edges[k]);
  }
  return isSame ? &known.error : nullptr;
}

} // namespace cadrefine
