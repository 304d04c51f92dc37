#include "SplitMesh.h"

#include <algorithm>
#include <random>

namespace cadrefine
{

namespace
{

// Ids of no regular pattern, some negative, all distinct: multiplying by an odd number maps 64 bits
// one to one.
GlobalId scattered(int x, int y, int z)
{
  const std::uint64_t number =
    (static_cast<std::uint64_t>(z) * 1000 + static_cast<std::uint64_t>(y)) * 1000 +
    static_cast<std::uint64_t>(x) + 1;
  return static_cast<GlobalId>(number * 0x9E3779B97F4A7C15ULL);
}

// The tetrahedron along the path from one corner of a box to the opposite one that steps in the
// directions axes[0], axes[1], axes[2].
SplitMesh::Simplex tetrahedron(std::array<int, 3> corner, const std::array<int, 3>& axes)
{
  SplitMesh::Simplex ids = { scattered(corner[0], corner[1], corner[2]) };
  for (const int axis : axes)
  {
    ++corner[static_cast<std::size_t>(axis)];
    ids.push_back(scattered(corner[0], corner[1], corner[2]));
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

std::vector<SplitMesh::Simplex> tetrahedra(int n)
{
  std::vector<SplitMesh::Simplex> cells;
  for (int box = 0; box < n * n * n; ++box)
  {
    std::array<int, 3> axes = { 0, 1, 2 };
    do
    {
      cells.push_back(tetrahedron({ box % n, box / n % n, box / n / n }, axes));
    } while (std::next_permutation(axes.begin(), axes.end()));
  }
  return cells;
}

} // namespace

SplitMesh::SplitMesh(int n, int firstRank, int rankCount, std::uint64_t seed)
{
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<int> rankOf(firstRank, rankCount - 1);
  for (const Simplex& cell : tetrahedra(n))
  {
    const int rank = rankOf(random);
    for (unsigned corners = 1; corners < 15; ++corners) // all but none and all four
    {
      Simplex simplex;
      for (unsigned i = 0; i < 4; ++i)
      {
        if (corners & (1u << i))
        {
          simplex.push_back(cell[i]);
        }
      }
      holders_[simplex].insert(rank);
    }
  }
}

MeshPiece SplitMesh::piece(int rank, std::uint64_t seed) const
{
  std::mt19937_64 random(seed);
  MeshPiece piece;
  for (const auto& [simplex, ranks] : holders_)
  {
    if (simplex.size() == 1 && ranks.count(rank))
    {
      piece.ids.push_back(simplex[0]);
    }
  }
  std::shuffle(piece.ids.begin(), piece.ids.end(), random);
  std::map<GlobalId, Index> localOf;
  for (const GlobalId id : piece.ids)
  {
    localOf.emplace(id, static_cast<Index>(localOf.size()));
  }
  for (const auto& [simplex, ranks] : holders_)
  {
    if (!ranks.count(rank))
    {
      continue;
    }
    std::vector<Index> local;
    for (const GlobalId id : simplex)
    {
      local.push_back(localOf.at(id));
    }
    std::shuffle(local.begin(), local.end(), random);
    if (local.size() == 2)
    {
      piece.edges.push_back({ local[0], local[1] });
    }
    if (local.size() == 3)
    {
      piece.facets.push_back({ local[0], local[1], local[2] });
    }
  }
  std::shuffle(piece.edges.begin(), piece.edges.end(), random);
  std::shuffle(piece.facets.begin(), piece.facets.end(), random);
  return piece;
}

std::set<SplitMesh::Simplex> SplitMesh::shared(std::size_t vertexCount, int rank) const
{
  std::set<Simplex> result;
  for (const auto& [simplex, ranks] : holders_)
  {
    if (simplex.size() == vertexCount && ranks.size() > 1 && ranks.count(rank))
    {
      result.insert(simplex);
    }
  }
  return result;
}

} // namespace cadrefine
