// Area or volume between one facet of second order and the CAD.
#pragma once

#include <cadrefine/error/GeometricError.h>

#include <array>

namespace cadrefine
{

/// A facet of second order on the CAD. A segment has two corners and one mid node.
struct CurvedErrorFacet
{
  ErrorFacet straight;              ///< Its corners, and the classes of its edges.
  std::array<Point3, 4> nodes;      ///< The mid node of each edge.
  std::array<EntityId, 4> entities; ///< CAD entities of the mid nodes.
  std::array<bool, 4> offCAD{}; ///< Mid nodes that are classified, but have not reached the CAD.
  std::int32_t face = -1;       ///< Its CAD face; -1: not known.
};

/// The area or volume between the curved facet and the CAD. The facet's parameters are halved (in
/// space: quartered) depth + 1 times; the corners of the parts are points x_i of the curved facet,
/// and each has a place c_i on the CAD: nodes their own, points of an edge by the class of the edge
/// as in refinement, others as new vertices inside a face; the middle of a part of a quadrilateral
/// on its CAD face. Each part stands for the prism between
/// its corners and their places, whose sides are ruled. With e_k = x_k - x_0, f_k = c_k - c_0 - e_k
/// and d the mean of c_i - x_i its volume is
///
///   d . (e_1 x e_2 + (e_1 x f_2 + f_1 x e_2) / 2 + f_1 x f_2 / 3) / 2,
///
/// the integral over the parameters and the way from x to c; in the plane the area is
/// |d x (e_1 + f_1 / 2)|. A part of a quadrilateral is bilinear: the mean of both ways to cut it in
/// two prisms is exact. Sides of neighbouring parts are the same, so nothing is counted twice,
/// and the sum converges like 4^-depth to the volume between the curved facet and the CAD. Absolute
/// values are added up over the parts: where facet and CAD cross in a part, it counts too little,
/// and less so the deeper.
///
/// largestDistance is the largest distance of these points from their places, chordError that of
/// points on the facet's edges. Work: 3 (4 + 16 + ... + 4^depth) projections, of a
/// quadrilateral 1 + 5 (4 + 16 + ... + 4^depth), in the plane 2 + 4 + ... + 2^depth.
FacetError curvedError(
  const BoundaryProjector& projector, const CurvedErrorFacet& facet, int depth);

} // namespace cadrefine
