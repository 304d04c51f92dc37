// One rank's piece of a mesh of simplices.
#pragma once

#include <cadrefine/base/MeshTypes.h>
#include <cadrefine/base/Vector3.h>

#include <array>
#include <vector>

namespace cadrefine
{

/// Vertices of a cell. Cells of every dimension fit; only the first `dimension + 1` entries count.
template<std::size_t Corners>
using Simplices = std::vector<std::array<Index, Corners>>;

/// A piece of a mesh: the cells of the mesh's own dimension (tetrahedra in 3D, triangles in 2D) and
/// the cells of lower dimension that lie on their sides and carry boundary tags. No cell is on two
/// ranks; vertices may be, with the same id and the same coordinates.
struct SimplexMesh
{
  int dimension = 3; ///< 3: tetrahedra, 2: triangles; the same on every rank.
  std::vector<Point3> points;
  std::vector<GlobalId> ids; ///< Of the points; distinct within the piece.
  Simplices<4> tetrahedra;
  Simplices<3> triangles;
  Simplices<2> segments;
  Simplices<1> vertices;

  std::size_t cellCount() const
  {
    return tetrahedra.size() + triangles.size() + segments.size() + vertices.size();
  }
};

/// visit(cells) of the cells of the mesh's own dimension.
template<class Mesh, class Visit>
decltype(auto) visitCells(Mesh& mesh, const Visit& visit)
{
  return mesh.dimension == 3 ? visit(mesh.tetrahedra) : visit(mesh.triangles);
}

/// Local edges of a tetrahedron, as pairs of local vertices. The same order holds wherever six
/// values a tetrahedron are kept. Edge 5 - i is opposite to edge i.
constexpr int tetrahedronEdges[6][2] = { { 0, 1 }, { 0, 2 }, { 0, 3 }, { 1, 2 }, { 1, 3 },
  { 2, 3 } };

/// Local faces of a tetrahedron, face i opposite to vertex i, normals pointing outward.
constexpr int tetrahedronFaces[4][3] = { { 1, 2, 3 }, { 0, 3, 2 }, { 0, 1, 3 }, { 0, 2, 1 } };

/// Local edges of each of these faces: edge k joins corners k and k + 1.
constexpr int tetrahedronFaceEdges[4][3] = { { 3, 5, 4 }, { 2, 5, 1 }, { 0, 4, 2 }, { 1, 3, 0 } };

/// Local edges of a triangle: edge k joins corners k and k + 1.
constexpr int triangleEdges[3][2] = { { 0, 1 }, { 1, 2 }, { 2, 0 } };

} // namespace cadrefine
