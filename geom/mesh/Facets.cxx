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

/// A side in the bucket of its smallest vertex: the other vertices, ascending, as one number (of a
/// mesh with quadrilaterals two), and its place in the order of the cells and their local sides.
template<class Others>
struct Side
{
  Others others;
  std::size_t place;

  friend bool operator<(const Side& a, const Side& b) { return a.others < b.others; }
};

std::uint64_t packed(Index a, Index b)
{
  return static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint64_t>(b);
}

std::pair<Index, std::uint64_t> sideKey(const std::array<Index, 3>& corners)
{
  const auto [a, b, c] = corners;
  const auto [low, high] = std::minmax(a, b);
  const Index first = std::min(low, c);
  const Index last = std::max(high, c);
  return { first, packed(std::max(low, std::min(high, c)), last) };
}

std::pair<Index, std::uint64_t> sideKey(const std::array<Index, 2>& ends)
{
  const auto [a, b] = ends;
  return { std::min(a, b), static_cast<std::uint64_t>(std::max(a, b)) };
}

using MixedOthers = std::pair<std::uint64_t, Index>; ///< The last vertex is -1 for a triangle.

std::pair<Index, MixedOthers> sideKey(Facet side)
{
  auto& v = side.vertices;
  std::sort(v.begin(), v.begin() + side.corners());
  return { v[0], { packed(v[1], side.corners() > 2 ? v[2] : 0), v[3] } };
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

/// The sides of simplices at a vertex that is their smallest, of those that are looked at.
template<std::size_t Corners, std::size_t Sides, std::size_t SideCorners>
struct SimplexSides
{
  using Others = std::uint64_t;

  const Cells<Corners>& cells;
  const int (&sides)[Sides][SideCorners];
  const std::vector<unsigned char>& among;

  std::size_t cellCount() const { return cells.size(); }

  template<class Use>
  void forSmallestOf(std::size_t cell, const Use& use) const
  {
    forSmallest(cells[cell], among, use);
  }

  Facet facetAt(std::size_t place) const
  {
    Facet facet;
    const auto corners = cornersOf(place);
    std::copy(corners.begin(), corners.end(), facet.vertices.begin());
    facet.cell = static_cast<Index>(place / Sides);
    return facet;
  }

  std::array<Index, SideCorners> cornersOf(std::size_t place) const
  {
    std::array<Index, SideCorners> corners;
    const auto& side = sides[place % Sides];
    std::transform(std::begin(side), std::end(side), corners.begin(),
      [&](int corner) { return cells[place / Sides][corner]; });
    return corners;
  }

  void append(Index vertex, Index cell, std::vector<Side<Others>>& found) const
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

/// The sides of cells of any shape at a vertex that is their smallest, of those that are looked at.
class MixedSides
{
public:
  using Others = MixedOthers;

  MixedSides(const Mesh& mesh, const std::vector<unsigned char>& among)
    : mesh_(mesh), among_(among), cellCount_(mesh.cellCount(mesh.dimension))
  {
  }

  std::size_t cellCount() const { return cellCount_; }

  template<class Use>
  void forSmallestOf(std::size_t cell, const Use& use) const
  {
    if (!mayHaveSides(cell))
    {
      return;
    }
    std::array<Index, mostSides> seen;
    seen.fill(-1);
    forSides(cell,
      [&](std::size_t place, const Facet& side)
      {
        const Index smallest = *std::min_element(side.begin(), side.end());
        if (isLookedAt(side) && std::find(seen.begin(), seen.end(), smallest) == seen.end())
        {
          seen[place % mostSides] = smallest;
          use(smallest);
        }
      });
  }

  void append(Index vertex, Index cell, std::vector<Side<Others>>& found) const
  {
    forSides(cell,
      [&](std::size_t place, const Facet& side)
      {
        const auto [smallest, others] = sideKey(side);
        if (smallest == vertex && isLookedAt(side))
        {
          found.push_back({ others, place });
        }
      });
  }

  Facet facetAt(std::size_t place) const
  {
    Facet facet;
    forSides(place / mostSides,
      [&](std::size_t other, const Facet& side) { facet = other == place ? side : facet; });
    return facet;
  }

private:
  static constexpr std::size_t mostSides = 6;

  /// Calls use(place, side) for the sides of a cell.
  template<class Use>
  void forSides(std::size_t cell, const Use& use) const
  {
    std::size_t place = mostSides * cell;
    const auto number = static_cast<Index>(cell);
    visitOwnCell(mesh_, number,
      [&](auto shape, const auto& corners)
      { forEachSide(shape, corners, number, [&](const Facet& side) { use(place++, side); }); });
  }

  /// Whether enough corners of a cell are looked at for it to have a side that is.
  bool mayHaveSides(std::size_t cell) const
  {
    std::ptrdiff_t count = 0;
    visitOwnCell(mesh_, static_cast<Index>(cell),
      [&](auto, const auto& corners)
      {
        count = std::count_if(corners.begin(), corners.end(),
          [&](Index corner) { return among_.empty() || among_[corner]; });
      });
    return count >= mesh_.dimension;
  }

  bool isLookedAt(const Facet& side) const
  {
    return among_.empty() ||
           std::all_of(side.begin(), side.end(), [&](Index corner) { return among_[corner]; });
  }

  const Mesh& mesh_;
  const std::vector<unsigned char>& among_;
  std::size_t cellCount_;
};

/// Finds the sides of a bucket that are met once.
template<class Side>
class SingleSides
{
public:
  /// Appends the places of the sides from `first` to `last` that are met once.
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
      source.forSmallestOf(c, [&](Index vertex) { use(vertex, static_cast<Index>(c)); });
    }
  };
  const VertexBuckets<Index> cellsAt(vertexCount, source.cellCount(), visit, parallelFor);
  auto places = collect<std::size_t>(parallelFor, vertexCount, fineGrain,
    [&](std::size_t begin, std::size_t end, std::vector<std::size_t>& found)
    {
      SingleSides<Side<typename Source::Others>> singles;
      std::vector<Side<typename Source::Others>> sides;
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

template<class Source>
std::vector<Facet> outerFacets(
  std::size_t vertexCount, const Source& source, const ParallelFor& parallelFor)
{
  std::vector<Facet> facets;
  for (const std::size_t place : metOnce(vertexCount, source, parallelFor))
  {
    facets.push_back(source.facetAt(place));
  }
  return facets;
}

} // namespace

std::vector<Facet> findOuterFacets(
  const Mesh& mesh, const std::vector<unsigned char>& among, const ParallelFor& parallelFor)
{
  const std::size_t vertices = mesh.points.size();
  if (mesh.hasNonSimplices())
  {
    return outerFacets(vertices, MixedSides(mesh, among), parallelFor);
  }
  return mesh.dimension == 3
           ? outerFacets(vertices,
               SimplexSides<4, 4, 3>{ mesh.tetrahedra, tetrahedronFaces, among }, parallelFor)
           : outerFacets(vertices, SimplexSides<3, 3, 2>{ mesh.triangles, triangleEdges, among },
               parallelFor);
}

std::vector<Facet> facetsOfSurface(const Mesh& mesh)
{
  std::vector<Facet> facets;
  facets.reserve(mesh.cellCount(2));
  visitShapes(mesh, 2,
    [&](auto, const auto& cells)
    {
      for (const auto& cell : cells)
      {
        Facet& facet = facets.emplace_back();
        std::copy(cell.begin(), cell.end(), facet.vertices.begin());
        facet.cell = static_cast<Index>(facets.size() - 1);
      }
    });
  return facets;
}

} // namespace cadrefine
