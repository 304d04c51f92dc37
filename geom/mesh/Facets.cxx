#include "Facets.h"

#include "VertexBuckets.h"

#include <algorithm>

namespace cadrefine
{
namespace
{

/// A side in the bucket of its smallest vertex: the other vertices, ascending (a segment has
/// one), and its place in the order of the cells and their local sides.
struct Side
{
  std::uint64_t others;
  std::size_t place;

  friend bool operator<(const Side& a, const Side& b) { return a.others < b.others; }
};

template<class Use, std::size_t Corners, std::size_t Sides, std::size_t SideCorners>
void forEachSide(
  const Simplices<Corners>& cells, const int (&sides)[Sides][SideCorners], const Use& use)
{
  std::size_t place = 0;
  for (const auto& cell : cells)
  {
    for (const auto& side : sides)
    {
      std::array<Index, SideCorners> vertices;
      for (std::size_t k = 0; k < SideCorners; ++k)
      {
        vertices[k] = cell[side[k]];
      }
      std::sort(vertices.begin(), vertices.end());
      const auto second = SideCorners == 3 ? static_cast<std::uint64_t>(vertices[1]) : 0;
      const auto last = static_cast<std::uint64_t>(vertices.back());
      use(vertices[0], Side{ second << 32 | last, place });
      ++place;
    }
  }
}

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
  buckets.forEachSorted(
    [&](Index, const Side* first, const Side* last)
    {
      while (first != last)
      {
        const Side* next =
          std::find_if(first, last, [&](const Side& side) { return side.others != first->others; });
        if (next - first == 1)
        {
          places.push_back(first->place);
        }
        first = next;
      }
    });
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
