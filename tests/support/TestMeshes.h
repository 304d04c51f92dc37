// Small meshes with known volumes and boundaries.
#pragma once

#include <cadrefine/mesh/Mesh.h>

#include <array>
#include <cstdint>

namespace cadtest
{

/// One tetrahedron or triangle, with ids 0, 1, ...
cadrefine::Mesh oneTetrahedron(const std::array<cadrefine::Point3, 4>& points);
cadrefine::Mesh oneTriangle(const std::array<cadrefine::Point3, 3>& points);

/// The unit cube as n * n * n boxes of six tetrahedra each. Inner vertices are moved at random by
/// up to `jitter` / n in each direction (0.1 keeps all cells valid); ids are in a random order.
cadrefine::Mesh cubeMesh(int n, double jitter, std::uint64_t seed);
/// The unit square likewise, as n * n boxes of two triangles each.
cadrefine::Mesh squareMesh(int n, double jitter, std::uint64_t seed);

/// The same mesh with its cells in another order.
cadrefine::Mesh withShuffledCells(cadrefine::Mesh mesh, std::uint64_t seed);

/// Ball round the origin: the 20 tetrahedra between an icosahedron and its centre. Vertices lie off
/// the sphere by up to `offset` times the radius, in and out.
cadrefine::Mesh ballMesh(double radius, double offset);
/// That ball, its first 20 tetrahedra, in a shell of three times its size; the 20 triangles between
/// the two are listed.
cadrefine::Mesh ballInShellMesh(double radius, double offset);
/// A valid ball whose inner vertex stands so near to one side that the side's cell inverts when the
/// side's corners are put onto the sphere, unless the inner vertex makes way.
cadrefine::Mesh crowdedBallMesh(double radius);
/// The 20 triangles of its surface; vertices are those of ballMesh but for the centre.
cadrefine::Mesh sphereMesh(double radius, double offset);
/// Solid torus round the z axis: `around` sections of `corners` corners and a centre each.
cadrefine::Mesh torusMesh(double majorRadius, double minorRadius, int around, int corners);
/// A prism over a regular polygon with corners on a circle round the z axis, its caps without inner
/// vertices; in so many layers.
cadrefine::Mesh prismMesh(double radius, double height, int corners, int layers);
/// Triangles between a polygon with `corners` corners and its centre, in the plane z = 0.
cadrefine::Mesh discMesh(double radius, double offset, int corners);
/// That disc, its first triangles, in a ring of three times its size; the segments between the two
/// are listed.
cadrefine::Mesh discInRingMesh(double radius, double offset, int corners);
/// The unit squares of four corners at z = 0 and z = 1, of two triangles each, the lower one first.
cadrefine::Mesh twoSquaresMesh();

/// Two unit cubes of n * n * n boxes that have an edge in common and nothing else.
cadrefine::Mesh cubesAtAnEdgeMesh(int n);
/// The same, with a corner in common and nothing else.
cadrefine::Mesh cubesAtACornerMesh(int n);
/// Three unit squares in space, of n * n boxes of two triangles each, that have an edge in common,
/// on the z axis.
cadrefine::Mesh threeSheetsMesh(int n);

} // namespace cadtest
