// Where the vertices, facets and edges of a mesh's boundary belong on the CAD.
#pragma once

#include <cadrefine/base/EntityId.h>
#include <cadrefine/base/MeshTypes.h>
#include <cadrefine/base/Vector3.h>
#include <cadrefine/cad/model/CADModel.h>
#include <cadrefine/classification/EdgeFinder.h>
#include <cadrefine/classification/FaceFinder.h>

#include <array>
#include <vector>

namespace cadrefine
{

/// What facets are compared with: the triangles and quadrilaterals of a boundary of volume or of a
/// surface in space with CAD faces, the segments of a planar mesh's boundary with CAD edges.
enum class BoundaryKind
{
  Faces,
  Edges
};

/// The dimension of these facets, and of the CAD's faces or edges that they are compared with.
constexpr std::int8_t dimensionOf(BoundaryKind kind)
{
  return kind == BoundaryKind::Faces ? 2 : 1;
}

/// A facet with the CAD entities that its corners lie on.
struct ClassifiedFacet
{
  std::array<Point3, 4> points{};
  std::array<EntityId, 4> entities{};
  int corners = 3;       ///< 3 of a triangle, 4 of a quadrilateral, 2 of a segment.
  bool isInside = false; ///< The facet is between two cells.
};

/// How the midpoint of a mesh edge is to be placed.
struct EdgeClass
{
  enum Kind : std::int32_t
  {
    Straight = 0, ///< In the middle of the edge: the edge does not lie on the CAD.
    Smooth = 1,   ///< On CAD face `entity`, or on those (of a planar mesh: edges) of both ends.
    OnEdge = 2    ///< On CAD edge `entity`, or on the nearest crease.
  };
  Kind kind = Straight;
  std::int32_t entity = -1; ///< -1: not known.
};

/// An edge whose midpoint is to be placed. The middle of a quadrilateral is that of an edge between
/// the middles of two of its edges.
struct BoundaryEdge
{
  EdgeClass edgeClass;
  std::array<Point3, 2> points;
  std::array<EntityId, 2> entities;
};

/// Whether `a` is nearer than `b`; on a tie, whether its entity is the smaller one.
inline bool isNearer(const ClosestPoint& a, const ClosestPoint& b)
{
  return a.distance != b.distance ? a.distance < b.distance : a.entity < b.entity;
}

/// The rules by which mesh entities are classified on the CAD and their points are projected.
/// All answers are pure functions of the arguments and the model.
class BoundaryProjector
{
public:
  BoundaryProjector(const CADModel& model, BoundaryKind kind);

  BoundaryKind kind() const { return kind_; }
  const CADModel& model() const { return model_; }

  /// Nearest point of the CAD faces or edges that the boundary is compared with, up to a distance
  /// of `limit`; on a face's border that of the edge which the faces share (see onSharedEdge).
  ClosestPoint nearest(const Point3& point, double limit) const;
  /// Whether `nearest` would name an entity, for less work.
  bool isWithinDistance(const Point3& point, double limit) const;
  /// Where the point is within a distance of `exact` of a CAD vertex, or else of a CAD edge, the
  /// nearest point of these; otherwise `nearest`, the nearest point of the model.
  ClosestPoint onSmallest(const Point3& point, double exact, const ClosestPoint& nearest) const;
  /// Nearest point of `entity` and its closure; on a face's border as `nearest` gives it.
  ClosestPoint nearestOn(EntityId entity, const Point3& point) const;

  /// Whether a facet whose corners all lie near the CAD stands for a part of it: whether its normal
  /// (a segment's direction) fits that of the CAD to 60 degrees at one of its corners or at its
  /// centroid. Tells the facets of a wall that meets the CAD from those on the CAD. Between two
  /// cells, which may be layers on the CAD, the centroid must be nearest to an entity of a corner.
  bool isOnCAD(const ClassifiedFacet& facet) const;
  /// Whether a facet of so many corners lies beside the CAD: its middle is no farther away than
  /// half of its longest edge, and its normal (a segment's direction) fits there to 60 degrees.
  bool isBesideCAD(const std::array<Point3, 4>& points, int corners) const;

  /// The CAD face that all corners of a classified facet lie on; of several faces the nearest one
  /// whose normal fits; -1 where there is none.
  std::int32_t faceOf(const ClassifiedFacet& facet) const;

  /// The CAD edge between two faces that all corners of a triangle lie on, which is an ear of one
  /// of them; -1: none.
  std::int32_t earOf(const ClassifiedFacet& facet) const;

  /// Class of the edge between two classified vertices, from the facets beside it (never from its
  /// ends alone).
  EdgeClass classify(const std::array<Point3, 2>& points, const std::array<EntityId, 2>& entities,
    const std::vector<FacetRecord>& facets) const;

  /// The point of the CAD for a point that stands for a mesh edge, such as its middle: of the CAD
  /// edge or face that the edge is on, or that its ends share; with no entity for Straight.
  ClosestPoint project(
    const EdgeClass& edgeClass, const Point3& point, const std::array<EntityId, 2>& entities) const;
  /// The face of a smooth edge, or else those (of a planar mesh: edges) that both ends share.
  std::vector<std::int32_t> entitiesOf(
    const EdgeClass& edgeClass, const std::array<EntityId, 2>& entities) const;
  /// The nearest point of the CAD entities of entitiesOf; with no entity where they have none.
  ClosestPoint nearestOnShared(
    const EdgeClass& edgeClass, const std::array<EntityId, 2>& entities, const Point3& point) const;

  /// CAD vertices that want a mesh vertex of their own: see findCorners.
  const std::vector<std::int32_t>& corners() const { return corners_; }
  bool isCorner(std::int32_t vertex) const;
  /// For each CAD edge the line of creases that it is part of: see findCreaseLines.
  const std::vector<std::int32_t>& lines() const { return lines_; }
  /// Nearest crease (sharp edges and their ends) up to `limit`.
  ClosestPoint nearestCrease(const Point3& point, double limit) const
  {
    return edges_.nearestCrease(point, limit);
  }

private:
  SearchScope scopeWithin(double limit) const;
  bool fitsNormal(EntityId entity, const ClosestPoint& where, const Vector3& normal) const;
  bool isOfACorner(const ClassifiedFacet& facet, EntityId middle) const;
  std::int32_t commonCrease(const std::array<Point3, 2>& points,
    const std::array<EntityId, 2>& entities, const std::vector<FacetRecord>& onCAD) const;
  std::int32_t commonSmoothEdge(const std::array<Point3, 2>& points,
    const std::array<EntityId, 2>& entities, const std::vector<FacetRecord>& onCAD) const;
  bool passesThroughWall(std::int32_t crease, const std::array<Point3, 2>& points,
    const std::vector<FacetRecord>& facets) const;
  /// Whether the crease is part of a line of creases that the entity, an edge or a vertex, is on.
  bool isOnLineOf(std::int32_t crease, EntityId entity) const;
  ClosestPoint projectOnEdge(std::int32_t edge, const Point3& point) const;

  const CADModel& model_;
  BoundaryKind kind_;
  FaceFinder faces_;
  EdgeFinder edges_;
  std::vector<std::int32_t> corners_;
  std::vector<std::int32_t> lines_;
};

} // namespace cadrefine
