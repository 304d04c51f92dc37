// How well a mesh and a CAD model fit together: one place, one unit of length.
#pragma once

#include "classification/DistributedBoundary.h"
#include "mesh/DistributedMesh.h"
#include "projection/InitialProjection.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

class vtkFieldData;

namespace cadrefine
{

/// A point, and how far it is from the CAD.
struct OffPoint
{
  Point3 point{};
  double distance = 0;
};

/// The same on every rank. Areas are those of triangles and faces; for a planar mesh they are
/// lengths, of segments and CAD edges; for points alone they count points.
struct Fit
{
  std::array<Point3, 2> meshBox{}; ///< Lowest and highest coordinates before the projection.
  std::array<Point3, 2> cadBox{};
  /// Area of the facets on the CAD, as a part of that of all facets in the region with their
  /// centroid in the CAD's box (a far field does not count); 0 where there are none.
  double boundaryOnCAD = 0;
  /// Area of all those facets, as a part of that of all facets in the region.
  double boundaryInBox = 0;
  /// Area of the CAD that facets lie on, as a part of all: for each face that of its facets, at
  /// most its own. Facets are chords, so somewhat less than 1 for a coarse mesh all over a curved
  /// CAD. None for points alone.
  std::optional<double> cadCovered;
  /// Vertices of the boundary in the region and in the CAD's box that are off the CAD, or that
  /// could not reach it.
  std::int64_t verticesOffCAD = 0;
  std::vector<OffPoint> farthest; ///< Of these the ten farthest, in order.
  std::int64_t conflictCount = 0; ///< Vertices in conflict.
  std::vector<Point3> conflicts;  ///< Of these those with the lowest ids, up to 100.
};

/// The fit of a mesh that was projected; `meshBox` is left to the caller. Collective. Work: a
/// whole-model query for each vertex off the CAD in its box. Messages: sums of a number for each
/// face, up to 400 numbers gathered from every rank.
Fit findFit(const ProjectionTask& task, const ProjectionResult& result);
/// The same for points alone.
Fit findFitOfPoints(RankExchange& exchange, const DistributedMesh& mesh, const CADModel& model,
  const ProjectionResult& result);

/// What is to be said of a mesh that seems not to fit: less than half of its boundary on the CAD,
/// or most of it in another place while the CAD is not covered (both where `isWhole`: no region was
/// chosen), or boxes whose sizes compare like two units of length where the CAD is not covered, or
/// that are alike but shifted. Names the units and what to do. Empty: nothing.
std::string warningOfMisfit(const Fit& fit, const std::string& cadUnit, bool isWhole);

/// All of it, for a person: several lines.
std::string describeFit(const Fit& fit, const std::string& cadUnit);

/// Sets field arrays: MeshBox, CADBox (xmin xmax ymin ymax zmin zmax), BoundaryOnCAD,
/// BoundaryInBox, CADCovered, VerticesOffCAD, ClassificationConflicts, FarthestVertices (x y z
/// distance) and ConflictPoints (x y z).
void writeFit(vtkFieldData* data, const Fit& fit);
/// Takes away those of them that another fit may not have.
void removeFit(vtkFieldData* from);

} // namespace cadrefine
