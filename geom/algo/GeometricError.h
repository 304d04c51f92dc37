// Area or volume between one facet of a mesh and the CAD.
#pragma once

#include "BoundaryProjector.h"

#include <array>

namespace cadrefine
{

/// Error of one facet.
struct FacetError
{
  double measure = 0;         ///< Area (segments) or volume (triangles) between facet and CAD.
  double chordError = 0;      ///< Largest distance from the middle of the facet's edges to the CAD.
  double maximumDistance = 0; ///< The same over the edges of its children too.
};

/// A facet on the CAD with the classes of its edges: edge k joins corners k and k + 1. A segment
/// has one edge.
struct ErrorFacet
{
  ClassifiedFacet corners;
  std::array<EdgeClass, 3> edges;
  std::array<bool, 3> offCAD{}; ///< Corners that are classified, but have not reached the CAD.
};

/// The area between a boundary edge and the CAD: the triangle over the edge and the projection of
/// its midpoint, and so on on both halves down to `depth` levels (S. Strunk, "High performance
/// adaptive finite element modeling of complex CAD geometry", KTH 2013, Algorithm 4.2). In 3D: the
/// three edge midpoints are projected by the class of their edge; the volume between the flat facet
/// and its four children is that of a closed polyhedron (facet, children, and a triangle over each
/// edge), by the divergence theorem; and so on on the four. Absolute values are added up over the
/// levels.
///
/// Where a corner has not reached the CAD, its point on the CAD takes its place among the children,
/// and the sides of the polyhedron (in 2D the polygon over the edge) join the two.
///
/// Midpoints belong to their edge and not to the facet, so neighbouring facets leave no gap and no
/// overlap between them. On smooth CAD the sum converges to the exact measure like 4^-depth.
/// Work: 1 + 2 + ... + 2^(depth-1) projections in 2D, 3 (1 + 4 + ... + 4^(depth-1)) in 3D.
FacetError geometricError(const BoundaryProjector& projector, const ErrorFacet& facet, int depth);

} // namespace cadrefine
