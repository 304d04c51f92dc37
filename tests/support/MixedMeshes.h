// Small meshes of hexahedra, wedges, pyramids, tetrahedra, quadrilaterals and triangles.
#pragma once

#include "HexahedralMeshes.h"

#include <cadrefine/mesh/Mesh.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace cadtest
{

/// What becomes of a hexahedron.
enum class BoxKind
{
  Hexahedron,
  Wedges,       ///< Two that stand on its side 0, 1, 2, 3.
  WedgesAlongX, ///< Two that stand on its side 0, 3, 7, 4,
  WedgesAlongY, ///< or on 0, 4, 5, 1.
  Fan           ///< Pyramids and tetrahedra on its sides, round a vertex in the middle.
};

/// A conforming mesh of these hexahedra, each cut as `kindOf` says where its neighbours before it
/// allow it, or else as a fan. Diagonals, and the sides between fans, at random.
cadrefine::Mesh mixedMesh(const cadrefine::Mesh& hexahedra,
  const std::function<BoxKind(std::size_t)>& kindOf, std::uint64_t seed);
/// Every hexahedron cut in any way; some quadrilaterals halved.
cadrefine::Mesh randomlyMixedMesh(const cadrefine::Mesh& hexahedra, std::uint64_t seed);

/// Rings of quadrilaterals round a polygon near a circle at these heights; outside, to three times
/// the radius, a ring of quadrilaterals and triangles.
cadrefine::Mesh quadrilateralRingMesh(
  double radius, double offset, int corners, const std::vector<double>& heights);

/// The same with its outer sides listed as cells.
cadrefine::Mesh withListedBoundary(cadrefine::Mesh mesh);

/// The same with the sides whose vertices are all among `count` ones from `first` on listed as
/// cells, each once.
cadrefine::Mesh withListedSides(cadrefine::Mesh mesh, std::size_t first, std::size_t count);

/// The same with all cells of each shape in another order.
cadrefine::Mesh withMixedOrder(cadrefine::Mesh mesh, std::uint64_t seed);

} // namespace cadtest
