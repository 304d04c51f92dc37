// Area or volume between facets of a mesh and the CAD.
#pragma once

#include <cadrefine/classification/BoundaryProjector.h>

#include <array>
#include <functional>
#include <vector>

namespace cadrefine
{

/// Error of one facet.
struct FacetError
{
  double measure = 0; ///< Area (segments) or volume (triangles) between facet and CAD.
  /// Largest distance from the middle of the facet's edges (of a quadrilateral also its own) to the
  /// CAD.
  double chordError = 0;
  double largestDistance = 0; ///< Largest such distance, over the edges of its children too.
  double lastLevel = 0;       ///< What the last level of the recursion has added to `measure`.
};

/// The measure at the end of all levels, if each adds a quarter of the one before, as on smooth
/// CAD.
double extrapolatedMeasure(const FacetError& error);

/// A corner of facets.
struct SurfacePoint
{
  Point3 point{};
  EntityId entity; ///< CAD entity; none: not on the CAD.
  /// Its place on the CAD; elsewhere than `point` where that has not reached it.
  Point3 place = point;
  EntityId placeEntity = entity;
};

struct SurfaceEdge
{
  std::array<Index, 2> ends{};
  EdgeClass edgeClass;
};

/// Edge k joins corners k and k + 1. A segment has two corners and one edge.
struct SurfaceFacet
{
  std::array<Index, 4> corners{};
  std::array<Index, 4> edges{};
  std::int32_t face = -1; ///< Its CAD face; -1: not known.
  Index quad = -1;        ///< Its number among the quadrilaterals; -1: it is none.
};

/// Facets on the CAD, with the points and edges that they share.
struct ClassifiedSurface
{
  BoundaryKind kind = BoundaryKind::Faces;
  std::vector<SurfacePoint> points;
  std::vector<SurfaceEdge> edges;
  std::vector<SurfaceFacet> facets;

  BoundaryEdge edge(std::size_t e) const;
  /// The edges whose midpoints are wanted: all edges, and one for each quadrilateral.
  std::vector<BoundaryEdge> allEdges() const;
};

/// The edge whose midpoint is the middle of a quadrilateral with these corners: on this CAD face,
/// or, where that is -1, on those that two opposite corners share.
BoundaryEdge middleOfQuad(
  const std::array<Point3, 4>& points, const std::array<EntityId, 4>& entities, std::int32_t face);

/// Finds the midpoints of edges (see MidpointProjection.h), in their order.
using ProjectMidpoints = std::function<std::vector<ClosestPoint>(std::vector<BoundaryEdge>)>;

/// The area between each boundary edge and the CAD: the triangle over the edge and the projection
/// of its midpoint, and so on on both halves down to `depth` levels (S. Strunk, "High performance
/// adaptive finite element modeling of complex CAD geometry", KTH 2013, Algorithm 4.2). In 3D: the
/// three edge midpoints are projected by the class of their edge; the volume between the flat facet
/// and its four children is that of a closed polyhedron (facet, children, and a triangle over each
/// edge), by the divergence theorem; and so on on the four. Absolute values are added up over the
/// levels. Where heights over the facet, linear between its corners and middles, have either sign
/// (facets that cross the CAD, saddles), what cancels in its volume is added. A quadrilateral is
/// the bilinear surface between its corners, and its four children meet in the projection of its
/// middle, onto its CAD face.
///
/// Where a corner has not reached the CAD, its place there stands for it among the children, and
/// the sides of the polyhedron (in 2D the polygon over the edge) join the two.
///
/// Midpoints belong to their edge and not to the facet, so neighbouring facets leave no gap and no
/// overlap between them. On smooth CAD the sum converges to the exact measure like 4^-depth, from
/// below: 3/4 of it at depth 1, 15/16 at depth 2.
///
/// `midpoints` are those of ClassifiedSurface::allEdges. The facets are measured in `parts` runs,
/// one after the other, of which each projects depth - 1 times. Work: 2 + 4 + ... + 2^(depth-1)
/// projections an edge, in 3D also 3, 6 + 12, ... a facet: half of what facets would need that
/// shared nothing. Memory: some 400 bytes for each facet of a part and each of its 4^(depth-1)
/// descendants.
std::vector<FacetError> geometricErrors(const ClassifiedSurface& surface,
  const std::vector<ClosestPoint>& midpoints, int depth, std::size_t parts,
  const ProjectMidpoints& project);

/// A facet on the CAD with the classes of its edges: edge k joins corners k and k + 1. A segment
/// has one edge.
struct ErrorFacet
{
  ClassifiedFacet corners;
  std::array<EdgeClass, 4> edges;
  std::array<bool, 4> offCAD{}; ///< Corners that are classified, but have not reached the CAD.
};

} // namespace cadrefine
