// Small meshes of hexahedra, or of quadrilaterals, on grids and in shells.
#pragma once

#include <cadrefine/mesh/Mesh.h>

#include <cstdint>
#include <random>
#include <vector>

namespace cadtest
{

/// The unit cube as n * n * n hexahedra, and the unit square as n * n quadrilaterals; inner
/// vertices are moved at random by up to `jitter` / n in each direction. Ids are in a random order.
cadrefine::Mesh hexahedraMesh(int n, double jitter, std::uint64_t seed);
cadrefine::Mesh quadrilateralsMesh(int n, double jitter, std::uint64_t seed);

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

/// Gives the vertices ids from 0 on, in a random order.
void shuffleIds(cadrefine::Mesh& mesh, std::mt19937_64& random);

} // namespace cadtest
