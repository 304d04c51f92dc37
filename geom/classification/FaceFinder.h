// The CAD face that a facet of a mesh's boundary stands for.
#pragma once

#include <cadrefine/base/EntityId.h>
#include <cadrefine/base/Vector3.h>
#include <cadrefine/cad/model/CADModel.h>

#include <array>
#include <cstdint>
#include <vector>

namespace cadrefine
{

/// For each CAD face how the outward normals of the mesh's facets on it compare with its own: 1
/// alike, -1 opposite (a mesh around the CAD), 0 either.
using FaceSides = std::vector<std::int8_t>;

/// The sides by the majority of `alike` and `opposite`, the numbers of facets a face that point
/// either way: a face has the side of three quarters of its own facets, or else that of three
/// quarters of all.
FaceSides decideSides(
  const std::vector<std::int64_t>& alike, const std::vector<std::int64_t>& opposite);

/// The corners of a facet of the boundary and their nearest points on the model.
struct CornerHits
{
  std::array<Point3, 4> points{};
  std::array<ClosestPoint, 4> hits{};
  int corners = 3;
  /// For each corner, 1 if all vertices that share an edge with it have their nearest point on the
  /// same face.
  std::array<unsigned char, 4> amongItsOwn{};
  /// All corners lie on the CAD already (see exactDistance).
  unsigned char exact = 0;
  unsigned char isInside = 0; ///< The facet is between two cells: its normal may be either one.
};

struct FaceMatch
{
  std::int32_t face = -1; ///< -1: none fits.
  /// False where the nearest point of the facet's centroid lies on an edge or a vertex: then the
  /// facets beside this one may know better.
  unsigned char certain = 0;
};

/// Finds the CAD faces of facets. All answers are pure functions of the arguments and the model.
class FaceFinder
{
public:
  /// `sides` has one entry for each face of the model.
  FaceFinder(const CADModel& model, FaceSides sides) : model_(model), sides_(std::move(sides)) {}

  /// Finds the face of a facet: the nearest to its centroid of those whose normal there fits the
  /// facet's, to 60 degrees, and points the way that `sides` tells. So the two sides of a thin part
  /// are not confused. For facets whose corners lie on the CAD already, a face that all corners lie
  /// on, if it fits. No query where a corner and all vertices around it lie nearest to one face;
  /// otherwise one of the whole model, and where the normal does not fit, two more and two for each
  /// face at the points found.
  FaceMatch find(const CornerHits& facet) const;

  /// Whether a face at the point `where` of the model has a normal that fits a facet's `normal`
  /// and, unless `eitherWay`, is on the right side.
  bool fitsAt(const ClosestPoint& where, const Vector3& normal, bool eitherWay) const;

  /// The nearest of these faces whose normal fits, either way round, that of the facet with these
  /// points; -1: none.
  std::int32_t nearestOf(
    const std::vector<std::int32_t>& faces, const std::array<Point3, 4>& points, int corners) const;

private:
  bool fits(
    std::int32_t face, const Vector3& normalOfFace, const Vector3& normal, bool eitherWay) const;
  std::int32_t faceByCorners(const CornerHits& facet, const Vector3& normal) const;
  std::int32_t nearestFitting(const std::vector<std::int32_t>& faces, const Point3& centroid,
    const Vector3& normal, bool eitherWay) const;
  std::vector<std::int32_t> facesAround(const std::vector<EntityId>& entities) const;

  const CADModel& model_;
  FaceSides sides_;
};

} // namespace cadrefine
