// Where the middles of a mesh's boundary edges belong on the CAD. All answers are pure functions of
// the edge and the model, and the same for both directions of the edge.
#pragma once

#include <cadrefine/classification/BoundaryProjector.h>

#include <functional>
#include <vector>

namespace cadrefine
{

/// The point of the CAD for the midpoint of an edge; with no entity for Straight. Where an end of
/// the edge is nearest, as under a bow of the CAD that is as high as it is wide, a point between
/// the ends, as far from one as from the other. If both ends lie on one CAD edge and another one is
/// nearest, as for a diameter: such a point on their own CAD edge. Likewise on the face of the
/// edge, unless another face is nearer by a fifth or more (a diameter under a dome). For a chord
/// that cuts off a nose, its tip (see onNose).
ClosestPoint projectMidpoint(const BoundaryProjector& projector, const BoundaryEdge& edge);

/// The tip of a nose under a smooth edge whose midpoint is nearest to `where`: where the normals at
/// its ends are more than 90 degrees apart, as across the nose of a wing, the place before or
/// behind the midpoint whose normal lies between them, if that of `where` does not. Else a place
/// with no entity. Work: none unless the CAD is higher than a twentieth of the edge; else two
/// projections, and six on a nose.
ClosestPoint onNose(
  const BoundaryProjector& projector, const BoundaryEdge& edge, const ClosestPoint& where);

/// A place for the midpoint of an edge that is projected to `where`, in its face, or in those that
/// both ends share: not on another one that is nearer to a chord which leaves its face, and not on
/// a CAD edge that the mesh edge is not on, where it would meet the vertices of the CAD edge's own
/// mesh edges. Inside a smooth CAD edge, as the rim of a fillet, as far from it as the ends of the
/// mesh edge are in the mean, or from a corner of the face half as far as the midpoint is outside;
/// inside a crease as far as it is outside, or less where the face is narrower, or more where the
/// midpoint is right over the crease. Work: none where `where` is on such a face; else a projection
/// a face, and up to 26 more.
ClosestPoint offBorder(
  const BoundaryProjector& projector, const BoundaryEdge& edge, const ClosestPoint& where);

/// A place on the CAD for the midpoint of a smooth edge that is projected to `where`, in the plane
/// of this unit normal through the edge: a plane of symmetry, or another plane wall that is not in
/// the CAD, stays plane where the CAD cuts it at a slant. By Newton's method, from tangent plane to
/// tangent plane. Returns `where` if it is in the plane already, or the normal is zero, if the CAD
/// turns from the plane by less than 10 degrees, or if that finds no place. Work: none if `where`
/// is in the plane; else three or four projections.
ClosestPoint inPlane(const BoundaryProjector& projector, const BoundaryEdge& edge,
  const ClosestPoint& where, const Vector3& normal);

/// The first accepted place on the CAD of points beside the midpoint of an edge: by these parts of
/// the edge's length along a unit vector. It is no farther from the midpoint than the edge is long.
/// With no entity if there is none. Work: a projection a part.
ClosestPoint placeBeside(const BoundaryProjector& projector, const BoundaryEdge& edge,
  const Vector3& direction, const std::vector<double>& parts,
  const std::function<bool(const ClosestPoint&)>& accepts);

/// Whether a smooth edge may lead so far across a bore that its midpoint was projected to the other
/// side: the place is on a face or a smooth CAD edge, and farther away than a tenth of the edge's
/// length, which may lead along the bore, too.
bool isFarAcross(
  const BoundaryProjector& projector, const BoundaryEdge& edge, const ClosestPoint& where);

/// A place for the midpoint of an edge that is projected to `where`, on the side of a bore that the
/// mesh is on: the CAD's outward normal there and this one of the mesh, a unit vector, make less
/// than 73 degrees. The nearest one of points up to the edge's length before or behind the
/// midpoint. Returns `where` if they make less than 107 degrees there, if the `sides` of its face
/// are not known, or if there is no such place. Work: none, or up to eight projections.
ClosestPoint facing(const BoundaryProjector& projector, const BoundaryEdge& edge,
  const ClosestPoint& where, const Vector3& normal, const FaceSides& sides);

} // namespace cadrefine
