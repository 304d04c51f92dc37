// Where the vertices, facets and edges of a mesh's boundary belong on the CAD.
#pragma once

#include "CADModel.h"
#include "EntityId.h"
#include "MeshTypes.h"
#include "Vector3.h"

#include <array>
#include <vector>

namespace cadrefine
{

/// What the CAD is compared with: the boundary facets of a mesh of tetrahedra or of triangles in
/// space (triangles, against CAD faces), or those of a planar mesh (segments, against CAD edges).
enum class BoundaryKind
{
  Triangles,
  Segments
};

/// A facet with the CAD entities that its corners lie on. Segments use two corners.
struct ClassifiedFacet
{
  std::array<Point3, 3> points;
  std::array<EntityId, 3> entities;
};

/// What an edge of the boundary needs to know of a facet beside it, on whatever rank that is.
struct FacetRecord
{
  Vector3 normal{};        ///< Unit outward normal of a triangle.
  double area = 0;         ///< Of a triangle.
  unsigned char onCAD = 0; ///< The facet stands for a part of the CAD.
  unsigned char free = 0;  ///< It is not, because the user's region leaves it out.
};

/// How the midpoint of a mesh edge is to be placed.
struct EdgeClass
{
  enum Kind : std::int32_t
  {
    Straight = 0, ///< In the middle of the edge: the edge does not lie on the CAD.
    Smooth = 1,   ///< On the faces (of a planar mesh: edges) that the ends lie on.
    Crease = 2    ///< On a crease: CAD edge `edge`, or the nearest one where that is -1.
  };
  Kind kind = Straight;
  std::int32_t edge = -1;
};

/// The rules by which mesh entities are classified on the CAD and their points are projected.
/// All answers are pure functions of the arguments and the model.
class BoundaryProjector
{
public:
  BoundaryProjector(const CADModel& model, BoundaryKind kind);

  BoundaryKind kind() const { return kind_; }
  const CADModel& model() const { return model_; }

  /// Nearest point of what the boundary is compared with, up to `limit`.
  ClosestPoint nearest(const Point3& point, double limit) const;
  /// Nearest crease: sharp edges and their ends.
  ClosestPoint nearestCrease(const Point3& point, double limit) const;
  /// Nearest point of `entity` and its closure.
  ClosestPoint nearestOn(EntityId entity, const Point3& point) const;

  /// Whether a facet whose corners all lie near the CAD stands for a part of it: whether its normal
  /// (a segment's direction) fits that of the CAD to 60 degrees at one of its corners or at its
  /// centroid. Tells the facets of a wall that meets the CAD from those on the CAD.
  bool isOnCAD(const ClassifiedFacet& facet) const;

  /// For the initial projection: whether the mesh edge from `a` to `b` is to be put onto a crease:
  /// it is the rim of the CAD facets or has a dihedral angle, and runs along a crease whose faces'
  /// normals fit those of the facets beside it.
  bool runsAlongCrease(
    const Point3& a, const Point3& b, const std::vector<FacetRecord>& facets) const;

  /// Class of the edge between two classified vertices, from the facets beside it (never from its
  /// ends alone).
  EdgeClass classify(const std::array<Point3, 2>& points, const std::array<EntityId, 2>& entities,
    const std::vector<FacetRecord>& facets) const;

  /// The point of the CAD for the midpoint of an edge of this class; with no entity for Straight.
  ClosestPoint projectMidpoint(const EdgeClass& edgeClass, const std::array<Point3, 2>& points,
    const std::array<EntityId, 2>& entities) const;

  /// CAD vertices where creases end, meet or turn by more than NurbsModel::creaseAngle; each wants
  /// a mesh vertex of its own.
  const std::vector<std::int32_t>& corners() const { return corners_; }
  bool isCorner(std::int32_t vertex) const;

private:
  bool fitsNormal(EntityId entity, const ClosestPoint& where, const Vector3& normal) const;
  bool fitsTangent(const ClosestPoint& where, const Vector3& direction) const;
  bool creaseFits(const ClosestPoint& where, const Vector3& direction,
    const std::vector<FacetRecord>& facets) const;
  std::vector<std::int32_t> commonEntities(EntityId a, EntityId b, int dimension) const;
  std::int32_t commonCrease(
    const std::array<Point3, 2>& points, const std::array<EntityId, 2>& entities) const;
  ClosestPoint projectOnCrease(std::int32_t edge, const Point3& point) const;
  ClosestPoint projectSmoothly(const std::array<EntityId, 2>& entities, const Point3& point) const;
  void findCorners();

  const CADModel& model_;
  BoundaryKind kind_;
  std::vector<std::int32_t> corners_;
};

} // namespace cadrefine
