// One rank's piece of a mesh.
#pragma once

#include <cadrefine/base/MeshTypes.h>
#include <cadrefine/base/Vector3.h>

#include <algorithm>
#include <array>
#include <vector>

namespace cadrefine
{

/// The corners of cells of one shape.
template<std::size_t Corners>
using Cells = std::vector<std::array<Index, Corners>>;

/// A piece of a mesh: the cells of the mesh's own dimension and the cells of lower dimension that
/// lie on their sides and carry boundary tags. No cell is on two ranks; vertices may be, with the
/// same id and the same coordinates.
///
/// Corners come in VTK's order. Where cells of a dimension are numbered, those of the first shape
/// come first: tetrahedra, pyramids, wedges, hexahedra; triangles, quadrilaterals.
struct Mesh
{
  int dimension = 3; ///< Dimension of the cells of highest dimension; the same on every rank.
  std::vector<Point3> points;
  std::vector<GlobalId> ids; ///< Global ids of the points; distinct within the piece.
  Cells<4> tetrahedra;
  Cells<5> pyramids; ///< Seen from the apex, corner 4, the base turns counter-clockwise.
  Cells<6> wedges;   ///< Seen from corners 3, 4, 5, the others turn counter-clockwise.
  Cells<8> hexahedra;
  Cells<3> triangles;
  Cells<4> quadrilaterals;
  Cells<2> segments;
  Cells<1> vertices;
  /// Data sets have the wedges as VTK's documentation draws them, in which they turn clockwise.
  bool wedgesAsDocumented = false;

  std::size_t cellCount() const;
  std::size_t cellCount(int ofDimension) const;
  bool hasNonSimplices() const
  {
    return !pyramids.empty() || !wedges.empty() || !hexahedra.empty() || !quadrilaterals.empty();
  }
};

/// Whether a mesh is one of area in space. `plane`: the normal of a planar mesh, else zero.
inline bool isSurface(const Mesh& mesh, const Vector3& plane)
{
  return mesh.dimension == 2 && plane == Vector3{};
}

/// Calls visit(cells) for the simplices of the mesh's own dimension: its tetrahedra, or its
/// triangles. Returns what that returns.
template<class AnyMesh, class Visit>
decltype(auto) visitOwnSimplices(AnyMesh& mesh, const Visit& visit)
{
  return mesh.dimension == 3 ? visit(mesh.tetrahedra) : visit(mesh.triangles);
}

inline std::size_t countOwnSimplices(const Mesh& mesh)
{
  return visitOwnSimplices(mesh, [](const auto& cells) { return cells.size(); });
}

/// Local edges of a tetrahedron, as pairs of local vertices. The same order holds wherever six
/// values a tetrahedron are kept. Edge 5 - i is opposite to edge i.
constexpr int tetrahedronEdges[6][2] = { { 0, 1 }, { 0, 2 }, { 0, 3 }, { 1, 2 }, { 1, 3 },
  { 2, 3 } };

/// Local faces of a tetrahedron, face i opposite to vertex i, normals pointing outward.
constexpr int tetrahedronFaces[4][3] = { { 1, 2, 3 }, { 0, 3, 2 }, { 0, 1, 3 }, { 0, 2, 1 } };

/// The local face of a tetrahedron that is opposite to this vertex of it.
inline const int (&faceOppositeTo(Index vertex, const std::array<Index, 4>& cell))[3]
{
  return tetrahedronFaces[std::find(cell.begin(), cell.end(), vertex) - cell.begin()];
}

/// Local edges of each local face of a tetrahedron: edge k joins corners k and k + 1.
constexpr int tetrahedronFaceEdges[4][3] = { { 3, 5, 4 }, { 2, 5, 1 }, { 0, 4, 2 }, { 1, 3, 0 } };

/// Local edges of a triangle: edge k joins corners k and k + 1.
constexpr int triangleEdges[3][2] = { { 0, 1 }, { 1, 2 }, { 2, 0 } };

/// The shapes of cells. Edges come in the order of VTK's mid nodes but for tetrahedra; faces with
/// their normals outward, triangles with a fourth corner of -1. A corner's simplex is that of the
/// edges at it, which is positive where the cell's Jacobian is; the corner comes first.
namespace shapes
{

struct Vertex
{
  static constexpr int dimension = 0;
  static constexpr std::size_t corners = 1;
  static constexpr auto cells = &Mesh::vertices;
};

struct Segment
{
  static constexpr int dimension = 1;
  static constexpr std::size_t corners = 2;
  static constexpr auto cells = &Mesh::segments;
  static constexpr int edges[1][2] = { { 0, 1 } };
};

struct Triangle
{
  static constexpr int dimension = 2;
  static constexpr std::size_t corners = 3;
  static constexpr auto cells = &Mesh::triangles;
  static constexpr auto& edges = triangleEdges;
};

struct Quadrilateral
{
  static constexpr int dimension = 2;
  static constexpr std::size_t corners = 4;
  static constexpr auto cells = &Mesh::quadrilaterals;
  static constexpr int edges[4][2] = { { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 0 } };
  /// Local edges of its quadrilaterals: here of itself.
  static constexpr int quadEdges[1][4] = { { 0, 1, 2, 3 } };
  /// Its edges in each direction.
  static constexpr int directions[2][2] = { { 0, 2 }, { 1, 3 } };
  static constexpr int cornerSimplices[4][3] = { { 0, 1, 3 }, { 1, 2, 0 }, { 2, 3, 1 },
    { 3, 0, 2 } };
};

struct Tetrahedron
{
  static constexpr int dimension = 3;
  static constexpr std::size_t corners = 4;
  static constexpr auto cells = &Mesh::tetrahedra;
  static constexpr auto& edges = tetrahedronEdges;
  static constexpr int faces[4][4] = { { 1, 2, 3, -1 }, { 0, 3, 2, -1 }, { 0, 1, 3, -1 },
    { 0, 2, 1, -1 } };
};

struct Pyramid
{
  static constexpr int dimension = 3;
  static constexpr std::size_t corners = 5;
  static constexpr auto cells = &Mesh::pyramids;
  static constexpr int edges[8][2] = { { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 0 }, { 0, 4 }, { 1, 4 },
    { 2, 4 }, { 3, 4 } };
  static constexpr int faces[5][4] = { { 0, 3, 2, 1 }, { 0, 1, 4, -1 }, { 1, 2, 4, -1 },
    { 2, 3, 4, -1 }, { 3, 0, 4, -1 } };
  static constexpr int quadEdges[1][4] = { { 3, 2, 1, 0 } };
  /// At the corners of the base alone, which decide whether it is valid.
  static constexpr int cornerSimplices[4][4] = { { 0, 1, 3, 4 }, { 1, 2, 0, 4 }, { 2, 3, 1, 4 },
    { 3, 0, 2, 4 } };
};

struct Wedge
{
  static constexpr int dimension = 3;
  static constexpr std::size_t corners = 6;
  static constexpr auto cells = &Mesh::wedges;
  static constexpr int edges[9][2] = { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 3, 4 }, { 4, 5 }, { 5, 3 },
    { 0, 3 }, { 1, 4 }, { 2, 5 } };
  static constexpr int faces[5][4] = { { 0, 2, 1, -1 }, { 3, 4, 5, -1 }, { 0, 1, 4, 3 },
    { 1, 2, 5, 4 }, { 2, 0, 3, 5 } };
  /// Local edges of its quadrilaterals: of faces 2, 3, 4.
  static constexpr int quadEdges[3][4] = { { 0, 7, 3, 6 }, { 1, 8, 4, 7 }, { 2, 6, 5, 8 } };
  static constexpr int cornerSimplices[6][4] = { { 0, 1, 2, 3 }, { 1, 2, 0, 4 }, { 2, 0, 1, 5 },
    { 3, 5, 4, 0 }, { 4, 3, 5, 1 }, { 5, 4, 3, 2 } };
};

struct Hexahedron
{
  static constexpr int dimension = 3;
  static constexpr std::size_t corners = 8;
  static constexpr auto cells = &Mesh::hexahedra;
  static constexpr int edges[12][2] = { { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 0 }, { 4, 5 }, { 5, 6 },
    { 6, 7 }, { 7, 4 }, { 0, 4 }, { 1, 5 }, { 2, 6 }, { 3, 7 } };
  static constexpr int faces[6][4] = { { 0, 3, 2, 1 }, { 4, 5, 6, 7 }, { 0, 1, 5, 4 },
    { 1, 2, 6, 5 }, { 2, 3, 7, 6 }, { 3, 0, 4, 7 } };
  /// Edges of its faces, in the same order: opposite faces are 0 and 1, 2 and 4, 3 and 5.
  static constexpr int quadEdges[6][4] = { { 3, 2, 1, 0 }, { 4, 5, 6, 7 }, { 0, 9, 4, 8 },
    { 1, 10, 5, 9 }, { 2, 11, 6, 10 }, { 3, 8, 7, 11 } };
  /// Its edges in each direction.
  static constexpr int directions[3][4] = { { 0, 2, 4, 6 }, { 1, 3, 5, 7 }, { 8, 9, 10, 11 } };
  static constexpr int cornerSimplices[8][4] = { { 0, 1, 3, 4 }, { 1, 2, 0, 5 }, { 2, 3, 1, 6 },
    { 3, 0, 2, 7 }, { 4, 7, 5, 0 }, { 5, 4, 6, 1 }, { 6, 5, 7, 2 }, { 7, 6, 4, 3 } };
};

} // namespace shapes

template<class Shape>
constexpr bool isSimplex(Shape)
{
  return Shape::corners == Shape::dimension + 1;
}

/// Calls visit(shape, cells) for the shapes of one dimension, in the order in which their cells are
/// numbered.
template<class AnyMesh, class Visit>
void visitShapes(AnyMesh& mesh, int dimension, const Visit& visit)
{
  const auto visitAll = [&](auto... shape) { (visit(shape, mesh.*(decltype(shape)::cells)), ...); };
  switch (dimension)
  {
    case 3:
      return visitAll(
        shapes::Tetrahedron{}, shapes::Pyramid{}, shapes::Wedge{}, shapes::Hexahedron{});
    case 2:
      return visitAll(shapes::Triangle{}, shapes::Quadrilateral{});
    case 1:
      return visitAll(shapes::Segment{});
    default:
      return visitAll(shapes::Vertex{});
  }
}

/// Calls visit(shape, cells) for the shapes of the mesh's own dimension, which is 2 or 3.
template<class AnyMesh, class Visit>
void visitOwnShapes(AnyMesh& mesh, const Visit& visit)
{
  const auto visitAll = [&](auto... shape) { (visit(shape, mesh.*(decltype(shape)::cells)), ...); };
  mesh.dimension == 3
    ? visitAll(shapes::Tetrahedron{}, shapes::Pyramid{}, shapes::Wedge{}, shapes::Hexahedron{})
    : visitAll(shapes::Triangle{}, shapes::Quadrilateral{});
}

/// Calls visit(shape, corners) for the cell of this number among those of the mesh's own dimension.
template<class Visit>
void visitOwnCell(const Mesh& mesh, Index number, const Visit& visit)
{
  std::size_t first = 0;
  visitOwnShapes(mesh,
    [&](auto shape, const auto& cells)
    {
      const std::size_t place = static_cast<std::size_t>(number) - first; // huge where it is below
      if (place < cells.size())
      {
        visit(shape, cells[place]);
      }
      first += cells.size();
    });
}

/// Calls visit(shape, cells) for the shapes of all dimensions, 0 first.
template<class AnyMesh, class Visit>
void visitShapes(AnyMesh& mesh, const Visit& visit)
{
  for (int dimension = 0; dimension < 4; ++dimension)
  {
    visitShapes(mesh, dimension, visit);
  }
}

inline std::size_t Mesh::cellCount(int ofDimension) const
{
  std::size_t count = 0;
  visitShapes(*this, ofDimension, [&](auto, const auto& cells) { count += cells.size(); });
  return count;
}

inline std::size_t Mesh::cellCount() const
{
  return cellCount(0) + cellCount(1) + cellCount(2) + cellCount(3);
}

} // namespace cadrefine
