// All thresholds by which mesh entities are classified on the CAD, but for the angle of a crease, a
// property of the model (NurbsModel::creaseAngle).
#pragma once

#include <cadrefine/nurbs/NurbsModel.h>

#include <cmath>

namespace cadrefine
{

/// Lengths are in terms of what is named, never absolute: a mesh of any size is classified alike.
/// They were chosen on meshes of gmsh, whose entities are known, and are tested against these (see
/// docs/methods.md).
struct ClassificationTolerances
{
  static double cosineOfDegrees(double angle)
  {
    return std::cos(angle * (3.14159265358979323846 / 180));
  }

  // Angles

  /// Cosine of 60 degrees. Normals and tangents that differ by less fit: six facets round a
  /// cylinder do, a wall that meets the CAD at a right angle does not.
  static constexpr double fittingCosine = 0.5;
  /// Neighbours that differ by less than a crease are on one smooth surface.
  static double creaseCosine() { return std::cos(NurbsModel::creaseAngle); }
  /// Twice the angle of a crease: two facets of a coarse mesh on one curved face may differ so.
  static double smoothFacetsCosine() { return std::cos(2 * NurbsModel::creaseAngle); }
  /// Facets with a larger angle (10 degrees) have an edge between them. Less than that of a crease,
  /// which a mesh that cuts the corner shows blunted.
  static inline const double flatCosine = cosineOfDegrees(10);
  /// A mesh edge follows a CAD edge up to this angle (30 degrees). Stricter than `fittingCosine`:
  /// along a smooth CAD edge normals do not change, and the angle alone tells whether the mesh has
  /// edges there.
  static inline const double followingCosine = cosineOfDegrees(30);

  /// Sine of the angle (45 degrees) from which on a crease goes through a wall, not along it.
  static inline const double throughWall = cosineOfDegrees(45);
  /// Sine of the angle between facets of one plane.
  static constexpr double samePlane = 1e-6;

  // Distances of mesh edges from CAD edges

  /// A crease passes the middle of a mesh edge within this part of its reach (its length, or the
  /// height of a facet over it): beyond, another mesh edge is nearer.
  static constexpr double creaseDistance = 0.5;
  /// Both ends of a mesh edge along a crease are so near to some crease, in terms of its length,
  /// lest an edge that leaves a crease be taken for it.
  static constexpr double endDistance = 0.5;
  /// How far the ends of a mesh edge that follows a smooth CAD edge are from that, in terms of its
  /// reach: vertices that a mesher put there are nearer, those of a mesh that does not know of it
  /// mostly farther.
  static constexpr double followingDistance = 0.15;
  /// How far the middle of such a mesh edge is from the CAD edge, in terms of its length: a chord
  /// over a quarter of a circle is 0.21 from it.
  static constexpr double followingMiddle = 0.25;
  /// Part of a smooth CAD edge that a mesh must run along to know of it.
  static constexpr double coveredPart = 0.5;

  // Distances of vertices

  /// A mesh vertex takes a corner of the CAD within this part of its longest boundary edge: beyond,
  /// another vertex is nearer.
  static constexpr double cornerDistance = 0.5;
  /// A mesh vertex takes an end of two CAD edges that is no corner within this part of its shortest
  /// boundary edge: as `followingDistance`.
  static constexpr double jointDistance = 0.15;
  /// A crease is close to a vertex, in terms of its longest boundary edge: half of
  /// `creaseDistance`, as a vertex that could be on either side is to be named.
  static constexpr double conflictDistance = 0.25;

  // Facets

  /// A projected edge is not shorter than this part of what it was, nor longer than its inverse:
  /// facets of walls and of the far field collapse.
  static constexpr double leastShrinking = 0.5;
  /// A projected facet keeps more than this part of its area: those beside a face, in its plane,
  /// collapse.
  static constexpr double leastArea = 0.25;
  /// Where the user sets no limit, no corner of a facet is farther from the CAD than this part of
  /// the facet's longest edge.
  static constexpr double farthestCorner = 0.5;
  /// Part of the facets on a CAD face that must agree on its side.
  static constexpr double sideMajority = 0.75;

  // What lies on the CAD already, in terms of the model's size

  /// How far from the CAD a vertex may be to lie on it: more than an IGES file's rounding of 1e-7
  /// of a coordinate makes of a point on the CAD.
  static constexpr double exact = 2e-7;
  /// How far from the CAD a vertex may be to lie on it, in a mesh whose coordinates have five
  /// digits.
  static constexpr double rounded = 5e-5;
  /// A vertex on the CAD is never farther from it than this part of its shortest edge,
  static constexpr double exactPartOfEdge = 0.1;
  /// or than this distance, the precision of a nearest point, if that is larger.
  static constexpr double leastExact = 1e-9;
  /// Distances that differ by less are the same.
  static constexpr double tie = 1e-9;
  /// How far beside a vertex normals are compared: far above the precision of a nearest point, far
  /// below any feature.
  static constexpr double besideVertex = 1e-6;
};

} // namespace cadrefine
