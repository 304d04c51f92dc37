// Which changes of a mesh's boundary keep to the CAD.
#pragma once

#include <cadrefine/classification/BoundaryProjector.h>
#include <cadrefine/error/GeometricError.h>
#include <cadrefine/operations/EditableMesh.h>

#include <boost/functional/hash.hpp>

#include <array>
#include <unordered_map>
#include <vector>

namespace cadrefine
{

/// Which changes of a boundary are allowed.
struct SurfaceLimits
{
  /// Largest distance of new facets from the CAD, or that of the facets before, if larger.
  double distance = 0;
  bool keepsError = false; ///< The geometric error must not become larger.
  /// What may become of facets off the CAD: nothing, or, where they lie in one plane (segments: on
  /// a line), they may be exchanged for others there, with the same vertices or with fewer.
  enum class Walls
  {
    Stay,
    KeepVertices,
    LoseVertices
  };
  Walls walls = Walls::KeepVertices;
};

/// Judges new boundary facets (of a planar mesh: segments) with their vertices where they are
/// wanted, and places new vertices. All answers are pure functions of the mesh at the cavity and
/// the model. It keeps the nearest points of the CAD and the errors of facets that it has found,
/// some 200 bytes each, since the same facets are asked for again and again: each thread needs a
/// rule of its own.
class SurfaceRule
{
public:
  explicit SurfaceRule(const BoundaryProjector& projector) : projector_(projector) {}

  /// How well facets follow the CAD.
  struct Fit
  {
    /// Largest distance of a centroid or the middle of an edge from the CAD, or from its own CAD
    /// edge; in a mesh of triangles also of a vertex from where it is wanted.
    double distance = 0;
    /// Smallest cosine of the angle between a facet's normal and the CAD's at these points. The
    /// middles of segments are left out, since two faces meet there.
    double cosine = 1;
  };
  /// The fit of those of these facets that are on the CAD. Work: 4 projections a facet.
  Fit fitOf(const EditableMesh& mesh, const std::vector<Index>& facets) const;
  /// The fit of the boundary's facets at a vertex (of a planar mesh: segments, without their
  /// normals).
  Fit fitAt(const EditableMesh& mesh, Index vertex) const;
  /// Whether a boundary that fits like this follows the CAD as well as it did before: no point is
  /// farther away, and normals make no more than 60 degrees, or no more than before.
  static bool isAsGood(const Fit& fit, const Fit& before);

  const BoundaryProjector& projector() const { return projector_; }

  /// Whether the new facets of a cavity follow the CAD as well as those before: each is classified
  /// as on the CAD; its normal makes no more than 40 degrees with one of theirs, and 60 with those
  /// of the CAD at its centroid and the middles of its edges, unless theirs do; and none of these
  /// points is farther from the CAD than the limit, or than those of the facets before. Facets off
  /// the CAD stay, or stay in their planes. In a planar mesh, the same holds for the directions and
  /// middles of segments. Work: up to 4 projections a facet, 2 a segment, and that of errorGain.
  bool accepts(
    const EditableMesh& mesh, const Cavity& cavity, const SurfaceLimits& limits = {}) const;

  /// By how much the geometric error of a cavity's facets grows with an operation (see
  /// geometricErrors; extrapolated from depth 2); 0 where that is rounding. Work: some 10
  /// projections for each facet that was not measured before.
  double errorGain(const EditableMesh& mesh, const Cavity& cavity) const;

  /// The place on the CAD for the middle of an edge of facets, with its ends where they are wanted.
  /// An edge that belongs only to the boundary off the CAD, or to something listed inside, gets the
  /// point halfway between its ends, with no entity. None where the place cannot be told.
  std::optional<ClosestPoint> placeOfMiddle(const EditableMesh& mesh, Index a, Index b) const;
  /// The place on a CAD face for the middle of an edge, on the side of this unit vector by at least
  /// a twentieth of the edge's length: the nearest one of the middle, or of points up to its length
  /// beside it. None if none of these is there.
  std::optional<ClosestPoint> placeBesideMiddle(
    const EditableMesh& mesh, Index a, Index b, const Vector3& towards) const;

private:
  /// The place on the CAD nearest to a point.
  struct PlaceOnCAD
  {
    ClosestPoint where;
    Vector3 normal{}; ///< Normal of the CAD there; zero unless it is inside a face.
  };

  /// What the error of a facet depends on: for each corner its coordinates and CAD entity, and the
  /// class of the edge to the next corner.
  using FacetKey = std::array<std::array<double, 7>, 3>;

  bool isOffCAD(const EditableMesh& mesh, Index a, Index b) const;
  bool acceptsSegments(const EditableMesh& mesh, const Cavity& cavity, double distance) const;
  double farthestMiddle(const EditableMesh& mesh, const std::vector<Index>& segments) const;
  double distanceOfMiddle(const EditableMesh& mesh, const std::array<Index, 2>& segment) const;
  bool isOnCAD(const EditableMesh& mesh, const std::array<Index, 3>& facet) const;
  bool acceptsFacets(const EditableMesh& mesh, const Cavity& cavity, double distance) const;
  EdgeClass classOf(const EditableMesh& mesh, const Cavity& cavity, Index a, Index b) const;
  double errorOf(const ClassifiedSurface& facet) const;
  template<std::size_t Corners>
  ClassifiedSurface surfaceOf(
    const EditableMesh& mesh, const Cavity& cavity, const std::array<Index, Corners>& facet) const;
  void widen(const EditableMesh& mesh, const Cavity& cavity, const std::array<Index, 3>& facet,
    Fit& fit) const;

  const PlaceOnCAD& nearest(const Point3& point) const;

  const BoundaryProjector& projector_;
  mutable std::unordered_map<Point3, PlaceOnCAD, boost::hash<Point3>> found_;
  mutable std::unordered_map<FacetKey, double, boost::hash<FacetKey>> errors_;
};

} // namespace cadrefine
