// The facets of a mesh: the sides by which it meets its boundary.
#pragma once

#include "SimplexMesh.h"

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
/// or of triangles. In the order of the cells. Sorts the sides by their vertices: work and memory
/// linear in the number of cells but for a logarithm of the sides at a vertex.
std::vector<Facet> findOuterFacets(const SimplexMesh& mesh);

/// The triangles of a mesh in space, each a facet.
std::vector<Facet> facetsOfSurface(const SimplexMesh& mesh);

} // namespace cadrefine
