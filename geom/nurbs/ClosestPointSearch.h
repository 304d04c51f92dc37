// Closest point of a whole trimmed model, or of one of its entities.
#pragma once

#include <cadrefine/base/EntityId.h>
#include <cadrefine/base/Vector3.h>
#include <cadrefine/nurbs/NurbsModel.h>

#include <array>
#include <limits>
#include <memory>

namespace cadrefine
{

/// Answer to a closest-point query. `entity` is none where nothing lies within the limit asked for.
struct ClosestPoint
{
  EntityId entity;
  Point3 point{};
  /// (u, v) on a face, (t, 0) on an edge, NaN on a vertex.
  std::array<double, 2> parameters{};
  double distance = std::numeric_limits<double>::infinity();
  /// Where the point is on the border of the face `entity`, off the edge that the border stands
  /// for: that edge. -1 elsewhere.
  std::int32_t borderEdge = -1;
  /// False where the work limit ended the search before the bound of 1e-9 of the model's size was
  /// reached (centres of curvature); the distance is still that of a point on the model.
  bool converged = true;
};

/// What a whole-model query looks at.
struct SearchScope
{
  double maximumDistance = std::numeric_limits<double>::infinity();
  bool faces = true;
  bool edges = true; ///< All edges. Off with `sharpEdges` on: only creases.
  bool sharpEdges = true;
  bool vertices = true;
  bool strays = true; ///< Edges that bound no face, and vertices of no other edge.
};

/// Search structure over one model, built once. Queries are const, free of hidden state and safe
/// from many threads at once; the answer is a pure function of the model and the point.
///
/// Patches and segments are cut into leaves over which the distance is convex for points close by,
/// under one tree of bounding boxes. A query descends to the leaves that may hold the nearest point
/// and solves those that are convex for it by Newton's method; the others by branch and bound on
/// the Bernstein form of the squared distance (after Johnson & Cohen, "Distance extrema for spline
/// models using tangent cones", 2005), which also settles centres of curvature and poles.
/// Cost: about 20 microseconds of build and 350 bytes a leaf, some 5 to 50 leaves a patch, up to
/// 700 near poles or sharp bends; 0.9 to 1.8 microseconds a query close to the surface, up to 2.7
/// where many narrow patches lie side by side, some 2 to 10 far from it, up to a millisecond on
/// axes and at centres of curvature, and a work limit of about a tenth of a second.
///
/// On a seam the answer has the lower parameter, at a pole the lowest of those that meet there.
/// Points equally near to within 1e-12 of the model's size are a tie. A point within 1e-9 of a trim
/// loop, relative to the loops' extent in the parameter plane, counts as inside it. Trim curves
/// that lie off their edges by more than 2e-10 of the size are searched themselves, as polynomials
/// in space that follow them to 5e-11.
class ClosestPointSearch
{
public:
  /// Keeps a reference to `model`, which must outlive the search. Throws Error as checkModel
  /// does.
  explicit ClosestPointSearch(const NurbsModel& model);
  ~ClosestPointSearch();
  ClosestPointSearch(const ClosestPointSearch&) = delete;
  ClosestPointSearch& operator=(const ClosestPointSearch&) = delete;

  /// Nearest point of the trimmed model, which is the union of its faces with their borders, its
  /// edges and its vertices: never farther than the true one by more than 1e-9 of the model's size,
  /// or, from more than 1e7 sizes away, where that is less than rounding, by 2e-8 of it.
  /// Of entities equally near, the smallest (dimension, index) wins: on the border of a face the
  /// answer is its edge, at the end of an edge its vertex. Where the border lies off its edge, the
  /// nearer of the two is the answer: the edge, or the face with parameters on its border and
  /// `borderEdge`. Where `scope` leaves edges out, the border of a face is part of the face, and
  /// the answer names the face that comes first. No entity is named where the point is not finite
  /// or nothing is within the limit.
  ClosestPoint nearest(const Point3& point, const SearchScope& scope = {}) const;

  /// Whether `nearest` would name an entity. Ends at the first point within the limit: where that
  /// is larger than the distance, a fraction of the work.
  bool isWithinDistance(const Point3& point, const SearchScope& scope) const;

  /// Nearest point of one entity and its closure: for a face also its edges and vertices, for an
  /// edge its end vertices, and the answer then names these.
  ClosestPoint nearestOn(EntityId entity, const Point3& point) const;

  /// Nearest point of a face's surface where it is in or next to the trimmed face, border included,
  /// named by the face and its parameters: for the face's normal at a point of its border.
  ClosestPoint nearestOnSurface(int face, const Point3& point) const;

  /// Diagonal of the model's bounding box: the size that tolerances refer to.
  double modelSize() const;

private:
  struct Implementation;
  std::unique_ptr<const Implementation> implementation_;
};

} // namespace cadrefine
