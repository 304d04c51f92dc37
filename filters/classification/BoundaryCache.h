// What was found of the facets of a boundary, for those that a later boundary has, too.
#pragma once

#include "classification/DistributedBoundary.h"

#include <cadrefine/error/GeometricError.h>

#include <array>
#include <unordered_map>
#include <vector>

namespace cadrefine
{

/// Most facets of a mesh that is adapted step by step stay. All that is found of a facet is a
/// function of its corners and their CAD entities, and of the classes of its edges: where these are
/// the same to the last bit, so is the answer. Memory: some 350 bytes a facet on the CAD.
class BoundaryCache
{
public:
  BoundaryCache() = default;
  /// Keeps the facets on the CAD of a measured boundary, with their errors at this depth, in order.
  BoundaryCache(const Mesh& mesh, const Classification& classification,
    const ClassifiedBoundary& classified, const std::vector<FacetError>& errors, int depth);

  /// The number here of a facet, if it is known with the same corners and CAD entities; -1: it is
  /// not.
  Index find(const Mesh& mesh, const Facet& facet, const ClassifiedFacet& corners) const;

  const FacetRecord& record(Index facet) const { return facets_[facet].record; }
  /// The place of the midpoint of edge k of a facet if that edge is of this class, else null.
  const ClosestPoint* midpoint(Index facet, int k, const EdgeClass& edgeClass) const;
  /// The error of a facet at this depth, if the classes of its edges and its corners off the CAD
  /// are those of `now`; else null.
  const FacetError* error(Index facet, const ErrorFacet& now, int depth) const;

private:
  struct Hash
  {
    std::size_t operator()(const std::array<GlobalId, 4>& ids) const;
  };
  struct Known
  {
    ClassifiedFacet corners;
    std::array<bool, 4> offCAD;
    FacetRecord record;
    std::array<Index, 4> edges;
    FacetError error;
  };

  std::unordered_map<std::array<GlobalId, 4>, Index, Hash> byIds_;
  std::vector<Known> facets_;
  std::vector<EdgeClass> edgeClasses_;
  std::vector<ClosestPoint> midpoints_;
  int depth_ = 0;
};

} // namespace cadrefine
