// Which entities of a CAD model meet, and when directions of mesh and CAD agree.
#pragma once

#include "CADModel.h"

#include <cstdint>
#include <vector>

namespace cadrefine
{

/// Whether two unit normals or tangents lie within 60 degrees of each other, either way round:
/// extremely coarse facets lie far off the tangent plane.
bool fitsEitherWay(const Vector3& a, const Vector3& b);

/// Entities of `dimension` (1 or 2) whose closure holds `entity`, ascending.
std::vector<std::int32_t> entitiesAround(const NurbsModel& model, EntityId entity, int dimension);

/// Entities of `dimension` (1 or 2) whose closure holds both, ascending.
std::vector<std::int32_t> commonEntities(
  const NurbsModel& model, EntityId a, EntityId b, int dimension);

/// Whether the CAD edge at this point, or one that ends there, fits the direction.
bool fitsTangent(const CADModel& model, const ClosestPoint& where, const Vector3& direction);

/// CAD edges that bound both faces, ascending; of one face the edges that bound no other one: its
/// seams and its free border.
std::vector<std::int32_t> edgesBetween(const NurbsModel& model, std::int32_t a, std::int32_t b);

/// Whether a face lies on both sides of the edge without a crease.
bool isSeam(const NurbsEdge& edge);

/// Length of the edge, by chords between 16 points a segment.
double lengthOf(const NurbsEdge& edge);

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
