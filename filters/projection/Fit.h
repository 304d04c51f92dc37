// How well a mesh and a CAD model fit together: one place, one unit of length.
#pragma once

#include "classification/DistributedBoundary.h"
#include "mesh/DistributedMesh.h"
#include "projection/InitialProjection.h"

#include <cadrefine/base/BoundingBox.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace cadrefine
{

/// A point, and how far it is from the CAD.
struct OffPoint
{
  Point3 point{};
  double distance = 0;
};

/// How well a mesh and a model fit, the same on every rank. Areas are those of triangles and faces;
/// for a planar mesh they are lengths, of segments and CAD edges; for points alone they count
/// points.
struct Fit
{
  BoundingBox meshBox; ///< Box of the mesh before the projection.
  BoundingBox cadBox;
  /// Area of the facets on the CAD, as a part of that of all facets in the region with their
  /// centroid in the CAD's box (a far field does not count); 0 where there are none.
  double boundaryOnCAD = 0;
  /// Area of all facets in the region with their centroid in the CAD's box, as a part of that of
  /// all facets in the region.
  double boundaryInBox = 0;
  /// Area of the CAD that facets lie on, as a part of all: for each face that of its facets, at
  /// most its own. Facets are chords, so somewhat less than 1 for a coarse mesh all over a curved
  /// CAD. None for points alone.
  std::optional<double> cadCovered;
  /// Of the vertices on curved faces and edges, the part that were there before the projection, but
  /// for rounding: a mesh in another place or unit has none. 0 where there are no such vertices.
  double wasOnCurved = 0;
  /// Vertices of the boundary in the region and in the CAD's box that are off the CAD, or that
  /// could not reach it.
  std::int64_t verticesOffCAD = 0;
  std::vector<OffPoint> farthest; ///< The ten farthest of these, in order.
  /// Facets in the region and in the CAD's box that are off the CAD though all their vertices are
  /// on it: across holes that are narrower than the cells, or where the CAD is not the whole
  /// boundary.
  std::int64_t bridgingFacets = 0;
  std::vector<Point3> bridges; ///< Centroids of the ten largest of these, in order.
  /// Vertices that were put onto faces (of a planar mesh, edges) on which three quarters of the
  /// facets lay already, and were not there themselves, by a twentieth of their longest edge.
  std::int64_t strays = 0;
  /// The farthest of these: where it is now, and how far it was from there.
  OffPoint farthestStray;
  std::int64_t conflictCount = 0; ///< Vertices in conflict.
  std::vector<Point3> conflicts;  ///< Those of them with the lowest ids, up to 100.
};

/// The fit of a mesh that was projected; `meshBox` and what findVerticesOff finds are left to the
/// caller. Collective. Messages: sums of a number for each face, up to 550 numbers gathered from
/// every rank.
Fit findFit(const ProjectionTask& task, const ProjectionResult& result);
/// Finds the vertices off the CAD, and the farthest of them, of the mesh as it is now. Collective.
/// Work: a whole-model query for each vertex off the CAD in its box. Messages: up to 50 numbers
/// gathered from every rank.
void findVerticesOff(RankExchange& exchange, const DistributedMesh& mesh,
  const BoundaryProjector& projector, const std::vector<unsigned char>& onBoundary,
  const Classification& classification, const ProjectionOptions& options, Fit& fit);

/// The fit of points alone that were projected; `meshBox` is left to the caller. Collective.
Fit findFitOfPoints(RankExchange& exchange, const DistributedMesh& mesh, const CADModel& model,
  const ProjectionResult& result);

} // namespace cadrefine
