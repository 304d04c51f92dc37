// Which entities of a CAD model meet, and when directions of mesh and CAD agree.
#pragma once

#include <cadrefine/cad/model/CADModel.h>

#include <array>
#include <cstdint>
#include <vector>

namespace cadrefine
{

/// Whether two unit normals or tangents lie within 60 degrees of each other, either way round:
/// extremely coarse facets lie far off the tangent plane.
bool fitsEitherWay(const Vector3& a, const Vector3& b);

/// Entities of `dimension` (1 or 2) whose closure holds `entity`, ascending.
std::vector<std::int32_t> entitiesAround(const NurbsModel& model, EntityId entity, int dimension);

/// Whether `where` is the entity, a face or an edge, or part of its closure where it meets itself
/// and no other: a vertex of a closed edge, the seam or a pole of a face that is smooth there.
bool isWithin(const NurbsModel& model, EntityId entity, EntityId where);

/// Entities of `dimension` (1 or 2) whose closure holds both `a` and `b`, ascending.
std::vector<std::int32_t> commonEntities(
  const NurbsModel& model, EntityId a, EntityId b, int dimension);

/// Faces whose closure holds the first `count` of these entities, three or four, ascending.
std::vector<std::int32_t> commonFaces(
  const NurbsModel& model, const std::array<EntityId, 4>& entities, int count);

/// The place on the CAD that a mesh has for `point`, whose nearest point is `where`. Where that is
/// on the border of a face, off the edge that the border stands for: the nearest point of that
/// edge, which the faces beside it share. Otherwise `where`.
ClosestPoint onSharedEdge(const CADModel& model, const Point3& point, const ClosestPoint& where);

/// How far from an entity of the CAD, beside the entity's own tolerance, a mesh vertex is that lies
/// on it: 2e-7 of the model's size, more than an IGES file's rounding of 1e-7 of a coordinate makes
/// of it, or a tenth of the vertex's shortest edge where that is less (but at least 1e-9 of the
/// size).
double exactDistance(const CADModel& model, double shortestEdge);

/// The distance of exactDistance for a mesh whose file has five digits, as the short fields of
/// Nastran: 5e-5 of the size, or a tenth of the shortest edge.
double roundedDistance(const CADModel& model, double shortestEdge);

/// Whether the CAD edge at this point, or one that ends there, fits the direction.
bool fitsTangent(const CADModel& model, const ClosestPoint& where, const Vector3& direction);

/// CAD edges that bound both faces, ascending; if these are one face, the edges that bound no other
/// one: its seams and its free border.
std::vector<std::int32_t> edgesBetween(const NurbsModel& model, std::int32_t a, std::int32_t b);

/// Whether a face lies on both sides of the edge without a crease.
bool isSeam(const NurbsEdge& edge);

/// Unit tangent of `edge` at its end `vertex`, pointing away from it.
Vector3 tangentAwayFrom(const CADModel& model, std::int32_t edge, std::int32_t vertex);

/// For each CAD edge the smallest index of the edges that it forms one line with: creases that
/// continue each other beyond CAD vertices that are no corners. A smooth edge is on its own.
std::vector<std::int32_t> findCreaseLines(
  const NurbsModel& model, const std::vector<std::int32_t>& corners);

/// CAD vertices where creases end, meet or turn by more than NurbsModel::creaseAngle, and apexes:
/// ends of seams where the surface has no tangent plane. Ascending.
std::vector<std::int32_t> findCorners(const CADModel& model);

} // namespace cadrefine
