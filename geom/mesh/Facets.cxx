#include "Facets.h"

#include "VertexBuckets.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace cadrefine
{
namespace
{

/// A side in the bucket of its smallest vertex: the other vertices, ascending, as one number, and
/// its place in the order of the cells and their local sides.
struct Side
{
  std::uint64_t others;
  std::size_t place;

  friend bool operator<(const Side& a, const Side& b) { return a.others < b.others; }
};

std::pair<Index, std::uint64_t> sideKey(Index a, Index b, Index c)
{
  const auto [low, high] = std::minmax(a, b);
  const Index first = std::min(low, c);
  const Index last = std::max(high, c);
  const auto middle = static_cast<std::uint64_t>(std::max(low, std::min(high, c)));
  return { first, middle << 32 | static_cast<std::uint64_t>(last) };
}

std::pair<Index, std::uint64_t> sideKey(Index a, Index b)
{
  return { std::min(a, b), static_cast<std::uint64_t>(std::max(a, b)) };
}

/// Calls use(smallest vertex, side) for each side.
template<class Use, std::size_t Corners, std::size_t Sides, std::size_t SideCorners>
void forEachSide(
  const Simplices<Corners>& cells, const int (&sides)[Sides][SideCorners], const Use& use)
{
  std::size_t place = 0;
  for (const auto& cell : cells)
  {
    for (const auto& side : sides)
    {
      if constexpr (SideCorners == 3)
      {
        const auto [vertex, others] = sideKey(cell[side[0]], cell[side[1]], cell[side[2]]);
        use(vertex, Side{ others, place++ });
      }
      else
      {
        const auto [vertex, others] = sideKey(cell[side[0]], cell[side[1]]);
        use(vertex, Side{ others, place++ });
      }
    }
  }
}

/// Finds the sides of a bucket that are met once.
class SingleSides
{
public:
  /// Appends the places of those.
  void find(Side* first, Side* last, std::vector<std::size_t>& places)
  {
    constexpr std::ptrdiff_t fewSides = 64;
    if (last - first > fewSides)
    {
      findBySorting(first, last, places);
      return;
    }
    distinct_.clear();
    again_.clear();
    for (const Side* side = first; side != last; ++side)
    {
      const auto found = std::find_if(distinct_.begin(), distinct_.end(),
        [&](const Side& other) { return other.others == side->others; });
      if (found == distinct_.end())
      {
        distinct_.push_back(*side);
        again_.push_back(0);
      }
      else
      {
        again_[found - distinct_.begin()] = 1;
      }
    }
    for (std::size_t s = 0; s < distinct_.size(); ++s)
    {
      if (!again_[s])
      {
        places.push_back(distinct_[s].place);
      }
    }
  }

private:
  static void findBySorting(Side* first, Side* last, std::vector<std::size_t>& places)
  {
    std::sort(first, last);
    while (first != last)
    {
      Side* next =
        std::find_if(first, last, [&](const Side& side) { return side.others != first->others; });
      if (next - first == 1)
      {
        places.push_back(first->place);
      }
      first = next;
    }
  }

  std::vector<Side> distinct_;
  std::vector<unsigned char> again_;
};

/// Places of the sides that are met once, ascending.
template<std::size_t Corners, std::size_t Sides, std::size_t SideCorners>
std::vector<std::size_t> metOnce(
  std::size_t vertexCount, const Simplices<Corners>& cells, const int (&sides)[Sides][SideCorners])
{
  VertexBuckets<Side> buckets(vertexCount);
  forEachSide(cells, sides, [&](Index vertex, const Side&) { buckets.count(vertex); });
  buckets.start();
  forEachSide(cells, sides, [&](Index vertex, const Side& side) { buckets.add(vertex, side); });
  std::vector<std::size_t> places;
  SingleSides singles;
  buckets.forEach([&](Index, Side* first, Side* last) { singles.find(first, last, places); });
  std::sort(places.begin(), places.end());
  return places;
}

template<std::size_t Corners, std::size_t Sides, std::size_t SideCorners>
std::vector<Facet> outerFacets(
  std::size_t vertexCount, const Simplices<Corners>& cells, const int (&sides)[Sides][SideCorners])
{
  std::vector<Facet> facets;
  for (const std::size_t place : metOnce(vertexCount, cells, sides))
  {
    const std::size_t cell = place / Sides;
    Facet& facet = facets.emplace_back();
    facet.vertices.fill(-1);
    std::transform(std::begin(sides[place % Sides]), std::end(sides[place % Sides]),
      facet.vertices.begin(), [&](int corner) { return cells[cell][corner]; });
    facet.cell = static_cast<Index>(cell);
  }
  return facets;
}

} // namespace

std::vector<Facet> findOuterFacets(const SimplexMesh& mesh)
{
  return mesh.dimension == 3 ? outerFacets(mesh.points.size(), mesh.tetrahedra, tetrahedronFaces)
                             : outerFacets(mesh.points.size(), mesh.triangles, triangleEdges);
}

std::vector<Facet> facetsOfSurface(const SimplexMesh& mesh)
{
  std::vector<Facet> facets;
  facets.reserve(mesh.triangles.size());
  for (std::size_t c = 0; c < mesh.triangles.size(); ++c)
  {
    facets.push_back({ mesh.triangles[c], static_cast<Index>(c) });
  }
  return facets;
}

} // namespace cadrefine
