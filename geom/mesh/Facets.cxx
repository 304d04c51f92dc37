#include <cadrefine/mesh/Facets.h>

#include <cadrefine/base/VertexBuckets.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
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

std::pair<Index, std::uint64_t> sideKey(const std::array<Index, 3>& corners)
{
  const auto [a, b, c] = corners;
  const auto [low, high] = std::minmax(a, b);
  const Index first = std::min(low, c);
  const Index last = std::max(high, c);
  const auto middle = static_cast<std::uint64_t>(std::max(low, std::min(high, c)));
  return { first, middle << 32 | static_cast<std::uint64_t>(last) };
}

std::pair<Index, std::uint64_t> sideKey(const std::array<Index, 2>& ends)
{
  const auto [a, b] = ends;
  return { std::min(a, b), static_cast<std::uint64_t>(std::max(a, b)) };
}

/// Calls use(vertex) for the smallest vertices of the sides of a cell whose vertices are all
/// `among` some, if any are: two at most, since a side lacks one vertex of the cell.
template<class Use, std::size_t Corners>
void forSmallest(
  const std::array<Index, Corners>& cell, const std::vector<unsigned char>& among, const Use& use)
{
  constexpr Index none = std::numeric_limits<Index>::max();
  Index smallest = none;
  Index second = none;
  std::size_t count = 0;
  for (const Index vertex : cell)
  {
    if (among.empty() || among[vertex])
    {
      second = std::min(second, std::max(smallest, vertex));
      smallest = std::min(smallest, vertex);
      ++count;
    }
  }
  if (count + 1 >= Corners)
  {
    use(smallest);
  }
  if (count == Corners)
  {
    use(second);
  }
}

/// The sides of cells at a vertex that is their smallest, of those that are looked at.
template<std::size_t Corners, std::size_t Sides, std::size_t SideCorners>
struct SideSource
{
  const Simplices<Corners>& cells;
  const int (&sides)[Sides][SideCorners];
  const std::vector<unsigned char>& among;

  std::array<Index, SideCorners> cornersOf(std::size_t place) const
  {
    std::array<Index, SideCorners> corners;
    const auto& side = sides[place % Sides];
    std::transform(std::begin(side), std::end(side), corners.begin(),
      [&](int corner) { return cells[place / Sides][corner]; });
    return corners;
  }

  void append(Index vertex, Index cell, std::vector<Side>& found) const
  {
    for (std::size_t s = 0; s < Sides; ++s)
    {
      const std::size_t place = Sides * static_cast<std::size_t>(cell) + s;
      const auto corners = cornersOf(place);
      const auto [smallest, others] = sideKey(corners);
      const bool isLookedAt =
        smallest == vertex && (among.empty() || std::all_of(corners.begin(), corners.end(),
                                                  [&](Index corner) { return among[corner]; }));
      if (isLookedAt)
      {
        found.push_back({ others, place });
      }
    }
  }
};

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
template<class Source>
std::vector<std::size_t> metOnce(
  std::size_t vertexCount, const Source& source, const ParallelFor& parallelFor)
{
  const auto visit = [&](std::size_t begin, std::size_t end, const auto& use)
  {
    for (std::size_t c = begin; c < end; ++c)
    {
      const auto cell = static_cast<Index>(c);
      forSmallest(source.cells[c], source.among, [&](Index vertex) { use(vertex, cell); });
    }
  };
  const VertexBuckets<Index> cellsAt(vertexCount, source.cells.size(), visit, parallelFor);
  auto places = collect<std::size_t>(parallelFor, vertexCount, fineGrain,
    [&](std::size_t begin, std::size_t end, std::vector<std::size_t>& found)
    {
      SingleSides singles;
      std::vector<Side> sides;
      for (std::size_t v = begin; v < end; ++v)
      {
        const auto vertex = static_cast<Index>(v);
        const auto [first, last] = cellsAt.at(vertex);
        sides.clear();
        std::for_each(first, last, [&](Index cell) { source.append(vertex, cell, sides); });
        singles.find(sides.data(), sides.data() + sides.size(), found);
      }
    });
  std::sort(places.begin(), places.end());
  return places;
}

template<std::size_t Corners, std::size_t Sides, std::size_t SideCorners>
std::vector<Facet> outerFacets(std::size_t vertexCount, const Simplices<Corners>& cells,
  const int (&sides)[Sides][SideCorners], const std::vector<unsigned char>& among,
  const ParallelFor& parallelFor)
{
  const SideSource<Corners, Sides, SideCorners> source{ cells, sides, among };
  std::vector<Facet> facets;
  for (const std::size_t place : metOnce(vertexCount, source, parallelFor))
  {
    Facet& facet = facets.emplace_back();
    facet.vertices.fill(-1);
    const auto corners = source.cornersOf(place);
    std::copy(corners.begin(), corners.end(), facet.vertices.begin());
    facet.cell = static_cast<Index>(place / Sides);
  }
  return facets;
}

} // namespace

std::vector<Facet> findOuterFacets(
  const SimplexMesh& mesh, const std::vector<unsigned char>& among, const ParallelFor& parallelFor)
{
  const std::size_t vertices = mesh.points.size();
  return mesh.dimension == 3
           ? outerFacets(vertices, mesh.tetrahedra, tetrahedronFaces, among, parallelFor)
           : outerFacets(vertices, mesh.triangles, triangleEdges, among, parallelFor);
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
