// A CAD model as plain data: trimmed faces, edges and vertices with their topology. It is what
// geom/cad extracts from Open CASCADE, and all that the closest-point search needs.
#pragma once

#include <cadrefine/base/EntityId.h>
#include <cadrefine/nurbs/Bezier.h>

#include <array>
#include <cstdint>
#include <vector>

namespace cadrefine
{

/// Closed chain of curves in the (u, v) plane; a point is inside the face where the loops of the
/// face wind round it an odd number of times.
using TrimLoop = std::vector<BezierCurve2>;

struct NurbsFace
{
  /// Rectangular grid of patches, patch (i, j) at `i * patchesV + j`, i along u, j along v.
  std::vector<BezierPatch> patches;
  int patchesU = 0;
  int patchesV = 0;
  std::vector<TrimLoop> loops;
  /// True where the face's outward normal is opposite to (dS/du) x (dS/dv).
  bool reversed = false;
  std::vector<std::int32_t> edges; ///< Bounding edges, each once, ascending.
  double tolerance = 0;            ///< How far its trim curves may lie off its edges.
  /// How far the patches lie off the surface, where that had to be fitted; a length.
  double fitError = 0;
};

/// The patch of a face that holds these parameters; of several the last, beyond them the nearest.
const BezierPatch& patchAt(const NurbsFace& face, double u, double v);

struct NurbsEdge
{
  std::vector<BezierCurve> segments; ///< In order of the parameter, joined end to end.
  std::int32_t firstVertex = -1;     ///< -1: closed without a vertex.
  std::int32_t lastVertex = -1;
  std::vector<std::int32_t> faces; ///< Faces that it bounds, each once, ascending.
  /// True where the surface has a crease here: the edge bounds one face only (and is no seam), or
  /// the outward normals on its two sides differ by more than NurbsModel::creaseAngle anywhere; and
  /// of all edges where there is no surface.
  bool sharp = true;
  double tolerance = 0; ///< How far it may lie off its faces.
};

struct NurbsVertex
{
  Point3 point;
  std::vector<std::int32_t> edges; ///< Edges that end here, each once, ascending.
  double tolerance = 0;
};

struct NurbsModel
{
  /// Angle in radians above which an edge is a crease (15 degrees).
  static constexpr double creaseAngle = 0.2617993877991494;

  std::vector<NurbsFace> faces;
  std::vector<NurbsEdge> edges;
  std::vector<NurbsVertex> vertices;

  int count(int dimension) const
  {
    return static_cast<int>(dimension == 2   ? faces.size()
                            : dimension == 1 ? edges.size()
                                             : vertices.size());
  }
};

/// Whether all control points are within a distance of `tolerance` of the plane of the points p
/// with dot(normal, p) = offset.
bool liesInPlane(const NurbsModel& model, const Vector3& normal, double offset, double tolerance);

/// The first face at an entity: a face itself, the first one that holds an edge, or the one at the
/// first of a vertex's edges that a face holds; -1: none.
std::int32_t firstFaceAt(const NurbsModel& model, EntityId entity);

} // namespace cadrefine
