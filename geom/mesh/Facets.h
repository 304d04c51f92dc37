// The facets of a mesh: the sides by which it meets its boundary.
#pragma once

#include <cadrefine/base/ParallelFor.h>
#include <cadrefine/mesh/SimplexMesh.h>

#include <array>
#include <vector>

namespace cadrefine
{

/// A facet: a triangle of a 3D mesh's boundary (or of a mesh of triangles in space), or a segment
/// of a planar mesh's boundary (third vertex -1).
struct Facet
{
  std::array<Index, 3> vertices; ///< In the order that gives the outward normal.
  Index cell = -1;               ///< Its cell of the mesh's own dimension.
};

/// Sides of the cells of the mesh's own dimension that are met once in this piece: of tetrahedra,
/// or of triangles. In the order of the cells. Lists the cells at the smallest vertices of their
/// sides: work linear in the number of cells but for a logarithm of the sides at a vertex, memory 8
/// bytes a cell. With `among`, a flag for each vertex, only the sides are looked at whose vertices
/// all have one.
std::vector<Facet> findOuterFacets(const SimplexMesh& mesh,
  const std::vector<unsigned char>& among = {}, const ParallelFor& parallelFor = serialFor);

/// The triangles of a mesh in space, each a facet.
std::vector<Facet> facetsOfSurface(const SimplexMesh& mesh);

} // namespace cadrefine
