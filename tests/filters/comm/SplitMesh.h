// A mesh whose cells are dealt out to the ranks at random, with the truth about what they share.
#pragma once

#include <cadrefine/base/MeshTypes.h>

#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

namespace cadrefine
{

/// What one rank holds, in an order of its own.
struct MeshPiece
{
  std::vector<GlobalId> ids;
  std::vector<std::array<Index, 2>> edges;
  std::vector<std::array<Index, 3>> facets;
};

/// A cube of n * n * n boxes, each cut into six tetrahedra. Any rank can look into all pieces.
class SplitMesh
{
public:
  using Simplex = std::vector<GlobalId>; // ascending ids of 1, 2 or 3 vertices

  /// Deals the cells out to ranks `firstRank` up to `rankCount`; those below hold nothing.
  SplitMesh(int n, int firstRank, int rankCount, std::uint64_t seed);

  MeshPiece piece(int rank, std::uint64_t seed) const;

  /// The ranks that hold a vertex, edge or facet.
  const std::set<int>& holders(const Simplex& simplex) const { return holders_.at(simplex); }

  /// Those that several ranks hold, of so many vertices, and one of the ranks is `rank`.
  std::set<Simplex> shared(std::size_t vertexCount, int rank) const;

private:
  std::map<Simplex, std::set<int>> holders_;
};

} // namespace cadrefine
