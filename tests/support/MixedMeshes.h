// Small meshes of hexahedra, wedges, pyramids, tetrahedra, quadrilaterals and triangles.
#pragma once

#include <cadrefine/mesh/Mesh.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

namespace cadtest
{

/// The unit cube as n * n * n hexahedra, and the unit square as n * n quadrilaterals; inner
/// vertices are moved at random by up to `jitter` / n in each direction. Ids are in a random order.
cadrefine::Mesh hexahedraMesh(int n, double jitter, std::uint64_t seed);
cadrefine::Mesh quadrilateralsMesh(int n, double jitter, std::uint64_t seed);

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

/// Ball round the origin: n * n * n hexahedra in the middle, and shells on its six sides that end
/// at these parts of the way to the sphere (the last one is 1). Vertices lie off the sphere by up
/// to `offset` times the radius.
cadrefine::Mesh hexahedralBallMesh(
  double radius, double offset, int n, const std::vector<double>& parts);
/// Shells of hexahedra round that sphere, at these heights over its vertices, the last one at three
/// times the radius. They stand on it with their side 0, 1, 2, 3, the lowest shell first.
cadrefine::Mesh hexahedralShellMesh(
  double radius, double offset, int n, const std::vector<double>& heights);
/// The shells at these heights round a sphere alone, of n x n hexahedra on each side of a cube.
cadrefine::Mesh hexahedralWallMesh(double radius, int n, const std::vector<double>& heights);
/// Those of these hexahedra where no coordinate is negative.
cadrefine::Mesh eighthOf(const cadrefine::Mesh& hexahedra);
/// Rings of quadrilaterals round a polygon near a circle at these heights; outside, to three times
/// the radius, a ring of quadrilaterals and triangles.
cadrefine::Mesh quadrilateralRingMesh(
  double radius, double offset, int corners, const std::vector<double>& heights);

/// The same with its outer sides listed as cells.
cadrefine::Mesh withListedBoundary(cadrefine::Mesh mesh);

/// The same with all cells of each shape in another order.
cadrefine::Mesh withMixedOrder(cadrefine::Mesh mesh, std::uint64_t seed);

} // namespace cadtest
