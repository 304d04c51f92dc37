// The boundary of a mesh in pieces, and how its facets meet at edges.
#pragma once

#include "mesh/DistributedMesh.h"

#include <cadrefine/classification/BoundaryProjector.h>
#include <cadrefine/classification/Classification.h>
#include <cadrefine/mesh/EdgeTable.h>
#include <cadrefine/mesh/Facets.h>

#include <array>
#include <optional>
#include <vector>

namespace cadrefine
{

class BoundaryCache;

/// The facets of this rank's piece that lie on the boundary of the whole mesh, their edges, and
/// which vertices lie on that boundary. Refers to the mesh it was made from.
struct DistributedBoundary
{
  BoundaryKind kind = BoundaryKind::Faces;
  /// The facets are the cells of a mesh of area in space.
  bool ofSurface = false;
  std::vector<Facet> facets;
  EdgeList edges;
  /// The edges of each facet: edge k joins corners k and k + 1, a segment is its own edge 0. Where
  /// a facet has fewer than four, -1 follows.
  std::vector<std::array<Index, 4>> facetEdges;
  SharedItems sharedEdges;
  /// 1 for vertices of facets, on whatever rank these are.
  std::vector<unsigned char> onBoundary;
  /// Length of the longest boundary edge at each vertex, over all ranks; 0 elsewhere.
  std::vector<double> longestEdge;
  /// Length of the shortest boundary edge at each vertex, over all ranks; infinite elsewhere.
  std::vector<double> shortestEdge;

  int facetDimension() const { return dimensionOf(kind); }
};

/// Whether a mesh of area with these vertices is compared with the edges of the model: if this has
/// no faces, or if the mesh is planar (see normalOfPoints), in a coordinate plane or in that of the
/// whole model. Collective.
bool isPlanar(RankExchange& exchange, const std::vector<Point3>& points, const CADModel& model);

/// Whether the boundary of a mesh is compared with the faces or the edges of the model. Collective.
BoundaryKind kindOfBoundary(
  RankExchange& exchange, const DistributedMesh& mesh, const CADModel& model);

/// Finds the boundary of a mesh: the sides met once and listed interior ones of a mesh of volume or
/// a planar one (see findBoundaryFacets), all cells of a mesh of area in space. `among`: see
/// findBoundaryFacets. Collective; messages in proportion to the interface between pieces.
DistributedBoundary findBoundary(RankExchange& exchange, const DistributedMesh& mesh,
  const CADModel& model, const std::vector<unsigned char>& among = {});

/// For each boundary edge the records of all facets beside it, of those on other ranks too, given
/// those of this rank's facets. Collective.
std::vector<std::vector<FacetRecord>> gatherFacetRecords(RankExchange& exchange,
  const DistributedBoundary& boundary, const std::vector<FacetRecord>& ofFacets);

/// A facet as the projector sees it: the points of its corners and their CAD entities.
ClassifiedFacet classifiedFacet(
  const Mesh& mesh, const std::vector<EntityId>& entities, const Facet& facet);

/// The record of a facet. It is on the CAD if all of its corners are classified and it fits the CAD
/// there (BoundaryProjector::isOnCAD).
FacetRecord makeRecord(const BoundaryProjector& projector, const ClassifiedFacet& facet);

Point3 centroidOf(const Mesh& mesh, const Facet& facet);

/// The CAD face of a triangle on the CAD with this centroid: `common`, that of its record, or where
/// it spans several (-1) the nearest; none where that is a wire of no face.
EntityId faceOf(const BoundaryProjector& projector, const Point3& centroid, int common);

/// The CAD edge of a segment whose middle has this place: of several that meet there the first.
EntityId edgeOf(const CADModel& model, const ClosestPoint& middle);

/// Which corners are classified, but have not reached the CAD.
std::array<bool, 4> cornersOff(const Classification& classification, const Facet& facet);

/// Classes of all boundary edges of a classified mesh, and records of its facets.
struct BoundaryClasses
{
  std::vector<EdgeClass> ofEdges;
  std::vector<FacetRecord> facets;
  std::vector<Index> known; ///< For each facet its number in the cache; -1: none.
};

/// Classifies a boundary, given the CAD entities of the mesh's vertices. Collective. Work: some
/// queries a facet and an edge on the CAD, but for facets that are in the cache.
BoundaryClasses classifyBoundary(RankExchange& exchange, const Mesh& mesh,
  const DistributedBoundary& boundary, const std::vector<EntityId>& entities,
  const BoundaryProjector& projector, const BoundaryCache& cache);

/// The boundary of a mesh that is classified on a model. Refers to both, and is of use until the
/// mesh changes.
struct ClassifiedBoundary
{
  BoundaryProjector projector;
  DistributedBoundary boundary;
  BoundaryClasses classes;
  /// The place of the midpoint of each boundary edge, and after these of each of quadsOnCAD; none:
  /// they were not looked for.
  std::optional<std::vector<ClosestPoint>> midpoints = std::nullopt;
};

/// Finds the boundary of a mesh and classifies it: see findBoundary and classifyBoundary.
/// Collective.
ClassifiedBoundary findClassifiedBoundary(RankExchange& exchange, const DistributedMesh& mesh,
  const CADModel& model, const Classification& classification, const BoundaryCache& cache,
  const std::vector<unsigned char>& among = {});

} // namespace cadrefine
