// The facets of a mesh: the sides by which it meets its boundary.
#pragma once

#include <cadrefine/base/ParallelFor.h>
#include <cadrefine/mesh/Mesh.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <vector>

namespace cadrefine
{

/// A facet: a triangle or quadrilateral of a 3D mesh's boundary (or of a mesh of these in space),
/// or a segment of a planar mesh's boundary. Where it has fewer than four vertices, -1 follows.
struct Facet
{
  /// Its corners, in the order that gives the outward normal.
  std::array<Index, 4> vertices{ -1, -1, -1, -1 };
  Index cell = -1;       ///< Its cell of the mesh's own dimension.
  bool isInside = false; ///< The facet is between two cells.

  int corners() const { return vertices[3] >= 0 ? 4 : vertices[2] >= 0 ? 3 : 2; }
  /// Edge k joins corners k and k + 1; a segment is its own edge 0.
  int edges() const { return vertices[2] >= 0 ? corners() : 1; }
  const Index* begin() const { return vertices.data(); }
  const Index* end() const { return vertices.data() + corners(); }
};

/// The points of a facet's corners, in the first places.
inline std::array<Point3, 4> pointsOf(const Mesh& mesh, const Facet& facet)
{
  std::array<Point3, 4> points{};
  std::transform(
    facet.begin(), facet.end(), points.begin(), [&](Index vertex) { return mesh.points[vertex]; });
  return points;
}

/// The local sides of a shape: the faces of one of volume, the edges of others.
template<class Shape>
constexpr auto& sidesOf(Shape)
{
  if constexpr (Shape::dimension == 3)
  {
    return Shape::faces;
  }
  else
  {
    return Shape::edges;
  }
}

/// Calls use(side) for the sides of a cell of this shape with these corners and this number.
template<class Shape, class Corners, class Use>
void forEachSide(Shape shape, const Corners& corners, Index cell, const Use& use)
{
  for (const auto& local : sidesOf(shape))
  {
    Facet side;
    std::transform(std::begin(local), std::end(local), side.vertices.begin(),
      [&](int corner) { return corner < 0 ? -1 : corners[corner]; });
    side.cell = cell;
    use(side);
  }
}

/// Calls use(side) for the sides of all cells of the mesh's own dimension, which is 2 or 3.
template<class Use>
void forEachSide(const Mesh& mesh, const Use& use)
{
  Index cell = 0;
  visitOwnShapes(mesh,
    [&](auto shape, const auto& cells)
    {
      for (const auto& corners : cells)
      {
        forEachSide(shape, corners, cell++, use);
      }
    });
}

/// Sides of the cells of the mesh's own dimension that are met once in this piece. In the order of
/// the cells. Lists the cells at the smallest vertices of their sides: work linear in the number of
/// cells but for a logarithm of the sides at a vertex, memory 8 bytes a cell. With `among`, a flag
/// for each vertex, only the sides are looked at whose vertices are all flagged.
std::vector<Facet> findOuterFacets(const Mesh& mesh, const std::vector<unsigned char>& among = {},
  const ParallelFor& parallelFor = serialFor);

/// The triangles and quadrilaterals of a mesh in space, each a facet.
std::vector<Facet> facetsOfSurface(const Mesh& mesh);

} // namespace cadrefine
