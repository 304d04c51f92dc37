// The plane of a planar mesh.
#pragma once

#include "comm/RankExchange.h"

#include <cadrefine/mesh/Mesh.h>

#include <vector>

namespace cadrefine
{

/// A unit normal of the plane in which the points of all ranks lie, to 2e-7 of their extent, which
/// is what single precision leaves; zero where they lie in none. One axis, up to its sign, where
/// they have a coordinate in common. Collective: three gathers of four numbers a rank, and a
/// reduction; work linear in the points.
Vector3 normalOfPoints(RankExchange& exchange, const std::vector<Point3>& points);

/// A unit normal of the plane of a mesh of area (see normalOfPoints), from whose end most of its
/// cells turn counter-clockwise; zero where there is no plane, and for other meshes.
Vector3 planeNormal(RankExchange& exchange, const Mesh& mesh);

/// The normal of the mesh's plane (see above) if it `staysInPlane`, else zero: a mesh that is
/// compared with faces of the CAD need not stay in its plane.
Vector3 planeNormal(RankExchange& exchange, const Mesh& mesh, bool staysInPlane);

} // namespace cadrefine
