// The CAD edge along which an edge of a mesh's boundary runs.
#pragma once

#include <cadrefine/base/EntityId.h>
#include <cadrefine/base/Vector3.h>
#include <cadrefine/cad/model/CADModel.h>

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace cadrefine
{

/// What an edge of the boundary needs to know of a facet beside it, on whatever rank that is.
struct FacetRecord
{
  Vector3 normal{};        ///< Unit outward normal of a triangle.
  double area = 0;         ///< Area of a triangle.
  unsigned char onCAD = 0; ///< The facet stands for a part of the CAD.
  unsigned char free = 0; ///< The facet is not on the CAD, because the user's region leaves it out.
  std::int32_t face = -1; ///< CAD face that a triangle on the CAD stands for; -1: not known.
  std::int32_t ear = -1;  ///< CAD edge that all corners of a triangle lie on; -1: none.
  unsigned char odd = 0;  ///< All corners of a facet lie on the CAD, but its normal fits no face.
  unsigned char isInside = 0; ///< The facet is between two cells: its normal may be either one.
};

/// The facets on the CAD beside an edge, or none where a facet beside it was left out by the user.
std::vector<FacetRecord> facetsOnCAD(const std::vector<FacetRecord>& facets);

/// A mesh edge between one facet on the CAD (the rim of these) or two.
struct MeshEdge
{
  std::array<Point3, 2> points;
  std::array<FacetRecord, 2> facets;
  int facetCount = 2;
  /// 1 for an end that lies on the CAD already: it does not move to a smooth CAD edge for which the
  /// CAD gives no reason.
  std::array<unsigned char, 2> settled{};
};

/// The mesh edge with its facets; where there are more than two, with each pair of them.
std::vector<MeshEdge> meshEdges(
  const std::array<Point3, 2>& points, const std::vector<FacetRecord>& onCAD);

/// Whether the mesh edge is a rim, or its facets make an angle of more than 10 degrees: less than
/// the 15 of a crease.
bool hasAngle(const MeshEdge& edge);

/// The CAD edge for a mesh edge, and how far the middle of that (or its farther end, if it follows
/// the CAD edge) is from it.
struct EdgeMatch
{
  std::int32_t edge = -1; ///< -1: none.
  double distance = std::numeric_limits<double>::infinity();
  unsigned char unsettles = 0; ///< A settled end of the mesh edge does not lie on it.

  friend bool operator<(const EdgeMatch& a, const EdgeMatch& b)
  {
    return a.distance != b.distance ? a.distance < b.distance : a.edge < b.edge;
  }
};

/// Finds the CAD edges that mesh edges of boundaries of triangles run along. All answers are pure
/// functions of the arguments and the model.
class EdgeFinder
{
public:
  explicit EdgeFinder(const CADModel& model) : model_(model) {}

  /// Finds the CAD edge along which a mesh edge runs, the nearest of these:
  ///   - creases between the faces of the two facets (of one facet: of its face), if they pass the
  ///     middle of the mesh edge within half of its length and of the facets' heights over it, at
  ///     an angle of up to 60 degrees, the normals of their faces fit those of the facets, and both
  ///     ends are within half of its length of some crease;
  ///   - smooth edges between the two faces, and edges that one face has on both sides, that the
  ///     mesh follows: if both ends are within 0.15 of these lengths, at an angle of up to 30
  ///     degrees; the same of creases between two faces whose normals do not fit;
  ///   - where there is none of these, and facets that are not on the same face make an angle: the
  ///     nearest crease of the whole model, with the limits above.
  /// Cost: a query for each edge that the faces share, at times one of the whole model, and two of
  /// the edge found.
  EdgeMatch find(const MeshEdge& edge) const;
  /// The nearest crease for any of these mesh edges, with the limits of `find`.
  EdgeMatch findCrease(const std::vector<MeshEdge>& edges) const;

  /// Nearest crease (sharp edges and their ends) up to `limit`.
  ClosestPoint nearestCrease(const Point3& point, double limit) const;

  /// Whether the CAD edge passes the middle of the chord within a quarter of its length, at an
  /// angle of up to 30 degrees.
  bool follows(std::int32_t edge, const std::array<Point3, 2>& points) const;

private:
  bool fitsNormals(const ClosestPoint& where, const MeshEdge& edge) const;
  bool endsAreNearCreases(const MeshEdge& edge) const;
  bool passesAsCrease(const ClosestPoint& where, const MeshEdge& edge) const;
  bool unsettles(const MeshEdge& edge, std::int32_t match) const;
  EdgeMatch matchCrease(std::int32_t candidate, const MeshEdge& edge, double reach) const;
  EdgeMatch matchFollowed(std::int32_t candidate, const MeshEdge& edge, double reach) const;
  EdgeMatch matchAnyCrease(const MeshEdge& edge, double reach) const;
  EdgeMatch findCrease(const MeshEdge& edge) const;
  std::vector<std::int32_t> candidates(const MeshEdge& edge) const;

  const CADModel& model_;
};

} // namespace cadrefine
